// Cost of one frame with forces of unknown number, place and strength, warm-started: on the two
// bodies of the paper's size, free forces looked for near 12 and 8 candidates. Every
// refactorisation on the way is included; markers are seen with noise.
//   yardsticks  processor time divided by that of one factorisation of the tangent at rest
//   per_second  frames per second of processor time
//   slowest     milliseconds of processor time of the frame at 95 % of all
//   right       share of the frames with as many forces as there are
//   off_mm      median distance of the places found from where the forces are
//
//   build/release/benchmarks/location_benchmark
#include <algorithm>
#include <cmath>
#include <random>

#include "softforce/estimation/location_estimator.h"
#include "speed/measured_robot.h"

namespace softforce::benchmarks {
namespace {

using estimation::LocationCandidate;
using estimation::LocationEstimate;
using estimation::LocationEstimator;
using estimation::LocationMethod;
using estimation::Observation;

constexpr double kNoise = 5e-5;  // m, of each coordinate of a marker
constexpr double kPatch = 6e-3;  // m

struct Force {
  Eigen::Vector3d place;  // m, body at rest
  Eigen::Vector3d force;  // N
};

// What is seen of a body under forces that move and change.
struct Film {
  std::vector<std::vector<Force>> forces;      // per frame
  std::vector<std::vector<Observation>> seen;  // per frame
};

// A body, its markers, and candidates.
struct Stage {
  fem::Body body;
  fem::Actuation actuation;
  std::vector<Eigen::Vector3d> markers, candidates;  // m
  double yardstick = NAN;                            // s
  mesh::Surface surface = {};

  mesh::SurfacePoint At(const Eigen::Vector3d& place) const {
    return mesh::ClosestSurfacePoint(surface, body.mesh.nodes, place).at;
  }

  Film Shoot(const std::vector<std::vector<Force>>& forces) const {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, kNoise);
    fem::StaticSolver solver(body, "body");
    fem::Equilibrium state = solver.AtRest();
    Film film{forces, {}};
    for (const std::vector<Force>& acting : forces) {
      fem::LoadCase load = fem::OwnWeight(body);
      load.actuation = actuation;
      for (const Force& force : acting) {
        load.forces +=
            testing::LoadAt(body,
                            mesh::PatchWeights(surface, body.mesh.nodes, At(force.place), kPatch),
                            force.force)
                .forces;
      }
      solver.Solve(load, &state);
      std::vector<Observation> seen;
      for (const Eigen::Vector3d& marker : markers) {
        const mesh::NodalWeights at = mesh::ShapeFunctions(surface, At(marker));
        Eigen::Vector3d p = at.Apply(body.mesh.nodes) + at.Apply(state.u);
        for (int axis = 0; axis < 3; ++axis) p(axis) += noise(random);
        seen.push_back({at, Eigen::Vector3d::Zero(), p, Eigen::Matrix3d::Identity() / kNoise});
      }
      film.seen.push_back(seen);
    }
    return film;
  }
};

Stage OnSheet(benchmark::State& state) {
  const Case& c = CaseOf(state);
  Stage stage{c.sheet.body, fem::NoActuation(c.sheet.body), {}, {}, c.yardstick};
  for (const int y : {40, 100, 160}) {
    for (const int x : {40, 80, 120, 160}) stage.markers.emplace_back(1e-3 * x, 1e-3 * y, 0.01);
  }
  for (const int y : {70, 130}) stage.markers.emplace_back(0.1, 1e-3 * y, 0.01);
  for (const int y : {50, 100, 150}) {
    for (const int x : {40, 80, 120, 160}) stage.candidates.emplace_back(1e-3 * x, 1e-3 * y, 0);
  }
  stage.surface = mesh::ExtractSurface(stage.body.mesh);
  return stage;
}

// On the platform, and half-way up the legs.
Stage OnRobot(int order) {
  const Robot robot(order);
  Stage stage{robot.body, robot.actuation, {}, {}, robot.yardstick};
  const auto leg = [](int i, double z, double aside) {
    const double out = 0.058 - 0.044 / 0.094 * z + (aside == 0 ? 0.0065 : 0);
    const double angle = M_PI / 2 * i;
    return Eigen::Vector3d(std::cos(angle) * out - std::sin(angle) * aside,
                           std::sin(angle) * out + std::cos(angle) * aside, z);
  };
  for (int i = 0; i < 4; ++i) {
    stage.markers.push_back(leg(i, 0.035, 0));
    stage.markers.push_back(leg(i, 0.065, 0.008));
    stage.candidates.push_back(leg(i, 0.05, 0));
  }
  stage.markers.emplace_back(0, 0, 0.1);
  for (int i = 0; i < 4; ++i) {
    stage.candidates.emplace_back(0.009 * std::cos(M_PI / 2 * i), 0.009 * std::sin(M_PI / 2 * i),
                                  0.1);
  }
  stage.surface = mesh::ExtractSurface(stage.body.mesh);
  return stage;
}

double Middle(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void MeasureFrames(benchmark::State& state, const Stage& stage, const Film& film,
                   LocationMethod method) {
  std::vector<LocationCandidate> candidates;
  for (const Eigen::Vector3d& place : stage.candidates) {
    candidates.push_back({std::to_string(candidates.size()), stage.At(place)});
  }
  estimation::LocationOptions options;
  options.method = method;
  options.patch = kPatch;
  fem::StaticSolver solver(stage.body, "body");
  LocationEstimator estimator(&solver, stage.surface, candidates, options);
  estimator.Estimate(film.seen.back(), stage.actuation);
  size_t next = 0;
  int right = 0;
  std::vector<double> off, took;
  for (auto _ : state) {
    const size_t frame = next++ % film.seen.size();
    const double begin = Seconds(CLOCK_PROCESS_CPUTIME_ID);
    const LocationEstimate estimate = estimator.Estimate(film.seen[frame], stage.actuation);
    took.push_back(Seconds(CLOCK_PROCESS_CPUTIME_ID) - begin);
    if (!estimate.ok()) continue;
    if (estimate.forces.size() == film.forces[frame].size()) ++right;
    for (const estimation::LocatedForce& found : estimate.forces) {
      double nearest = INFINITY;
      for (const Force& force : film.forces[frame]) {
        nearest = std::min(nearest, (found.rest - force.place).norm());
      }
      off.push_back(nearest);
    }
  }
  double sum = 0;
  for (const double seconds : took) sum += seconds;
  const double each = sum / static_cast<double>(took.size());
  state.counters["yardsticks"] = each / stage.yardstick;
  state.counters["per_second"] = 1 / each;
  state.counters["slowest"] = 1e3 * Middle(took, 0.95);
  state.counters["right"] = static_cast<double>(right) / static_cast<double>(took.size());
  state.counters["off_mm"] = 1e3 * Middle(off, 0.5);
}

// Two weights, up and down from a half to the whole of 0.5 N: between candidates, or at two of them
// if no other place is looked at.
void TwoWeightsOnTheSheet(benchmark::State& state) {
  const Stage stage = OnSheet(state);
  const auto method = static_cast<LocationMethod>(state.range(2));
  const bool between = method == LocationMethod::kContinuous;
  const Eigen::Vector3d one = between ? Eigen::Vector3d(0.065, 0.13, 0) : stage.candidates[9];
  const Eigen::Vector3d two = between ? Eigen::Vector3d(0.14, 0.075, 0) : stage.candidates[3];
  std::vector<std::vector<Force>> forces;
  for (int step = 0; step < 2 * kSteps; ++step) {
    const double up = static_cast<double>(step < kSteps ? step : 2 * kSteps - step) / kSteps;
    const Eigen::Vector3d weight(0, 0, -kWeight * (0.5 + 0.5 * up));
    forces.push_back({{one, weight}, {two, weight}});
  }
  MeasureFrames(state, stage, stage.Shoot(forces), method);
}

// A force of 0.5 N that slides by 85 mm there and back.
void SlidingOverTheSheet(benchmark::State& state) {
  const Stage stage = OnSheet(state);
  std::vector<std::vector<Force>> forces;
  for (int step = 0; step < 2 * kSteps; ++step) {
    const double way = static_cast<double>(step < kSteps ? step : 2 * kSteps - step) / kSteps;
    forces.push_back({{{0.06 + 0.08 * way, 0.08 + 0.03 * way, 0}, {0, 0, -kWeight}}});
  }
  MeasureFrames(state, stage, stage.Shoot(forces), LocationMethod::kContinuous);
}

// A push of 0.2 to 0.4 N on the platform of the pulled robot, between candidates.
void PushOnTheRobot(benchmark::State& state) {
  const Stage stage = OnRobot(static_cast<int>(state.range(0)));
  const Eigen::Vector3d place =
      mesh::Position(stage.surface, stage.body.mesh.nodes, stage.At({0.006, 0.003, 0.1}));
  std::vector<std::vector<Force>> forces;
  for (int step = 0; step < 2 * kSteps; ++step) {
    const double up = static_cast<double>(step < kSteps ? step : 2 * kSteps - step) / kSteps;
    forces.push_back({{place, {0, 0, -0.4 * (0.5 + 0.5 * up)}}});
  }
  MeasureFrames(state, stage, stage.Shoot(forces), LocationMethod::kContinuous);
}

// Whole sweeps, so that every part of the range counts alike.
BENCHMARK(TwoWeightsOnTheSheet)
    ->ArgNames({"cells", "order", "method"})
    ->ArgsProduct({{4971},
                   {1, 2},
                   {static_cast<int>(LocationMethod::kContinuous),
                    static_cast<int>(LocationMethod::kCandidates)}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2 * kSteps);
BENCHMARK(SlidingOverTheSheet)
    ->ArgNames({"cells", "order"})
    ->Args({4971, 1})
    ->Args({4971, 2})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2 * kSteps);
BENCHMARK(PushOnTheRobot)
    ->ArgName("order")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2 * kSteps);

}  // namespace
}  // namespace softforce::benchmarks

BENCHMARK_MAIN();
