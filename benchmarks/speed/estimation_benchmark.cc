// Cost of one estimated frame at known places, warm-started on a load that moves: on sheets of 1k
// to 50k cells with 4 and 10 nodes, over the number of force components and of markers, and on the
// two bodies of the paper's size. Loads go up and down through their whole range in steps of 1 %,
// every factorisation on the way included.
//   yardsticks  processor time divided by that of one factorisation of the tangent at rest
//   off         largest difference of a component from the same estimate converged to 1e-3 standard
//               deviations, as a share of the largest force
//   per_second  frames per second of processor time
//
//   build/release/benchmarks/estimation_benchmark
#include <cmath>

#include "softforce/estimation/force_estimator.h"
#include "speed/measured_robot.h"

namespace softforce::benchmarks {
namespace {

using estimation::ForceEstimator;
using estimation::ForceSite;
using estimation::Observation;

constexpr double kNoise = 3e-5;  // m

// A frame to estimate, and what the tightly converged estimate makes of it.
struct Frame {
  std::vector<Observation> seen;
  Eigen::VectorXd converged;
};

// Places on a grid over the sheet's face at height z.
std::vector<mesh::NodalWeights> Grid(const fem::Body& body, int count, double z) {
  const int along = static_cast<int>(std::ceil(std::sqrt(count)));
  std::vector<mesh::NodalWeights> places;
  for (int i = 0; i < count; ++i) {
    const double x = 0.03 + 0.14 * (i % along + 0.5) / along;
    const double y = 0.03 + 0.14 * (static_cast<double>(i) / along) / along;
    places.push_back(testing::PointOf(body, {x, y, z}));
  }
  return places;
}

std::vector<Observation> Observe(const fem::Body& body,
                                 const std::vector<mesh::NodalWeights>& points,
                                 const fem::Equilibrium& state) {
  std::vector<Observation> seen;
  for (const mesh::NodalWeights& point : points) {
    seen.push_back({point, Eigen::Vector3d::Zero(),
                    point.Apply(body.mesh.nodes) + point.Apply(state.u),
                    Eigen::Matrix3d::Identity() / kNoise});
  }
  return seen;
}

// Measures the frames one after another, over and over.
void MeasureFrames(benchmark::State& state, const fem::Body& body,
                   const std::vector<ForceSite>& sites, const fem::Actuation& actuation,
                   std::vector<Frame> frames, double yardstick) {
  fem::StaticSolverOptions tight;
  tight.tolerance = 1e-10;
  fem::StaticSolver exact_solver(body, "body", tight);
  estimation::EstimatorOptions exact;
  exact.tolerance = 1e-3;
  ForceEstimator reference(&exact_solver, sites, exact);
  double largest = 0;
  for (Frame& frame : frames) {
    frame.converged = reference.Estimate(frame.seen, actuation).intensity;
    if (frame.converged.size() == 0) return state.SkipWithError("the reference has no answer");
    largest = std::max(largest, frame.converged.cwiseAbs().maxCoeff());
  }

  fem::StaticSolver solver(body, "body");
  ForceEstimator estimator(&solver, sites);
  estimator.Estimate(frames.back().seen, actuation);
  size_t next = 0;
  double off = 0;
  const double start = Seconds(CLOCK_PROCESS_CPUTIME_ID);
  for (auto _ : state) {
    const Frame& frame = frames[next++ % frames.size()];
    const estimation::ForceEstimate estimate = estimator.Estimate(frame.seen, actuation);
    if (!estimate.ok()) {
      state.SkipWithError(estimate.BriefReport().c_str());
      return;
    }
    off = std::max(off, (estimate.intensity - frame.converged).cwiseAbs().maxCoeff() / largest);
  }
  const double each =
      (Seconds(CLOCK_PROCESS_CPUTIME_ID) - start) / static_cast<double>(state.iterations());
  state.counters["yardsticks"] = each / yardstick;
  state.counters["per_second"] = 1 / each;
  state.counters["off"] = off;
}

// Up and down through the range, in steps of 1 %.
template <typename SolveAt>
std::vector<Frame> Sweep(const fem::Body& body, const std::vector<mesh::NodalWeights>& points,
                         const SolveAt& solve_at) {
  std::vector<Frame> frames;
  for (int step = 1; step <= 2 * kSteps; ++step) {
    const int up = step <= kSteps ? step : 2 * kSteps - step;
    frames.push_back({Observe(body, points, solve_at(static_cast<double>(up) / kSteps)), {}});
  }
  return frames;
}

// Two known directions, twelve markers.
void EstimatedFrame(benchmark::State& state) {
  Case& c = CaseOf(state);
  const Eigen::Matrix3Xd down = -Eigen::Vector3d::UnitZ();
  fem::StaticSolver solver(c.sheet.body, "sheet");
  fem::Equilibrium truth = solver.AtRest();
  MeasureFrames(state, c.sheet.body, {{"0", c.sheet.loads[0], down}, {"1", c.sheet.loads[1], down}},
                {},
                Sweep(c.sheet.body, c.sheet.points,
                      [&](double share) {
                        solver.Solve(c.sheet.Load(share), &truth);
                        return truth;
                      }),
                c.yardstick);
}

// The sheet of meshes/ with so many known directions and markers.
void ForcesAndMarkers(benchmark::State& state) {
  Case& c = CaseOf(state);
  const auto forces = static_cast<int>(state.range(2));
  const auto markers = static_cast<int>(state.range(3));
  std::vector<ForceSite> sites;
  for (const mesh::NodalWeights& at : Grid(c.sheet.body, forces, 0)) {
    sites.push_back({std::to_string(sites.size()), at, -Eigen::Vector3d::UnitZ()});
  }
  fem::StaticSolver solver(c.sheet.body, "sheet");
  fem::Equilibrium truth = solver.AtRest();
  MeasureFrames(state, c.sheet.body, sites, {},
                Sweep(c.sheet.body, Grid(c.sheet.body, markers, 0.01),
                      [&](double share) {
                        fem::LoadCase load = fem::OwnWeight(c.sheet.body);
                        for (const ForceSite& site : sites) {
                          const Eigen::Vector3d force(0, 0, -2 * kWeight * share / forces);
                          load.forces += testing::LoadAt(c.sheet.body, site.at, force).forces;
                        }
                        solver.Solve(load, &truth);
                        return truth;
                      }),
                c.yardstick);
}

// The robot with a force at its tip of up to 0.859 N along z, nine markers.
void RobotFrame(benchmark::State& state) {
  const Robot robot(static_cast<int>(state.range(0)));
  const fem::Body& body = robot.body;
  std::vector<mesh::NodalWeights> points;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(7.6, 7.6, 110), Eigen::Vector3d(-7.6, 7.6, 110),
        Eigen::Vector3d(-7.6, -7.6, 110), Eigen::Vector3d(7.6, -7.6, 110),
        Eigen::Vector3d(54.5, 0, 60.6), Eigen::Vector3d(39.8, 0, 76.9),
        Eigen::Vector3d(0, 54.5, 60.6), Eigen::Vector3d(0, 39.8, 76.9),
        Eigen::Vector3d(25.4, 0, 92.9)}) {
    points.push_back(testing::PointOf(body, 1e-3 * place));
  }
  const std::vector<ForceSite> sites{
      {"tip", testing::PointOf(body, {0, 0, 0.096}), -Eigen::Vector3d::UnitZ()}};
  fem::StaticSolver solver(body, "robot");
  fem::Equilibrium truth = solver.AtRest();
  MeasureFrames(
      state, body, sites, robot.actuation,
      Sweep(body, points,
            [&](double share) {
              fem::LoadCase load = testing::LoadAt(body, sites[0].at, {0, 0, -0.859 * share});
              load.actuation = robot.actuation;
              solver.Solve(load, &truth);
              return truth;
            }),
      robot.yardstick);
}

// Whole sweeps, so that every part of the range counts alike.
BENCHMARK(EstimatedFrame)->Apply(EverySize)->Iterations(2 * kSteps);
BENCHMARK(RobotFrame)
    ->ArgName("order")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2 * kSteps);
BENCHMARK(ForcesAndMarkers)
    ->ArgNames({"cells", "order", "forces", "markers"})
    ->ArgsProduct({{4971}, {2}, {1, 3, 6, 12}, {14, 60}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2 * kSteps);

}  // namespace
}  // namespace softforce::benchmarks

BENCHMARK_MAIN();
