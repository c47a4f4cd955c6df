// What a choice of marker places by softforce's design is worth beside random ones: expected errors
// of the place of a force, and errors of LocationEstimator with truths from another mesh (cut by
// Gmsh on its own, 4 times the cells, refined at the supports). The bodies are those of validation.
// Prints Markdown tables.
//
//   build/release/benchmarks/design_study [LOADS [LAYOUTS [MESHES]]]
//
// LOADS forces between candidates for each number of markers, seen by the chosen markers, and by
// LAYOUTS random layouts in turn. 0: expected errors only.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "softforce/design/choose_places.h"
#include "softforce/estimation/location_estimator.h"
#include "softforce/mesh/spread_points.h"
#include "softforce/validation/direct_model.h"
#include "softforce/validation/discretisation.h"
#include "softforce/validation/model.h"

namespace {

using namespace softforce;
using validation::AppliedForce;
using validation::BodyKind;

constexpr double kNoise = 5e-5;         // m, of each coordinate of a marker
constexpr double kMarker = 6e-3;        // m
constexpr double kPlaceSpacing = 9e-3;  // m, between places for markers
constexpr double kForce = 0.4;          // N, that the design is made for
constexpr int kRandomExpected = 200;    // random layouts whose expected errors are compared

// The value that a share of them is below.
double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  const auto at =
      std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  std::sort(values.begin(), values.end());
  return values[at];
}
double Median(const std::vector<double>& values) { return Quantile(values, 0.5); }

constexpr double kMost = 0.9;  // of the forces

// The model that estimates, places for markers and loads on it, and the truth.
class Bench {
 public:
  Bench(BodyKind kind, const std::filesystem::path& meshes, bool with_truth) : kind_(kind) {
    if (with_truth) {
      const auto cut = validation::MakeDiscretisations(kind, meshes);
      truth_ = validation::MakeModel(kind, cut.inverse, validation::kYoungsModulus);
      truth_solver_ = std::make_unique<fem::StaticSolver>(truth_.body, "truth");
      given_ = validation::MakeModel(kind, cut.given, validation::kYoungsModulus);
    } else {
      given_ = validation::MakeModel(kind, mesh::RaiseOrder(validation::ReadBodyMesh(kind, meshes)),
                                     validation::kYoungsModulus);
    }
    solver_ = std::make_unique<fem::StaticSolver>(given_.body, "model");
    held_.insert(given_.body.fixed_nodes.begin(), given_.body.fixed_nodes.end());
    // The sheet is pushed from below and seen from above; the robot's whole skin serves for both.
    const auto any = [&](const mesh::SurfacePoint& at) { return Free(at); };
    places_ =
        mesh::SpreadPoints(given_.surface, X(), Faces(1), kPlaceSpacing,
                           [&](const mesh::SurfacePoint& at) { return Free(at) && HasRoom(at); });
    load_places_ =
        mesh::SpreadPoints(given_.surface, X(), Faces(-1), std::sqrt(Area(Faces(-1)) / 150), any);
    candidates_ =
        mesh::SpreadPoints(given_.surface, X(), Faces(-1), std::sqrt(Area(Faces(-1)) / 25), any);
  }

  // Expected errors for any choice of the places.
  design::ExpectedErrors Errors() {
    std::vector<design::PlacedLoad> loads;
    for (const mesh::SurfacePoint& at : load_places_) {
      const design::SampledLoad load{at, Eigen::Matrix3d::Identity(), kForce * Inward(at)};
      loads.emplace_back(given_.surface, X(), load, validation::kPatch);
    }
    std::vector<mesh::NodalWeights> points;
    std::vector<design::MarkerSight> sights;
    for (const mesh::SurfacePoint& at : places_) {
      points.push_back(mesh::ShapeFunctions(given_.surface, at));
      sights.push_back({Position(at), Eigen::Matrix3d::Identity() / (kNoise * kNoise)});
    }
    design::ErrorModel model;
    model.force_sd = kForce;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    const auto count = static_cast<double>(load_places_.size());
    for (const mesh::SurfacePoint& at : load_places_) centre += Position(at) / count;
    double variance = 0;
    for (const mesh::SurfacePoint& at : load_places_) {
      variance += (Position(at) - centre).squaredNorm() / count;
    }
    model.location_sd = std::sqrt(variance / 2);
    return {design::ComputeInfluence(solver_.get(), solver_->AtRest(), points, loads), loads,
            sights, model};
  }

  // Forces at random places, and where all places for markers are under each.
  struct Truth {
    AppliedForce applied;
    std::vector<Eigen::Vector3d> seen;  // m
  };
  std::vector<Truth> DrawTruths(int count) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> strength(0.3, 0.5);
    // Dense enough that they stand anywhere between the candidates.
    std::vector<mesh::SurfacePoint> anywhere =
        mesh::SpreadPoints(given_.surface, X(), Faces(-1), std::sqrt(Area(Faces(-1)) / 700),
                           [&](const mesh::SurfacePoint& at) { return Free(at); });
    std::shuffle(anywhere.begin(), anywhere.end(), random);
    std::vector<Eigen::Vector3d> markers;
    for (const mesh::SurfacePoint& at : places_) markers.push_back(Position(at));
    std::vector<Truth> truths;
    for (const mesh::SurfacePoint& at : anywhere) {
      if (static_cast<int>(truths.size()) == count) break;
      Truth truth;
      truth.applied = {Position(at), strength(random) * Inward(at)};
      fem::Equilibrium state = truth_solver_->AtRest();
      const fem::LoadCase load =
          validation::LoadOf(truth_, {truth.applied}, fem::NoActuation(truth_.body));
      if (!truth_solver_->Solve(load, &state).ok()) continue;
      truth.seen = validation::Seen(truth_, state, markers);
      truths.push_back(std::move(truth));
    }
    return truths;
  }

  // How far from its place the force is found by a layout, m; infinite if none is.
  double LocationError(const Truth& truth, const std::vector<int>& layout, unsigned int seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, kNoise);
    std::vector<estimation::Observation> observations;
    for (const int place : layout) {
      estimation::Observation observation;
      observation.at = mesh::ShapeFunctions(given_.surface, places_[place]);
      observation.position = truth.seen[place];
      for (double& coordinate : observation.position) coordinate += noise(random);
      observation.whitening = Eigen::Matrix3d::Identity() / kNoise;
      observations.push_back(observation);
    }
    std::vector<estimation::LocationCandidate> candidates;
    for (const mesh::SurfacePoint& at : candidates_) {
      candidates.push_back({std::to_string(candidates.size()), at});
    }
    estimation::LocationOptions options;
    options.patch = validation::kPatch;
    options.max_forces = 2;
    estimation::LocationEstimator estimator(solver_.get(), given_.surface, candidates, options);
    const auto estimate = estimator.Estimate(observations, fem::NoActuation(solver_->body()));
    double nearest = INFINITY;
    for (const auto& force : estimate.forces) {
      nearest = std::min(nearest, (force.rest - truth.applied.place).norm());
    }
    return nearest;
  }

  const char* name() const { return validation::Name(kind_); }
  int num_places() const { return static_cast<int>(places_.size()); }

 private:
  const Eigen::Matrix3Xd& X() const { return given_.body.mesh.nodes; }
  Eigen::Vector3d Position(const mesh::SurfacePoint& at) const {
    return mesh::Position(given_.surface, X(), at);
  }
  Eigen::Vector3d Inward(const mesh::SurfacePoint& at) const {
    return -mesh::Normal(given_.surface, X(), at);
  }

  // Of the sheet: what faces up (1) or down (−1). Of the robot: all but its feet.
  std::vector<int> Faces(int side) const {
    std::vector<int> faces;
    for (int t = 0; t < given_.surface.num_triangles(); ++t) {
      const mesh::SurfacePoint middle{t, Eigen::Vector3d::Constant(1.0 / 3)};
      const double up = -Inward(middle).z();
      const bool is_in = kind_ == BodyKind::kSheet ? side * up > 0.9 : Free(middle);
      if (is_in) faces.push_back(t);
    }
    return faces;
  }
  double Area(const std::vector<int>& faces) const {
    double area = 0;
    for (const int t : faces) {
      const Eigen::Vector3d a = X().col(given_.surface.triangles(0, t));
      const Eigen::Vector3d ab = X().col(given_.surface.triangles(1, t)) - a;
      area += ab.cross(X().col(given_.surface.triangles(2, t)) - a).norm() / 2;
    }
    return area;
  }
  bool Free(const mesh::SurfacePoint& at) const {
    const mesh::NodalWeights weights = mesh::ShapeFunctions(given_.surface, at);
    for (size_t n = 0; n < weights.nodes.size(); ++n) {
      if (std::abs(weights.weights[n]) > 1e-9 && held_.count(weights.nodes[n]) == 0) return true;
    }
    return false;
  }
  bool HasRoom(const mesh::SurfacePoint& at) const {
    const Eigen::Vector3d normal = -Inward(at), right = normal.unitOrthogonal();
    for (int i = 0; i < 8; ++i) {
      const double angle = M_PI / 4 * i;
      const auto rim = mesh::ClosestSurfacePoint(
          given_.surface, X(),
          Position(at) +
              kMarker / 2 * (std::cos(angle) * right + std::sin(angle) * normal.cross(right)));
      if (rim.distance > 0.1 * kMarker) return false;
    }
    return true;
  }

  BodyKind kind_;
  validation::Model truth_, given_;
  std::unique_ptr<fem::StaticSolver> truth_solver_, solver_;
  std::set<int> held_;
  std::vector<mesh::SurfacePoint> places_, load_places_, candidates_;
};

// The layouts of one number of markers.
struct Layouts {
  std::vector<int> chosen;
  std::vector<std::vector<int>> random;
};

Layouts StudyExpected(const Bench& bench, const design::ExpectedErrors& errors, int markers) {
  design::ChoiceOptions options;
  options.count = markers;
  Layouts layouts;
  layouts.chosen = design::ChoosePlaces(errors, options).places;
  options.criterion = design::Criterion::kDOptimal;
  const std::vector<int> d_optimal = design::ChoosePlaces(errors, options).places;
  options.max_passes = options.more_starts = 0;
  const std::vector<int> greedy = design::ChoosePlaces(errors, options).places;
  layouts.random = design::RandomLayouts(bench.num_places(), markers, kRandomExpected, 5);
  const auto median = [&](const std::vector<int>& layout) {
    return 1e3 * design::MedianLocation(errors.Expect(layout));
  };
  const auto most = [&](const std::vector<int>& layout) {
    std::vector<double> values;
    for (const auto& error : errors.Expect(layout)) values.push_back(1e3 * error.location);
    return Quantile(values, kMost);
  };
  std::vector<double> random, random_most;
  for (const auto& layout : layouts.random) {
    random.push_back(median(layout));
    random_most.push_back(most(layout));
  }
  const double of_random = Median(random), chosen = median(layouts.chosen);
  const double chosen_most = most(layouts.chosen), of_random_most = Median(random_most);
  fmt::print(
      "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} "
      "|\n",
      bench.name(), markers, chosen, median(d_optimal), median(greedy), of_random,
      *std::min_element(random.begin(), random.end()), of_random / chosen, chosen_most,
      of_random_most, of_random_most / chosen_most);
  std::fflush(stdout);
  return layouts;
}

void StudyEstimates(Bench* bench, const std::vector<Bench::Truth>& truths, const Layouts& layouts,
                    int num_random) {
  std::vector<double> chosen, random;
  for (size_t i = 0; i < truths.size(); ++i) {
    const auto seed = static_cast<unsigned int>(100 + i);
    chosen.push_back(1e3 * bench->LocationError(truths[i], layouts.chosen, seed));
    random.push_back(1e3 * bench->LocationError(truths[i], layouts.random[i % num_random], seed));
  }
  const auto lost = [](const std::vector<double>& errors) {
    return std::count_if(errors.begin(), errors.end(), [](double e) { return !std::isfinite(e); });
  };
  const double chosen_most = Quantile(chosen, kMost), random_most = Quantile(random, kMost);
  fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} | {} |\n",
             bench->name(), layouts.chosen.size(), truths.size(), Median(chosen), Median(random),
             Median(random) / Median(chosen), chosen_most, random_most, random_most / chosen_most,
             lost(chosen), lost(random));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int loads = argc > 1 ? std::atoi(argv[1]) : 60;
  const int num_random = argc > 2 ? std::atoi(argv[2]) : 20;
  const std::filesystem::path meshes =
      argc > 3 ? argv[3] : std::string(SOFTFORCE_SOURCE_DIR) + "/meshes";
  if (loads < 0 || num_random < 1 || num_random > kRandomExpected) {
    fmt::print(stderr, "design_study: expected a number of loads, and of 1 to {} layouts\n",
               kRandomExpected);
    return 2;
  }
  Bench sheet(BodyKind::kSheet, meshes, loads > 0), robot(BodyKind::kRobot, meshes, loads > 0);
  fmt::print(
      "| body | markers | chosen, mm | d-optimal | greedy | random | best random | random / chosen "
      "| chosen, 90 % | random, 90 % | random / chosen |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<std::pair<Bench*, Layouts>> studies;
  for (Bench* bench : {&sheet, &robot}) {
    const design::ExpectedErrors errors = bench->Errors();
    for (const int markers : {4, 6, 9, 14}) {
      studies.emplace_back(bench, StudyExpected(*bench, errors, markers));
    }
  }
  if (loads == 0) return 0;
  fmt::print(
      "\n| body | markers | forces | chosen, mm | random | random / chosen | chosen, 90 % | "
      "random, "
      "90 % | random / chosen | not found, chosen | random |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  const auto of_sheet = sheet.DrawTruths(loads), of_robot = robot.DrawTruths(loads);
  for (const auto& [bench, layouts] : studies) {
    StudyEstimates(bench, bench == &sheet ? of_sheet : of_robot, layouts, num_random);
  }
  return 0;
}
