// Cost of the mechanics on a soft sheet, 200 × 200 × 10 mm, of 1k to 50k cells with 4 and 10 nodes;
// the one of 4971 cells is that of meshes/, the others are cut from bricks.
// The column `yardsticks` is the processor time divided by that of one numeric factorisation of the
// same tangent by supernodal CHOLMOD on one thread, measured in the same run: compare that, not
// milliseconds. `threads` of the yardstick is processor time over wall-clock time: more than 1
// would mean that it ran on more than one.
//
//   build/release/benchmarks/mechanics_benchmark
#include "speed/measured_sheet.h"

namespace softforce::benchmarks {
namespace {

void Yardstick(benchmark::State& state) {
  Case& c = CaseOf(state);
  Measure(state, c, [&] { c.tangent.cholesky.Factorise(c.tangent.assembler.matrix()); });
  state.counters["threads"] = c.threads;
  state.counters["dof"] = c.tangent.assembler.matrix().size();
}

void Assembly(benchmark::State& state) {
  Case& c = CaseOf(state);
  Measure(state, c, [&] { c.tangent.assembler.Assemble(c.tangent.elements, c.tangent.u, {}, {}); });
}

void InternalForces(benchmark::State& state) {
  Case& c = CaseOf(state);
  Eigen::Matrix3Xd forces = c.tangent.u;
  Measure(state, c, [&] {
    benchmark::DoNotOptimize(c.tangent.elements.EnergyAndForces(c.tangent.u, &forces));
  });
}

// W for 36 right-hand sides, the tangent being factorised.
void ComplianceOf36(benchmark::State& state) {
  Case& c = CaseOf(state);
  fem::StaticSolver solver(c.sheet.body, "sheet");
  fem::Equilibrium shape = solver.AtRest();
  const Eigen::MatrixXd forces = c.sheet.UnitForces();
  solver.Solve(shape, forces, 0);
  Measure(state, c, [&] { benchmark::DoNotOptimize(solver.Solve(shape, forces, 1).du.data()); });
}

// One equilibrium, warm-started from loads that differ by 1 % of their range, while the loads go
// up and down through the whole range. The tangents factorised on the way are counted.
void Sweep(benchmark::State& state, const fem::StaticSolverOptions& options) {
  Case& c = CaseOf(state);
  fem::StaticSolver solver(c.sheet.body, "sheet", options);
  fem::Equilibrium shape = solver.AtRest();
  int step = 0, iterations = 0, factorisations = 0;
  Measure(state, c, [&] {
    const int phase = ++step % (2 * kSteps);
    const int up = phase <= kSteps ? phase : 2 * kSteps - phase;
    const fem::SolveSummary summary = solver.Solve(c.sheet.Load(double(up) / kSteps), &shape);
    if (!summary.ok()) state.SkipWithError(summary.BriefReport().c_str());
    iterations += summary.iterations;
    factorisations += summary.factorisations;
  });
  state.counters["newton"] = double(iterations) / step;
  state.counters["factorised"] = double(factorisations) / step;
}

void Equilibrium(benchmark::State& state) { Sweep(state, {}); }

// Converged to half a per cent of the movement between frames: 11 mm in a hundred steps, of a sheet
// of 283 mm.
void EquilibriumToHalfPercent(benchmark::State& state) {
  fem::StaticSolverOptions options;
  options.tolerance = 0.005 * 0.011 / kSteps / 0.283;
  Sweep(state, options);
}

// One Newton step of the textbook: forces, tangent, factorisation and solve.
void NewtonStep(benchmark::State& state) {
  Case& c = CaseOf(state);
  Eigen::MatrixXd residual = Eigen::MatrixXd::Ones(c.tangent.assembler.matrix().size(), 1);
  Eigen::Matrix3Xd forces = c.tangent.u;
  Measure(state, c, [&] {
    c.tangent.elements.EnergyAndForces(c.tangent.u, &forces);
    c.tangent.assembler.Assemble(c.tangent.elements, c.tangent.u, {}, {});
    c.tangent.cholesky.Factorise(c.tangent.assembler.matrix());
    c.tangent.cholesky.SolveInPlace(&residual);
  });
}

BENCHMARK(Yardstick)->Apply(EverySize);
BENCHMARK(Assembly)->Apply(EverySize);
BENCHMARK(InternalForces)->Apply(EverySize);
BENCHMARK(ComplianceOf36)->Apply(EverySize);
BENCHMARK(NewtonStep)->Apply(EverySize);
// Whole sweeps through the range, so that every part of it counts alike.
BENCHMARK(Equilibrium)->Apply(EverySize)->Iterations(2 * kSteps);
BENCHMARK(EquilibriumToHalfPercent)->Apply(EverySize)->Iterations(2 * kSteps);

}  // namespace
}  // namespace softforce::benchmarks

BENCHMARK_MAIN();
