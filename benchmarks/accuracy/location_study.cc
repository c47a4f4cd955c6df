// How well forces of unknown place are found: which candidates are loaded, how strongly, and where
// between them. The bodies are those of validation; truths are made on a mesh that Gmsh cuts on its
// own (4 times the cells, 10 nodes each, refined at the supports), estimates on the given one.
// Prints Markdown tables.
//
//   build/release/benchmarks/location_study [LOADS [DRAWS [ROW [MESHES]]]]
//
// LOADS different loads per row, each seen DRAWS times with fresh noise; ROW: 1 to 12, 0 for all.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "softforce/estimation/location_estimator.h"
#include "softforce/fem/compliance.h"
#include "softforce/geometry/chi_square.h"
#include "softforce/validation/direct_model.h"
#include "softforce/validation/discretisation.h"
#include "softforce/validation/inverse_model.h"
#include "softforce/validation/model.h"

namespace {

using namespace softforce;
using estimation::LocatedForce;
using estimation::LocationMethod;
using validation::AppliedForce;
using validation::BodyKind;

struct Arrangement {
  BodyKind body;
  std::vector<Eigen::Vector3d> markers, candidates;  // m
};

// 14 markers on the sheet and 12 candidates under it.
Arrangement OnSheet() {
  Arrangement sheet{BodyKind::kSheet, {}, {}};
  for (const int y : {40, 100, 160}) {
    for (const int x : {40, 80, 120, 160}) sheet.markers.emplace_back(1e-3 * x, 1e-3 * y, 0.01);
  }
  for (const int y : {70, 130}) sheet.markers.emplace_back(0.1, 1e-3 * y, 0.01);
  for (const int y : {50, 100, 150}) {
    for (const int x : {40, 80, 120, 160}) sheet.candidates.emplace_back(1e-3 * x, 1e-3 * y, 0);
  }
  return sheet;
}

// 9 markers and 8 candidates: on the platform, and half-way up the legs.
Arrangement OnRobot() {
  Arrangement robot{BodyKind::kRobot, {}, {}};
  const auto leg = [](int i, double z, double aside) {
    const double out = 0.058 - 0.044 / 0.094 * z + (aside == 0 ? 0.0065 : 0);
    const double angle = M_PI / 2 * i;
    return Eigen::Vector3d(std::cos(angle) * out - std::sin(angle) * aside,
                           std::sin(angle) * out + std::cos(angle) * aside, z);
  };
  for (int i = 0; i < 4; ++i) {
    robot.markers.push_back(leg(i, 0.035, 0));
    robot.markers.push_back(leg(i, 0.065, 0.008));
    robot.candidates.push_back(leg(i, 0.05, 0));
  }
  robot.markers.emplace_back(0, 0, 0.1);
  for (int i = 0; i < 4; ++i) {
    robot.candidates.emplace_back(0.009 * std::cos(M_PI / 2 * i), 0.009 * std::sin(M_PI / 2 * i),
                                  0.1);
  }
  return robot;
}

// The truth and the model that estimates.
class Bench {
 public:
  Bench(Arrangement arrangement, const std::filesystem::path& meshes)
      : arrangement_(std::move(arrangement)) {
    const auto cut = validation::MakeDiscretisations(arrangement_.body, meshes);
    truth_ = validation::MakeModel(arrangement_.body, cut.inverse, validation::kYoungsModulus);
    given_ = validation::MakeModel(arrangement_.body, cut.given, validation::kYoungsModulus);
    told_ = fem::NoActuation(truth_.body);
    truth_solver_ = std::make_unique<fem::StaticSolver>(truth_.body, "truth");
    solver_ = std::make_unique<fem::StaticSolver>(given_.body, "model");
    state_ = truth_solver_->AtRest();
  }

  const Arrangement& arrangement() const { return arrangement_; }

  // By default or not at all.
  void AllowForModelErrors(bool allow) { model_errors_ = allow; }

  std::vector<Eigen::Vector3d> Seen(const std::vector<AppliedForce>& forces) {
    if (!truth_solver_->Solve(validation::LoadOf(truth_, forces, told_), &state_).ok()) {
      state_ = truth_solver_->AtRest();
      return {};
    }
    return validation::Seen(truth_, state_, arrangement_.markers);
  }

  std::vector<estimation::Observation> Observe(const std::vector<Eigen::Vector3d>& seen,
                                               double sigma, std::mt19937* random) const {
    std::normal_distribution<double> noise(0, sigma);
    std::vector<estimation::Observation> observations;
    for (size_t i = 0; i < seen.size(); ++i) {
      estimation::Observation observation;
      observation.at = validation::PointAt(given_, arrangement_.markers[i]);
      observation.position = seen[i];
      for (int axis = 0; axis < 3; ++axis) observation.position(axis) += noise(*random);
      observation.whitening = Eigen::Matrix3d::Identity() / sigma;
      observations.push_back(observation);
    }
    return observations;
  }

  mesh::SurfacePoint At(const Eigen::Vector3d& place) const {
    return mesh::ClosestSurfacePoint(given_.surface, given_.body.mesh.nodes, place).at;
  }

  estimation::LocationEstimator Estimator(LocationMethod method,
                                          estimation::ForceDirection direction,
                                          const std::set<int>& among) {
    std::vector<estimation::LocationCandidate> candidates;
    for (int c = 0; c < static_cast<int>(arrangement_.candidates.size()); ++c) {
      if (!among.empty() && among.count(c) == 0) continue;
      candidates.push_back({std::to_string(c), At(arrangement_.candidates[c]), direction});
    }
    estimation::LocationOptions options;
    options.method = method;
    options.patch = validation::kPatch;
    if (!model_errors_) {
      options.estimator.common_model_error = options.estimator.local_model_error = 0;
    }
    return {solver_.get(), given_.surface, candidates, options};
  }

  estimation::LocationEstimate Estimate(estimation::LocationEstimator* estimator,
                                        const std::vector<estimation::Observation>& seen) const {
    return estimator->Estimate(seen, told_);
  }

  // N/m, of the body at rest with all candidates free.
  double IndexW() {
    validation::InverseModel inverse(
        given_, solver_.get(),
        {"", arrangement_.body, "", arrangement_.candidates, arrangement_.markers},
        validation::LeastSquares(1e-6), 1e-4);
    inverse.estimator().Advance(told_);
    return fem::InverseComplianceNorm(inverse.Compliance());
  }

  Eigen::Vector3d InwardNormal(const Eigen::Vector3d& place) const {
    return -mesh::Normal(given_.surface, given_.body.mesh.nodes, At(place));
  }

 private:
  Arrangement arrangement_;
  validation::Model truth_, given_;
  fem::Actuation told_;
  std::unique_ptr<fem::StaticSolver> truth_solver_, solver_;
  fem::Equilibrium state_;
  bool model_errors_ = true;
};

constexpr double kSure = 0.97;  // probability from which an answer is taken to be without doubt

double Median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// One to three loaded candidates, 0.2 to 0.6 N each.
struct Load {
  std::set<int> loaded;
  std::vector<AppliedForce> forces;
};
Load DrawLoad(const Bench& bench, bool push, std::mt19937* random) {
  const auto& places = bench.arrangement().candidates;
  std::uniform_int_distribution<int> count(1, 3), which(0, static_cast<int>(places.size()) - 1);
  std::uniform_real_distribution<double> strength(0.2, 0.6), sign(-1, 1);
  std::normal_distribution<double> normal;
  Load load;
  for (const int n = count(*random); static_cast<int>(load.loaded.size()) < n;) {
    const int c = which(*random);
    if (!load.loaded.insert(c).second) continue;
    const Eigen::Vector3d inward = bench.InwardNormal(places[c]);
    // Mostly across the surface: nobody pulls silicone along it by newtons.
    Eigen::Vector3d direction = inward * (push || sign(*random) > 0 ? 1 : -1);
    if (!push) {
      for (int axis = 0; axis < 3; ++axis) direction(axis) += 0.2 * normal(*random);
    }
    load.forces.push_back({places[c], strength(*random) * direction.normalized()});
  }
  return load;
}

// The sum of the absolute errors of all components of all candidates, N.
double ErrorOf(const std::vector<LocatedForce>& forces, const Bench& bench, const Load& load) {
  const auto& places = bench.arrangement().candidates;
  std::vector<Eigen::Vector3d> error(places.size(), Eigen::Vector3d::Zero());
  const auto nearest = [&](const Eigen::Vector3d& place) {
    size_t best = 0;
    for (size_t c = 1; c < places.size(); ++c) {
      if ((places[c] - place).norm() < (places[best] - place).norm()) best = c;
    }
    return best;
  };
  for (const LocatedForce& force : forces) error[nearest(force.rest)] += force.force;
  for (const AppliedForce& force : load.forces) error[nearest(force.place)] -= force.force;
  double sum = 0;
  for (const Eigen::Vector3d& e : error) sum += e.lpNorm<1>();
  return sum;
}

// Which candidates are loaded, and the forces on them beside those of an estimate that is told.
void StudySets(Bench* bench, const std::string& name, double sigma, bool push, bool model_errors,
               int loads, int draws) {
  bench->AllowForModelErrors(model_errors);
  std::mt19937 random(7);
  const auto direction =
      push ? estimation::ForceDirection::kPush : estimation::ForceDirection::kFree;
  int trials = 0, right = 0, wrong = 0, lost = 0, sure = 0, right_and_sure = 0;
  double held = 0;  // sum of the probabilities of what was found
  std::vector<double> errors, oracle;
  for (int l = 0; l < loads; ++l) {
    const Load load = DrawLoad(*bench, push, &random);
    const std::vector<Eigen::Vector3d> seen = bench->Seen(load.forces);
    if (seen.empty()) continue;
    auto estimator = bench->Estimator(LocationMethod::kCandidates, direction, {});
    auto told = bench->Estimator(LocationMethod::kCandidates, direction, load.loaded);
    for (int d = 0; d < draws; ++d) {
      const auto observations = bench->Observe(seen, sigma, &random);
      const auto estimate = bench->Estimate(&estimator, observations);
      const auto known = bench->Estimate(&told, observations);
      ++trials;
      if (!estimate.ok()) {
        ++lost;
        continue;
      }
      std::set<int> found;
      for (const LocatedForce& force : estimate.forces) found.insert(force.candidate);
      const bool is_sure = estimate.probability >= kSure;
      sure += is_sure;
      held += estimate.probability;
      if (found == load.loaded) {
        ++right;
        right_and_sure += is_sure;
      } else {
        wrong += is_sure;
      }
      errors.push_back(ErrorOf(estimate.forces, *bench, load));
      if (known.ok()) oracle.push_back(ErrorOf(known.forces, *bench, load));
    }
  }
  double mean = 0, mean_oracle = 0;
  for (const double e : errors) mean += e / static_cast<double>(errors.size());
  for (const double e : oracle) mean_oracle += e / static_cast<double>(oracle.size());
  const int answered = std::max(trials - lost, 1);
  fmt::print(
      "| {} | {} | {:.2f} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} | {:.1f} | {:.1f} "
      "| {:.2f} |\n",
      name, push ? "push" : "free", 1e3 * sigma, model_errors ? "default" : "none",
      100.0 * right / trials, 100 * held / answered, 100.0 * sure / trials,
      100.0 * right_and_sure / std::max(sure, 1), 100.0 * wrong / trials, lost, 1e3 * mean,
      1e3 * mean_oracle, mean / mean_oracle);
  std::fflush(stdout);
}

// One force anywhere between the candidates: how far off it is found, beside what the noise alone
// allows, and how often its 95 % region holds it.
void StudyPlaces(Bench* bench, bool model_errors, double sigma, bool push, int loads, int draws) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(0.04, 0.16), y(0.05, 0.15), strength(0.3, 0.6);
  const auto direction =
      push ? estimation::ForceDirection::kPush : estimation::ForceDirection::kFree;
  const double limit = geometry::ChiSquareQuantile(0.95, 2);
  int trials = 0, one = 0, covered = 0;
  std::vector<double> errors, floors;  // m
  for (int l = 0; l < loads; ++l) {
    const AppliedForce applied{{x(random), y(random), 0}, {0, 0, strength(random)}};
    const std::vector<Eigen::Vector3d> seen = bench->Seen({applied});
    auto estimator = bench->Estimator(LocationMethod::kContinuous, direction, {});
    for (int d = 0; d < draws; ++d) {
      const auto observations = bench->Observe(seen, sigma, &random);
      const auto estimate = bench->Estimate(&estimator, observations);
      ++trials;
      if (!estimate.ok() || estimate.forces.size() != 1) continue;
      ++one;
      const LocatedForce& force = estimate.forces[0];
      const Eigen::Vector2d apart = force.tangents.transpose() * (force.rest - applied.place);
      covered += apart.dot(force.location_covariance.ldlt().solve(apart)) <= limit;
      errors.push_back(apart.norm());
      // The floor of the true force at its true place, with the noise alone.
      LocatedForce truth = force;
      truth.at = bench->At(applied.place);
      truth.force = applied.force;
      const auto floor = estimator.Floor(observations, {truth});
      if (floor.empty()) continue;
      const Eigen::Matrix2d L = floor[0].location_covariance.llt().matrixL();
      std::normal_distribution<double> normal;
      floors.push_back((L * Eigen::Vector2d(normal(random), normal(random))).norm());
    }
  }
  fmt::print("| sheet | {} | {:.2f} | {} | {} | {:.1f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} |\n",
             push ? "push" : "free", 1e3 * sigma, model_errors ? "default" : "none", trials,
             100.0 * one / trials, 1e3 * Median(errors), 1e3 * Median(floors),
             Median(errors) / Median(floors), 100.0 * covered / std::max(one, 1));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int loads = argc > 1 ? std::atoi(argv[1]) : 60;
  const int draws = argc > 2 ? std::atoi(argv[2]) : 9;
  const int only = argc > 3 ? std::atoi(argv[3]) : 0;
  const std::filesystem::path meshes =
      argc > 4 ? argv[4] : std::string(SOFTFORCE_SOURCE_DIR) + "/meshes";
  if (loads < 1 || draws < 1) {
    fmt::print(stderr, "location_study: got \"{}\", expected numbers of loads and draws\n",
               argv[1]);
    return 2;
  }
  Bench sheet(OnSheet(), meshes), robot(OnRobot(), meshes);
  fmt::print("I_w with all candidates free: sheet {:.0f}, robot {:.0f} N/mm\n\n",
             1e-3 * sheet.IndexW(), 1e-3 * robot.IndexW());
  int row = 0;
  const auto wanted = [&] { return ++row == only || only == 0; };
  fmt::print(
      "| loaded candidates | directions | noise, mm | model errors | right set, % | held to be "
      "right, "
      "% | without doubt, % | of these right, % | wrong and without doubt, % | lost | force error, "
      "mN | told which, mN | ratio |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool model_errors : {true, false}) {
    if (wanted()) StudySets(&sheet, "sheet, 12, 14", 1e-4, false, model_errors, loads, draws);
    if (wanted()) StudySets(&robot, "robot, 8, 9", 1e-4, false, model_errors, loads, draws);
    if (wanted()) StudySets(&sheet, "sheet, 12, 14", 5e-5, false, model_errors, loads, draws);
    if (wanted()) StudySets(&sheet, "sheet, 12, 14", 5e-5, true, model_errors, loads, draws);
  }
  fmt::print(
      "\n| one force between candidates | directions | noise, mm | model errors | trials | one "
      "found, % | median error, mm | floor, mm | ratio | in its 95 % region, % "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool model_errors : {true, false}) {
    sheet.AllowForModelErrors(model_errors);
    if (wanted()) StudyPlaces(&sheet, model_errors, 5e-5, false, loads, draws);
    if (wanted()) StudyPlaces(&sheet, model_errors, 5e-5, true, loads, draws);
  }
  return 0;
}
