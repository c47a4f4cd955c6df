#include "softforce/fem/stress.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "softforce/mesh/tet_shapes.h"

namespace softforce::fem {
namespace {

// The four-point rule of degree 2: barycentric coordinates of point q are kNear at corner q and
// kFar at the others.
constexpr double kFar = 0.1381966011250105;
constexpr double kNear = 1 - 3 * kFar;

std::vector<Eigen::Vector4d> PointsOf(int order) {
  if (order == 1) return {Eigen::Vector4d::Constant(0.25)};
  std::vector<Eigen::Vector4d> points(4, Eigen::Vector4d::Constant(kFar));
  for (int q = 0; q < 4; ++q) points[q](q) = kNear;
  return points;
}

Vector6d CauchyStress(const Material& material, const Eigen::Matrix3d& F) {
  const double J = F.determinant();
  const MaterialResponse response = Evaluate(material, F, false);
  if (!response.valid || J <= 0) return Vector6d::Constant(NAN);
  const Eigen::Matrix3d S = response.P * F.transpose() / J;
  Vector6d stress;
  stress << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(1, 2), S(2, 0);
  return stress;
}

// Stress at the points of one cell, a column each, and the cell's volume.
struct CellStress {
  Eigen::Matrix<double, 6, Eigen::Dynamic> at_points;
  double volume = 0;  // m³
};

CellStress StressOfCell(const Material& material, const Eigen::Matrix3Xd& X,
                        const Eigen::Matrix3Xd& u,
                        const std::vector<Eigen::MatrixX4d>& derivatives) {
  CellStress cell{{6, static_cast<Eigen::Index>(derivatives.size())}, 0};
  for (size_t q = 0; q < derivatives.size(); ++q) {
    // By the last three of the barycentric coordinates, the first being what is left.
    const Eigen::MatrixX3d by_local =
        derivatives[q].rightCols<3>().colwise() - derivatives[q].col(0);
    const Eigen::Matrix3d map = X * by_local;
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + u * by_local * map.inverse();
    cell.at_points.col(static_cast<Eigen::Index>(q)) = CauchyStress(material, F);
    cell.volume += map.determinant() / (6 * static_cast<double>(derivatives.size()));
  }
  return cell;
}

// Linear through the values at the four points, or the one value.
Eigen::Matrix<double, 6, 4> AtCorners(const CellStress& cell) {
  if (cell.at_points.cols() == 1) return cell.at_points.replicate<1, 4>();
  const Vector6d sum = cell.at_points.rowwise().sum();
  // value(q) = kFar · Σ corners + (kNear − kFar) · corner(q), and Σ corners = Σ values.
  return (cell.at_points.colwise() - kFar * sum) / (kNear - kFar);
}

}  // namespace

double VonMises(const Vector6d& s) {
  const Eigen::Vector3d differences(s(0) - s(1), s(1) - s(2), s(2) - s(0));
  return std::sqrt(0.5 * differences.squaredNorm() + 3 * s.tail<3>().squaredNorm());
}

Eigen::Matrix<double, 6, Eigen::Dynamic> NodalStress(const Body& body, const Eigen::Matrix3Xd& u) {
  const mesh::TetMesh& mesh = body.mesh;
  std::vector<Eigen::MatrixX4d> derivatives;
  for (const Eigen::Vector4d& at : PointsOf(mesh.order())) {
    derivatives.push_back(mesh::TetShapeDerivatives(mesh.order(), at));
  }
  Eigen::Matrix<double, 6, Eigen::Dynamic> stress;
  stress.setZero(6, mesh.num_nodes());
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(mesh.num_nodes());
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const Eigen::VectorXi nodes = mesh.elements.col(e);
    Eigen::Matrix3Xd X(3, nodes.size()), moved(3, nodes.size());
    for (Eigen::Index i = 0; i < nodes.size(); ++i) {
      X.col(i) = mesh.nodes.col(nodes(i));
      moved.col(i) = u.col(nodes(i));
    }
    const CellStress cell = StressOfCell(body.materials[mesh.region[e]], X, moved, derivatives);
    const Eigen::Matrix<double, 6, 4> corners = AtCorners(cell);
    for (Eigen::Index i = 0; i < nodes.size(); ++i) {
      Vector6d here;
      if (i < 4) {
        here = corners.col(i);
      } else {
        const std::array<int, 2>& edge = mesh::kEdges[i - 4];
        here = 0.5 * (corners.col(edge[0]) + corners.col(edge[1]));
      }
      stress.col(nodes(i)) += cell.volume * here;
      volume(nodes(i)) += cell.volume;
    }
  }
  for (int node = 0; node < mesh.num_nodes(); ++node) stress.col(node) /= volume(node);
  return stress;
}

Eigen::VectorXd NodalVonMises(const Body& body, const Eigen::Matrix3Xd& u) {
  const auto stress = NodalStress(body, u);
  Eigen::VectorXd values(stress.cols());
  for (Eigen::Index i = 0; i < stress.cols(); ++i) values(i) = VonMises(stress.col(i));
  return values;
}

}  // namespace softforce::fem
