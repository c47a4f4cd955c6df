#include "softforce/pipeline/mesh_convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

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

// What the supernodal factorisation of 10-node cells needs, from 1.0 GB at 180 000 degrees of
// freedom, growing as in a bulky body.
double ExpectedMemoryGb(double dofs) { return std::pow(dofs / 180e3, 4.0 / 3.0); }

int Dofs(const World& world) { return 3 * world.mesh().num_nodes(); }

void RefuseTooLarge(const World& given, const MeshConvergenceOptions& options) {
  const double dofs = 8.0 * Dofs(given);  // a little more than the refined mesh has
  const double needed = ExpectedMemoryGb(dofs);
  if (needed <= options.max_memory_gb) return;
  throw base::InputError(
      "mesh",
      fmt::format("once refined it would have {:.2g} million degrees of freedom and need "
                  "some {:.0f} GB; at most {:.3g} GB are allowed",
                  1e-6 * dofs, needed, options.max_memory_gb),
      "Allow more memory if there is, or judge a coarser mesh of the same body.");
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

// A level of local refinement.
struct Level {
  World world;
  MeshAnswer answer;
  // Of each cell, as a share of the given mesh's compliance: what cutting it is expected to change.
  std::vector<double> errors;
  double expected_change = 0, change = 0;  // of the bias, by making this level
};

Level NextLevel(const scene::Scene& scene, const World& world, const MeshAnswer& answer,
                const std::vector<double>& errors, const Eigen::MatrixXd& aim) {
  const std::vector<char> marked = MarkLargest(errors, kRefinedShare);
  const mesh::Refinement refinement = mesh::RefineWhere(world.mesh(), marked);
  Level next;
  next.world = BuildWorld(scene, refinement.mesh);
  next.answer = AnswerOf(next.world, aim);
  next.change = BiasOf(aim, aim + next.answer.markers - answer.markers);
  std::vector<int> parts(errors.size(), 0);
  for (const int parent : refinement.parent) ++parts[parent];
  const std::vector<double> changes =
      ChangeOfCells(world, answer, next.world, next.answer, refinement);
  for (size_t e = 0; e < changes.size(); ++e) {
    const int parent = refinement.parent[e];
    // A neighbour that was cut into a few parts keeps what was not taken from its error.
    const double share = errors[parent] / parts[parent];
    next.errors.push_back(marked[parent] ? kLeftAfterCut * std::abs(changes[e])
                                         : std::max(0.0, share - std::abs(changes[e])));
  }
  for (size_t e = 0; e < errors.size(); ++e) {
    if (marked[e]) next.expected_change += errors[e];
  }
  return next;
}

// Answers of the given mesh, of the once refined one, and in the limit.
struct Answers {
  MeshAnswer given, refined;
  Eigen::MatrixXd markers;  // converged
  Eigen::VectorXd own;
};

// What further refinement of a level would change, as a share of the given mesh's compliance.
double Remaining(const Level& level) {
  const double sum = std::accumulate(level.errors.begin(), level.errors.end(), 0.0);
  return sum / (1 - kLeftAfterCut);
}

// Goes from level to level until little remains, and adds that to the last level in the
// proportions of all changes so far.
void RefineLocally(const scene::Scene& scene, const World& given,
                   const MeshConvergenceOptions& options, std::vector<double> errors,
                   base::Progress* progress, Answers* answers, std::vector<Level>* levels,
                   MeshConvergence* result) {
  for (int k = 1; k <= options.max_levels; ++k) {
    const World& before = levels->empty() ? given : levels->back().world;
    const MeshAnswer& answer = levels->empty() ? answers->given : levels->back().answer;
    levels->push_back(NextLevel(scene, before, answer,
                                levels->empty() ? errors : levels->back().errors,
                                answers->given.markers));
    if (options.show_progress) progress->Update(2 + k);
    const Level& level = levels->back();
    if (Remaining(level) < options.settled ||
        Dofs(level.world) > options.max_local_growth * Dofs(given)) {
      break;
    }
  }
  const Level& last = levels->back();
  const double so_far = BiasOf(answers->given.markers, last.answer.markers);
  const double more = so_far > 0 ? 1 + Remaining(last) / so_far : 1;
  answers->markers = answers->given.markers + more * (last.answer.markers - answers->given.markers);
  answers->own = answers->given.own + more * (last.answer.own - answers->given.own);
  result->uncertain = Remaining(last);
}

// The finest level whose equilibria under large loads take seconds rather than minutes.
const Level& ForLargeLoads(const std::vector<Level>& levels, const World& given) {
  constexpr double kGrowth = 4;
  const Level* best = &levels.front();
  for (const Level& level : levels) {
    if (Dofs(level.world) <= kGrowth * Dofs(given)) best = &level;
  }
  return *best;
}

void FillTables(const scene::Scene& scene, const World& given, const Answers& answers,
                MeshConvergence* result) {
  result->overall = {BiasOf(answers.given.markers, answers.refined.markers),
                     BiasOf(answers.given.markers, answers.markers)};
  Eigen::Index c = 0;
  for (size_t s = 0; s < given.sites.size(); ++s) {
    for (Eigen::Index d = 0; d < given.sites[s].directions.cols(); ++d, ++c) {
      const double own = answers.given.own(c);
      result->candidates.push_back({scene.forces.candidates[s].id,
                                    own,
                                    {answers.refined.own(c) / own - 1, answers.own(c) / own - 1}});
    }
  }
  for (size_t m = 0; m < given.markers.size(); ++m) {
    const auto of = [&](const Eigen::MatrixXd& markers) -> Eigen::MatrixXd {
      return markers.middleRows<3>(3 * static_cast<Eigen::Index>(m));
    };
    result->markers.push_back({scene.markers.points[m].id,
                               {BiasOf(of(answers.given.markers), of(answers.refined.markers)),
                                BiasOf(of(answers.given.markers), of(answers.markers))}});
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
  result.cells = given.mesh().num_elements();
  result.dofs = Dofs(given);
  std::vector<double> errors(given.mesh().num_elements(), 0);
  {
    const mesh::Refinement refinement = mesh::Refine(given.mesh());
    const World refined = BuildWorld(scene, refinement.mesh);
    answers.refined = AnswerOf(refined, answers.given.markers);
    result.refined_cells = refined.mesh().num_elements();
    result.refined_dofs = Dofs(refined);
    const std::vector<double> changes =
        ChangeOfCells(given, answers.given, refined, answers.refined, refinement);
    for (size_t e = 0; e < changes.size(); ++e) errors[refinement.parent[e]] += changes[e];
    for (double& e : errors) e = std::abs(e);
    answers.refined.du.resize(0, 0);  // large, and no longer needed
    answers.refined.forces.resize(0, 0);
  }
  if (options.show_progress) progress.Update(2);
  result.cell_share = Eigen::Map<const Eigen::VectorXd>(errors.data(), result.cells);
  result.cell_share /= result.cell_share.sum();

  std::vector<Level> levels;
  RefineLocally(scene, given, options, errors, &progress, &answers, &levels, &result);
  FillTables(scene, given, answers, &result);
  result.places = CoarsePlaces(given.mesh(), result.cell_share, kLeftAfterCut);
  for (const Level& level : levels) {
    result.local.push_back({level.world.mesh(),
                            {BiasOf(level.answer.markers, answers.refined.markers),
                             BiasOf(level.answer.markers, answers.markers)}});
  }
  if (options.working_deflection >= 0) {
    const Level& level = ForLargeLoads(levels, given);
    result.working = CompareAtWork(given, answers.given, level.world, level.answer,
                                   answers.refined.markers, answers.markers, options);
  }
  if (options.show_progress) progress.Finish();
  return result;
}

}  // namespace softforce::pipeline
