// Cost of the mechanics on the soft sheet of meshes/, 4- and 10-node cells, beside the yardstick:
// one numeric factorisation of the same tangent by supernodal CHOLMOD on one thread. Compare
// ratios, not milliseconds.
//
//   build/release/benchmarks/mechanics_benchmark
#include <benchmark/benchmark.h>

#include "fem/cholesky.h"
#include "fem/elements.h"
#include "fem/tangent.h"
#include "softforce/estimation/force_estimator.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/read_mesh.h"
#include "support/soft_bodies.h"

namespace softforce {
namespace {

constexpr double kWeight = 0.5;  // N on each of two places; the range of the loads

// The soft sheet, held at its corners, with two loads and six points that are watched.
struct Sheet {
  fem::Body body;
  std::vector<mesh::NodalWeights> loads, points;

  explicit Sheet(int order) {
    body.mesh = mesh::ReadMesh(std::string(SOFTFORCE_SOURCE_DIR) + "/meshes/sheet.msh", 1e-3);
    if (order == 2) body.mesh = mesh::RaiseOrder(body.mesh);
    body.materials.assign(body.mesh.region_names.size(),
                          {fem::MaterialModel::kNeoHookean, 290e3, 0.45});
    for (int n = 0; n < body.mesh.num_nodes(); ++n) {
      const Eigen::Vector3d X = body.mesh.nodes.col(n);
      const auto at_side = [](double v) { return v < 0.01 + 1e-9 || v > 0.19 - 1e-9; };
      if (at_side(X.x()) && at_side(X.y())) body.fixed_nodes.push_back(n);
    }
    loads.push_back(testing::PointOf(body, {0.065, 0.13, 0}));
    loads.push_back(testing::PointOf(body, {0.14, 0.075, 0}));
    for (const double x : {0.05, 0.1, 0.15}) {
      for (const double y : {0.06, 0.14}) points.push_back(testing::PointOf(body, {x, y, 0.01}));
    }
  }

  fem::LoadCase Load(double share) const {
    fem::LoadCase load = testing::LoadAt(body, loads[0], {0, 0, -kWeight * share});
    load.forces += testing::LoadAt(body, loads[1], {0, 0, -kWeight * share}).forces;
    return load;
  }
};

void YardstickFactorisation(benchmark::State& state) {
  const Sheet sheet(static_cast<int>(state.range(0)));
  const fem::Elements elements(sheet.body);
  fem::TangentAssembler assembler(sheet.body, elements);
  const Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, sheet.body.mesh.num_nodes());
  assembler.Assemble(elements, u, {}, {});
  fem::Cholesky cholesky(assembler.matrix());
  for (auto _ : state) benchmark::DoNotOptimize(cholesky.Factorise(assembler.matrix()));
}

void TangentAssembly(benchmark::State& state) {
  const Sheet sheet(static_cast<int>(state.range(0)));
  const fem::Elements elements(sheet.body);
  fem::TangentAssembler assembler(sheet.body, elements);
  const Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, sheet.body.mesh.num_nodes());
  for (auto _ : state) assembler.Assemble(elements, u, {}, {});
}

void InternalForces(benchmark::State& state) {
  const Sheet sheet(static_cast<int>(state.range(0)));
  const fem::Elements elements(sheet.body);
  const Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, sheet.body.mesh.num_nodes());
  Eigen::Matrix3Xd forces = u;
  for (auto _ : state) benchmark::DoNotOptimize(elements.EnergyAndForces(u, &forces));
}

// One equilibrium, warm-started from loads that differ by 1 % of their range.
void ConvergedEquilibrium(benchmark::State& state) {
  const Sheet sheet(static_cast<int>(state.range(0)));
  fem::StaticSolver solver(sheet.body, "sheet");
  fem::Equilibrium shape = solver.AtRest();
  solver.Solve(sheet.Load(0.5), &shape);
  int step = 0;
  for (auto _ : state) {
    solver.Solve(sheet.Load(0.5 + 0.01 * (++step % 2)), &shape);
  }
}

// One estimated frame: two known places, six points, the load moved by 1 % of its range.
void EstimatedFrame(benchmark::State& state) {
  const Sheet sheet(static_cast<int>(state.range(0)));
  fem::StaticSolver truth_solver(sheet.body, "sheet");
  std::vector<std::vector<estimation::Observation>> frames(2);
  for (int f = 0; f < 2; ++f) {
    fem::Equilibrium truth = truth_solver.AtRest();
    truth_solver.Solve(sheet.Load(0.5 + 0.01 * f), &truth);
    for (const mesh::NodalWeights& point : sheet.points) {
      frames[f].push_back({point, Eigen::Vector3d::Zero(),
                           point.Apply(sheet.body.mesh.nodes) + point.Apply(truth.u),
                           Eigen::Matrix3d::Identity() / 3e-5});
    }
  }
  fem::StaticSolver solver(sheet.body, "sheet");
  const Eigen::Matrix3Xd down = -Eigen::Vector3d::UnitZ();
  estimation::ForceEstimator estimator(&solver,
                                       {{"0", sheet.loads[0], down}, {"1", sheet.loads[1], down}});
  estimator.Estimate(frames[0], {});
  int step = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(estimator.Estimate(frames[++step % 2], {}).chi2);
  }
}

BENCHMARK(YardstickFactorisation)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(TangentAssembly)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(InternalForces)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(ConvergedEquilibrium)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(EstimatedFrame)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace softforce

BENCHMARK_MAIN();
