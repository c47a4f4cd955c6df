#include "softforce/pipeline/mesh_convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "pipeline/coarse_places.h"
#include "pipeline/mesh_answer.h"
#include "pipeline/working_load.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"
#include "softforce/mesh/refine.h"

namespace softforce::pipeline {
namespace {

// The cells with the largest errors that make up this share of the whole are refined next.
constexpr double kRefinedShare = 0.5;
// What is left of a cell's error when it is cut. At the edge of a clamp the stress is singular,
// and the error of a compliance falls with the size to the power 1.2 to 1.5; where it is smooth,
// with the fourth power, but there little is left to be seen.
constexpr double kLeftAfterCut = 0.4;

// Of the whole program while a mesh of 10-node cells is solved, at its peak: 1.4 GB were measured
// with 172 000 degrees of freedom, 1.55 GB with 189 000. Grows as in a bulky body.
double ExpectedMemoryGb(double dofs) { return 1.5 * std::pow(dofs / 180e3, 4.0 / 3.0); }

int Dofs(const World& world) { return 3 * world.mesh().num_nodes(); }

// How many times the degrees of freedom of the given mesh the largest solved one has, about.
double LargestGrowth(const MeshConvergenceOptions& options) {
  constexpr double kOnceRefined = 8;  // a little more than it is
  return options.max_levels > 1 ? std::max(kOnceRefined, options.max_local_growth) : kOnceRefined;
}

void RefuseTooLarge(const World& given, const MeshConvergenceOptions& options) {
  const double dofs = LargestGrowth(options) * Dofs(given);
  const double needed = ExpectedMemoryGb(dofs);
  if (needed <= options.max_memory_gb) return;
  const double share = std::pow(options.max_memory_gb / needed, 3.0 / 4.0);
  throw base::InputError(
      "mesh",
      fmt::format(
          "it has {} cells; finer ones to compare it with would have {:.2g} million degrees "
          "of freedom and need some {:.0f} GB, at most {:.3g} GB are allowed",
          given.mesh().num_elements(), 1e-6 * dofs, needed, options.max_memory_gb),
      fmt::format("Judge a mesh of the same body with at most some {:.2g} cells, made with edges "
                  "{:.1f} times as long: this one is closer to the limit than that.",
                  share * given.mesh().num_elements(), std::cbrt(1 / share)));
}

std::vector<char> MarkLargest(const std::vector<double>& errors, double share) {
  std::vector<int> order(errors.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return errors[a] > errors[b]; });
  const double wanted = share * std::accumulate(errors.begin(), errors.end(), 0.0);
  std::vector<char> marked(errors.size(), false);
  double sum = 0;
  for (const int e : order) {
    if (sum >= wanted) break;
    marked[e] = true;
    sum += errors[e];
  }
  return marked;
}

// A level of local refinement. Its solver is gone, as factors are what fills the memory.
struct Level {
  mesh::TetMesh mesh;
  MeshAnswer answer;
  // Of each cell, as a share of the given mesh's compliance: what cutting it is expected to change.
  std::vector<double> errors;
};

// What is kept of a level when the next one is made.
struct Record {
  mesh::TetMesh mesh;
  Eigen::MatrixXd markers;  // as in MeshAnswer
};

// None if it would have more than `max_dofs`.
std::optional<Level> NextLevel(const scene::Scene& scene, const Level& level,
                               const Eigen::MatrixXd& aim, double max_dofs) {
  const std::vector<char> marked = MarkLargest(level.errors, kRefinedShare);
  mesh::Refinement refinement = mesh::RefineWhere(level.mesh, marked);
  if (3 * refinement.mesh.num_nodes() > max_dofs) return std::nullopt;
  Level next;
  World world = BuildWorld(scene, refinement.mesh);
  next.answer = AnswerOf(world, aim);
  const fem::Body body = world.solver->body();
  world.solver.reset();
  std::vector<int> parts(level.errors.size(), 0);
  for (const int parent : refinement.parent) ++parts[parent];
  const std::vector<double> changes =
      ChangeOfCells(level.mesh, level.answer, body, next.answer, refinement);
  for (size_t e = 0; e < changes.size(); ++e) {
    const int parent = refinement.parent[e];
    // A neighbour that was cut into a few parts keeps what was not taken from its error.
    const double share = level.errors[parent] / parts[parent];
    next.errors.push_back(marked[parent] ? kLeftAfterCut * std::abs(changes[e])
                                         : std::max(0.0, share - std::abs(changes[e])));
  }
  next.mesh = std::move(refinement.mesh);
  return next;
}

// Answers of the given mesh, of the once refined one, and in the limit.
struct Answers {
  MeshAnswer given;
  Eigen::MatrixXd refined_markers, markers;  // markers: converged
  Eigen::VectorXd refined_own, own;
  double uncertain_share = NAN;  // of what `markers` differ from the given mesh's
};

// What further refinement of a level would change, as a share of the given mesh's compliance.
double Remaining(const Level& level) {
  const double sum = std::accumulate(level.errors.begin(), level.errors.end(), 0.0);
  return sum / (1 - kLeftAfterCut);
}

// Solves the once refined mesh. Returns each given cell's part of the bias.
std::vector<double> RefineOnce(const scene::Scene& scene, const World& given, Answers* answers,
                               MeshConvergence* result) {
  const mesh::Refinement refinement = mesh::Refine(given.mesh());
  World refined = BuildWorld(scene, refinement.mesh);
  const MeshAnswer answer = AnswerOf(refined, answers->given.markers);
  const fem::Body body = refined.solver->body();
  refined.solver.reset();
  result->refined_cells = body.mesh.num_elements();
  result->refined_dofs = 3 * body.mesh.num_nodes();
  answers->refined_markers = answer.markers;
  answers->refined_own = answer.own;
  const std::vector<double> changes =
      ChangeOfCells(given.mesh(), answers->given, body, answer, refinement);
  std::vector<double> errors(given.mesh().num_elements(), 0);
  for (size_t e = 0; e < changes.size(); ++e) errors[refinement.parent[e]] += changes[e];
  for (double& e : errors) e = std::abs(e);
  return errors;
}

// Goes from level to level until little remains, and adds that to the last level in the
// proportions of all changes so far.
std::vector<Record> RefineLocally(const scene::Scene& scene, const World& given,
                                  const MeshConvergenceOptions& options, std::vector<double> errors,
                                  base::Progress* progress, Answers* answers) {
  const int max_levels = given.mesh().order() == 1 ? 1 : options.max_levels;
  constexpr double kSmall = 10e3;  // degrees of freedom that cost neither time nor memory
  const double max_dofs = std::max(kSmall, options.max_local_growth * Dofs(given));
  std::vector<Record> records;
  Level level{given.mesh(), answers->given, std::move(errors)};
  for (int k = 1; k <= max_levels; ++k) {
    // The first is at most the once refined mesh, and is always made.
    std::optional<Level> next =
        NextLevel(scene, level, answers->given.markers, k == 1 ? INFINITY : max_dofs);
    if (!next) break;
    level = std::move(*next);
    records.push_back({level.mesh, level.answer.markers});
    if (options.show_progress) progress->Update(2 + k);
    if (Remaining(level) < options.settled) break;
  }
  const double so_far = BiasOf(answers->given.markers, level.answer.markers);
  const double more = so_far > 0 ? 1 + Remaining(level) / so_far : 1;
  answers->markers =
      answers->given.markers + more * (level.answer.markers - answers->given.markers);
  answers->own = answers->given.own + more * (level.answer.own - answers->given.own);
  answers->uncertain_share = 1 - 1 / more;
  if (given.mesh().order() == 1) {  // how far cells that lock are from the limit, nobody can tell
    answers->markers.setConstant(NAN);
    answers->own.setConstant(NAN);
  }
  return records;
}

// The finest level whose equilibria under large loads take seconds rather than minutes.
const Record& ForLargeLoads(const std::vector<Record>& records, const World& given) {
  constexpr double kGrowth = 4;
  const Record* best = &records.front();
  for (const Record& record : records) {
    if (3 * record.mesh.num_nodes() <= kGrowth * Dofs(given)) best = &record;
  }
  return *best;
}

WorkingMeshBias AtWork(const scene::Scene& scene, const World& given, const Answers& answers,
                       const std::vector<Record>& records, const MeshConvergenceOptions& options) {
  if (options.working_deflection < 0) return {};
  const Record& record = ForLargeLoads(records, given);
  const World local = BuildWorld(scene, record.mesh);
  WorkingMeshBias bias = CompareAtWork(given, answers.given, local, record.markers,
                                       answers.refined_markers, answers.markers, options);
  for (MeshBias* of : {&bias.displacement, &bias.force}) {
    of->uncertain = std::abs(answers.uncertain_share * of->converged);
  }
  return bias;
}

// A body that stands still where it is looked at or pressed tells nothing.
void RefuseWithoutMovement(const scene::Scene& scene, const World& given,
                           const MeshAnswer& answer) {
  if (!(answer.markers.squaredNorm() > 0)) {
    throw base::InputError(scene.file.string() + ": markers",
                           "none of them moves under a force on any candidate",
                           "Check that markers and candidates lie off the fixed parts, and in one "
                           "piece of the body.");
  }
  Eigen::Index first = 0;
  for (size_t s = 0; s < given.sites.size(); ++s) {
    const Eigen::Index n = given.sites[s].directions.cols();
    if (!(answer.own.segment(first, n).minCoeff() > 0)) {
      throw base::InputError(fmt::format("{}: forces: candidates: id {}", scene.file.string(),
                                         scene.forces.candidates[s].id),
                             "a force there moves nothing: it acts on what is fixed",
                             "Move the candidate off the fixed parts, or make those smaller.");
    }
    first += n;
  }
}

void FillTables(const scene::Scene& scene, const World& given, const Answers& answers,
                MeshConvergence* result) {
  const auto bias = [&](double refined, double converged) {
    return MeshBias{refined, converged, std::abs(answers.uncertain_share * converged)};
  };
  result->overall = bias(BiasOf(answers.given.markers, answers.refined_markers),
                         BiasOf(answers.given.markers, answers.markers));
  Eigen::Index c = 0;
  for (size_t s = 0; s < given.sites.size(); ++s) {
    for (Eigen::Index d = 0; d < given.sites[s].directions.cols(); ++d, ++c) {
      const double own = answers.given.own(c);
      // The finer the mesh, the deeper the dent under the point of a needle.
      const double limit = result->point_forces ? NAN : answers.own(c) / own - 1;
      result->candidates.push_back(
          {scene.forces.candidates[s].id, own, bias(answers.refined_own(c) / own - 1, limit)});
    }
  }
  for (size_t m = 0; m < given.markers.size(); ++m) {
    const auto of = [&](const Eigen::MatrixXd& markers) -> Eigen::MatrixXd {
      return markers.middleRows<3>(3 * static_cast<Eigen::Index>(m));
    };
    result->markers.push_back({scene.markers.points[m].id,
                               bias(BiasOf(of(answers.given.markers), of(answers.refined_markers)),
                                    BiasOf(of(answers.given.markers), of(answers.markers)))});
  }
}

}  // namespace

void MeshConvergenceOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("mesh convergence option ") + option, rule);
  };
  require(settled > 0, "settled", "must be greater than 0");
  require(max_levels >= 1, "max_levels", "must be 1 or more");
  require(max_local_growth > 1, "max_local_growth", "must be greater than 1");
  require(max_memory_gb > 0, "max_memory_gb", "must be greater than 0 GB");
  require(working_load >= 0, "working_load", "must be 0 N or more");
  require(working_deflection < 1, "working_deflection", "must be less than 1");
}

MeshConvergence AssessMesh(const scene::Scene& scene, const World& given,
                           const MeshConvergenceOptions& options) {
  options.Check();
  if (given.sites.empty() || given.markers.empty()) {
    throw base::InputError(scene.file.string(),
                           "needs markers and candidates to judge the mesh by");
  }
  RefuseTooLarge(given, options);
  MeshConvergence result;
  base::Progress progress("meshes", options.max_levels + 3);
  Answers answers;
  answers.given = AnswerOf(given);
  RefuseWithoutMovement(scene, given, answers.given);
  result.cells = given.mesh().num_elements();
  result.dofs = Dofs(given);
  result.locks = given.mesh().order() == 1;
  result.point_forces = !(scene.forces.patch > 0);
  std::vector<double> errors = RefineOnce(scene, given, &answers, &result);
  if (options.show_progress) progress.Update(2);
  result.cell_share = Eigen::Map<const Eigen::VectorXd>(errors.data(), result.cells);
  result.cell_share /= result.cell_share.sum();

  const std::vector<Record> records =
      RefineLocally(scene, given, options, std::move(errors), &progress, &answers);
  FillTables(scene, given, answers, &result);
  result.places = CoarsePlaces(given.mesh(), result.cell_share, kLeftAfterCut);
  result.working = AtWork(scene, given, answers, records, options);
  for (const Record& record : records) {
    result.local.push_back({record.mesh,
                            {BiasOf(record.markers, answers.refined_markers),
                             BiasOf(record.markers, answers.markers)}});
  }
  if (options.show_progress) progress.Finish();
  return result;
}

}  // namespace softforce::pipeline
