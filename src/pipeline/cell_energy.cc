#include "pipeline/cell_energy.h"

#include <Eigen/LU>
#include <array>

#include "softforce/mesh/tet_shapes.h"

namespace softforce::pipeline {
namespace {

// From barycentric coordinates to three independent ones: the first is 1 less the others.
const Eigen::Matrix<double, 4, 3> kReduce =
    (Eigen::Matrix<double, 4, 3>() << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1).finished();

std::vector<Eigen::Vector4d> IntegrationPoints(int num_nodes) {
  if (num_nodes == 4) return {Eigen::Vector4d::Constant(0.25)};
  constexpr double kFar = 0.13819660112501051518;  // (5 − √5) / 20, exact to degree 2
  std::vector<Eigen::Vector4d> points(4, Eigen::Vector4d::Constant(kFar));
  for (int i = 0; i < 4; ++i) points[i](i) = 1 - 3 * kFar;
  return points;
}

Eigen::Matrix3d Symmetric(const Eigen::Matrix3d& m) { return (m + m.transpose()) / 2; }

}  // namespace

std::vector<Eigen::Matrix3Xd> OnCells(const mesh::TetMesh& mesh, const Eigen::Matrix3Xd& u) {
  std::vector<Eigen::Matrix3Xd> cells;
  cells.reserve(mesh.num_elements());
  for (int e = 0; e < mesh.num_elements(); ++e)
    cells.emplace_back(u(Eigen::all, mesh.elements.col(e)));
  return cells;
}

std::vector<Eigen::Matrix3Xd> OnFineCells(const mesh::TetMesh& coarse, const Eigen::Matrix3Xd& u,
                                          const mesh::Refinement& fine) {
  const int num_nodes = static_cast<int>(coarse.elements.rows());
  std::vector<Eigen::Matrix3Xd> cells;
  cells.reserve(fine.parent.size());
  for (size_t e = 0; e < fine.parent.size(); ++e) {
    const Eigen::Matrix3Xd of_parent = u(Eigen::all, coarse.elements.col(fine.parent[e]));
    const std::array<Eigen::Vector4d, 4>& corners = fine.corners[e];
    Eigen::Matrix3Xd of_part(3, num_nodes);
    for (int i = 0; i < num_nodes; ++i) {
      const Eigen::Vector4d at =
          i < 4 ? corners[i]
                : (corners[mesh::kEdges[i - 4][0]] + corners[mesh::kEdges[i - 4][1]]) / 2;
      of_part.col(i) = of_parent * mesh::TetShapes(coarse.order(), at);
    }
    cells.push_back(of_part);
  }
  return cells;
}

std::vector<double> CellWork(const fem::Body& body, const std::vector<Eigen::Matrix3Xd>& a,
                             const std::vector<Eigen::Matrix3Xd>& b) {
  const int num_nodes = static_cast<int>(body.mesh.elements.rows());
  const std::vector<Eigen::Vector4d> points = IntegrationPoints(num_nodes);
  std::vector<double> work(a.size(), 0);
  for (size_t e = 0; e < a.size(); ++e) {
    const int element = static_cast<int>(e);
    const fem::Material& material = body.materials[body.mesh.region[e]];
    const Eigen::Matrix3Xd X = body.mesh.nodes(Eigen::all, body.mesh.elements.col(element));
    for (const Eigen::Vector4d& at : points) {
      const Eigen::MatrixX3d derivatives =
          mesh::TetShapeDerivatives(body.mesh.order(), at) * kReduce;
      const Eigen::Matrix3d J = X * derivatives;
      const Eigen::MatrixX3d by_place = derivatives * J.inverse();
      const Eigen::Matrix3d strain_a = Symmetric(a[e] * by_place);
      const Eigen::Matrix3d strain_b = Symmetric(b[e] * by_place);
      const double volume = J.determinant() / 6 / static_cast<double>(points.size());
      work[e] += volume * (2 * material.mu() * strain_a.cwiseProduct(strain_b).sum() +
                           material.lambda() * strain_a.trace() * strain_b.trace());
    }
  }
  return work;
}

}  // namespace softforce::pipeline
