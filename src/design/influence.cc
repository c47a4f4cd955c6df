#include "softforce/design/influence.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "softforce/base/input_error.h"

namespace softforce::design {
namespace {

constexpr int kAtATime = 32;  // points, so that their responses stay in tens of megabytes

Eigen::Matrix<double, 3, 2> Tangents(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                                     int triangle) {
  const Eigen::Vector3d a = X.col(surface.triangles(0, triangle));
  const Eigen::Vector3d along = (X.col(surface.triangles(1, triangle)) - a).normalized();
  const Eigen::Vector3d normal =
      along.cross(X.col(surface.triangles(2, triangle)) - a).normalized();
  Eigen::Matrix<double, 3, 2> tangents;
  tangents << along, normal.cross(along);
  return tangents;
}

}  // namespace

PlacedLoad::PlacedLoad(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                       const SampledLoad& load, double patch)
    : patch_(mesh::MovingPatchWeights(surface, X, load.at, patch,
                                      Tangents(surface, X, load.at.triangle))),
      directions_(load.directions),
      force_(load.force) {}

// K is symmetric: a point moves by a force on a node as the node does by that force on the point.
LoadRows PlacedLoad::Rows(const Eigen::MatrixXd& response, Eigen::Index i) const {
  Eigen::Matrix3d by_force = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_step[2] = {Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  const std::vector<int>& nodes = patch_.weights.nodes;
  for (size_t n = 0; n < nodes.size(); ++n) {
    const Eigen::Matrix3d own = response.block<3, 3>(3 * nodes[n], 3 * i).transpose();
    by_force += patch_.weights.weights[n] * own;
    for (int axis = 0; axis < 2; ++axis) {
      by_step[axis] += patch_.slopes(static_cast<Eigen::Index>(n), axis) * own;
    }
  }
  LoadRows rows = LoadRows::Zero();
  rows.leftCols(directions_.cols()) = by_force * directions_;
  for (int axis = 0; axis < 2; ++axis) rows.col(3 + axis) = by_step[axis] * force_;
  return rows;
}

Eigen::MatrixXd ResponseTo(fem::StaticSolver* solver, const fem::Equilibrium& state,
                           const std::vector<mesh::NodalWeights>& points) {
  Eigen::MatrixXd unit =
      Eigen::MatrixXd::Zero(state.u.size(), 3 * static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) {
    for (size_t n = 0; n < points[i].nodes.size(); ++n) {
      unit.block<3, 3>(3 * points[i].nodes[n], 3 * static_cast<Eigen::Index>(i))
          .diagonal()
          .setConstant(points[i].weights[n]);
    }
  }
  fem::Sensitivity answer = solver->Solve(state, unit, 0);
  if (!answer.ok) {
    throw base::InputError("body", "it is about to buckle under its weight and actuation",
                           "Check supports, material, gravity and actuation.");
  }
  return std::move(answer.du);
}

Influence ComputeInfluence(fem::StaticSolver* solver, const fem::Equilibrium& state,
                           const std::vector<mesh::NodalWeights>& points,
                           const std::vector<PlacedLoad>& loads,
                           const std::function<void(int)>& tell) {
  const int num_points = static_cast<int>(points.size());
  const int num_loads = static_cast<int>(loads.size());
  Influence influence(num_points, num_loads);
  for (int first = 0; first < num_points; first += kAtATime) {
    const int last = std::min(num_points, first + kAtATime);
    const Eigen::MatrixXd response =
        ResponseTo(solver, state, {points.begin() + first, points.begin() + last});
    for (int point = first; point < last; ++point) {
      for (int load = 0; load < num_loads; ++load) {
        influence.At(point, load) = loads[load].Rows(response, point - first);
      }
    }
    if (tell) tell(last);
  }
  return influence;
}

}  // namespace softforce::design
