// Bodies to measure on, and the yardstick that goes with each: see mechanics_benchmark.cc.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "fem/cholesky.h"
#include "fem/elements.h"
#include "fem/tangent.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/read_mesh.h"
#include "support/box_mesh.h"
#include "support/soft_bodies.h"

namespace softforce::benchmarks {

inline constexpr double kWeight = 0.5;  // N on each of two places: a largest deflection of 11 mm
inline constexpr int kSteps = 100;      // in which the range of the loads is gone through

// The sheet, held at its corners, with two loads and twelve points that are watched.
struct Sheet {
  fem::Body body;
  std::vector<mesh::NodalWeights> loads, points;

  // The sheet of meshes/ without bricks, or cut into bricks of 6 cells each.
  Sheet(const std::array<int, 3>& bricks, int order) {
    body.mesh = bricks[0] == 0
                    ? mesh::ReadMesh(SOFTFORCE_SOURCE_DIR "/meshes/sheet.msh", 1e-3)
                    : testing::MakeBox(bricks[0], bricks[1], bricks[2], {0.2, 0.2, 0.01});
    if (order == 2) body.mesh = mesh::RaiseOrder(body.mesh);
    body.materials.assign(body.mesh.region_names.size(),
                          {fem::MaterialModel::kNeoHookean, 290e3, 0.45});
    for (int n = 0; n < body.mesh.num_nodes(); ++n) {
      const Eigen::Vector3d X = body.mesh.nodes.col(n);
      // The outermost row of bricks, whatever its width.
      const auto at_side = [&](double v) { return v < 0.0155 + 1e-9 || v > 0.1845 - 1e-9; };
      if (at_side(X.x()) && at_side(X.y())) body.fixed_nodes.push_back(n);
    }
    loads.push_back(testing::PointOf(body, {0.065, 0.13, 0}));
    loads.push_back(testing::PointOf(body, {0.14, 0.075, 0}));
    for (const double x : {0.04, 0.08, 0.12, 0.16}) {
      for (const double y : {0.05, 0.1, 0.15}) {
        points.push_back(testing::PointOf(body, {x, y, 0.01}));
      }
    }
  }

  fem::LoadCase Load(double share) const {
    fem::LoadCase load = testing::LoadAt(body, loads[0], {0, 0, -kWeight * share});
    load.forces += testing::LoadAt(body, loads[1], {0, 0, -kWeight * share}).forces;
    return load;
  }

  // Unit forces along x, y, z at every watched point: 36 right-hand sides.
  Eigen::MatrixXd UnitForces() const {
    Eigen::MatrixXd forces(3 * body.mesh.num_nodes(), 3 * points.size());
    for (size_t p = 0; p < points.size(); ++p) {
      for (int axis = 0; axis < 3; ++axis) {
        forces.col(static_cast<int>(3 * p) + axis) =
            testing::LoadAt(body, points[p], Eigen::Vector3d::Unit(axis)).forces.reshaped();
      }
    }
    return forces;
  }
};

// A tangent of the sheet at rest, ready to be factorised.
struct Tangent {
  fem::Elements elements;
  fem::TangentAssembler assembler;
  Eigen::Matrix3Xd u;
  fem::Cholesky cholesky;

  explicit Tangent(const fem::Body& body)
      : elements(body),
        assembler(body, elements),
        u(Eigen::Matrix3Xd::Zero(3, body.mesh.num_nodes())),
        cholesky((assembler.Assemble(elements, u, Eigen::VectorXd::Zero(body.cables.size()),
                                     std::vector<double>(body.chambers.size(), 0.0)),
                  assembler.matrix())) {}
};

inline double Seconds(clockid_t clock) {
  std::timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A sheet of about that many cells, and its yardstick: made once, kept while it is measured.
struct Case {
  Sheet sheet;
  Tangent tangent;
  double yardstick = std::numeric_limits<double>::infinity();  // s of processor time
  double threads = NAN;  // processor time over wall-clock time meanwhile

  Case(const std::array<int, 3>& bricks, int order) : sheet(bricks, order), tangent(sheet.body) {
    // Half a second at least: OpenBLAS's idle threads spin for a while after they were started.
    const double start = Seconds(CLOCK_MONOTONIC);
    for (int repetition = 0; repetition < 5 || Seconds(CLOCK_MONOTONIC) < start + 0.5;
         ++repetition) {
      const double wall = Seconds(CLOCK_MONOTONIC), busy = Seconds(CLOCK_PROCESS_CPUTIME_ID);
      tangent.cholesky.Factorise(tangent.assembler.matrix());
      const double took = Seconds(CLOCK_PROCESS_CPUTIME_ID) - busy;
      if (took >= yardstick) continue;
      yardstick = took;
      threads = took / (Seconds(CLOCK_MONOTONIC) - wall);
    }
  }
};

inline const std::map<int, std::array<int, 3>> kBricks{{1000, {13, 13, 1}},
                                                       {4971, {0, 0, 0}},
                                                       {5000, {20, 20, 2}},
                                                       {20000, {41, 41, 2}},
                                                       {50000, {53, 53, 3}}};

inline Case& CaseOf(const benchmark::State& state) {
  static std::map<std::pair<int64_t, int64_t>, std::unique_ptr<Case>> cases;
  const std::pair<int64_t, int64_t> key{state.range(0), state.range(1)};
  std::unique_ptr<Case>& made = cases[key];
  if (!made) {
    made = std::make_unique<Case>(kBricks.at(static_cast<int>(key.first)),
                                  static_cast<int>(key.second));
  }
  return *made;
}

// Runs `work` as a benchmark and sets it in proportion to the yardstick.
template <typename Work>
void Measure(benchmark::State& state, const Case& measured, const Work& work) {
  const double start = Seconds(CLOCK_PROCESS_CPUTIME_ID);
  for (auto _ : state) work();
  const double each =
      (Seconds(CLOCK_PROCESS_CPUTIME_ID) - start) / static_cast<double>(state.iterations());
  state.counters["yardsticks"] = each / measured.yardstick;
  state.counters["cells"] = measured.sheet.body.mesh.num_elements();
}

inline void EverySize(benchmark::internal::Benchmark* b) {
  b->ArgNames({"cells", "order"})->Unit(benchmark::kMillisecond);
  for (const auto& [cells, bricks] : kBricks) {
    for (const int order : {1, 2}) b->Args({cells, order});
  }
}

}  // namespace softforce::benchmarks
