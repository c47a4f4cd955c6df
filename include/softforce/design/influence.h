#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"

namespace softforce::design {

// A force that may act on the body, and that markers shall find.
struct SampledLoad {
  mesh::SurfacePoint at;
  Eigen::Matrix3Xd
      directions;         // orthonormal: 3×1 where the direction is known, 3×3 where it is not
  Eigen::Vector3d force;  // N, as large as it is expected
};

// ∂ point / ∂ (force along up to three directions, place along two): m/N, then m/m. The columns of
// directions that the load does not have are zero.
using LoadRows = Eigen::Matrix<double, 3, 5>;

// A load ready to be combined with the body's response: its patch, and how that moves.
class PlacedLoad {
 public:
  // The force is spread over a disc of diameter `patch` (m) of the body at rest, nodes at X.
  PlacedLoad(const mesh::Surface& surface, const Eigen::Matrix3Xd& X, const SampledLoad& load,
             double patch);

  // How the i-th observed point moves with it. `response`: 3N×3m, the nodes' displacement (m) per
  // unit force on the observed points, a column per point and axis.
  LoadRows Rows(const Eigen::MatrixXd& response, Eigen::Index i) const;

  Eigen::VectorXd intensity() const { return directions_.transpose() * force_; }  // N
  int num_directions() const { return static_cast<int>(directions_.cols()); }

 private:
  mesh::MovingPatch patch_;
  Eigen::Matrix3Xd directions_;
  Eigen::Vector3d force_;
};

// The response of the body at an equilibrium to unit forces on the points. Throws InputError if it
// is about to buckle there.
Eigen::MatrixXd ResponseTo(fem::StaticSolver* solver, const fem::Equilibrium& state,
                           const std::vector<mesh::NodalWeights>& points);

// How points move with loads.
class Influence {
 public:
  Influence(int num_points, int num_loads)
      : num_points_(num_points), num_loads_(num_loads), rows_(num_points * num_loads) {}

  LoadRows& At(int point, int load) { return rows_[point * num_loads_ + load]; }
  const LoadRows& At(int point, int load) const { return rows_[point * num_loads_ + load]; }
  int num_points() const { return num_points_; }
  int num_loads() const { return num_loads_; }

 private:
  int num_points_, num_loads_;
  std::vector<LoadRows> rows_;
};

// Solves from the points' side, three right-hand sides each, a few points at a time. `tell` is
// called with the number of points done. Throws InputError if the body is about to buckle.
Influence ComputeInfluence(fem::StaticSolver* solver, const fem::Equilibrium& state,
                           const std::vector<mesh::NodalWeights>& points,
                           const std::vector<PlacedLoad>& loads,
                           const std::function<void(int)>& tell = {});

}  // namespace softforce::design
