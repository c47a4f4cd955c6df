#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::testing {

// Integration and shape functions of the tests' own, of higher order than the library's.

struct Place1d {
  double at, weight;
};

// Gauss's rules of degree 5 and 7 on [0, 1].
inline const std::vector<Place1d> kGauss3{{0.11270166537925831, 0.27777777777777778},
                                          {0.5, 0.44444444444444444},
                                          {0.88729833462074169, 0.27777777777777778}};
inline const std::vector<Place1d> kGauss4{{0.06943184420297371, 0.17392742256872692},
                                          {0.33000947820757187, 0.32607257743127307},
                                          {0.66999052179242813, 0.32607257743127307},
                                          {0.93056815579702629, 0.17392742256872692}};

struct CellPlace {
  Eigen::Vector4d barycentric;
  double weight;  // share of the cell's volume, where edges are straight
};

// Gauss's rule on the cube, collapsed to the tetrahedron, which takes two degrees.
inline std::vector<CellPlace> CellRule(const std::vector<Place1d>& gauss) {
  std::vector<CellPlace> rule;
  for (const Place1d& a : gauss) {
    for (const Place1d& b : gauss) {
      for (const Place1d& c : gauss) {
        const double x = a.at, y = b.at * (1 - a.at), z = c.at * (1 - a.at) * (1 - b.at);
        const double collapse = (1 - a.at) * (1 - a.at) * (1 - b.at);
        rule.push_back({{1 - x - y - z, x, y, z}, 6 * collapse * a.weight * b.weight * c.weight});
      }
    }
  }
  return rule;
}

// The shape functions of a cell at a place in it, and their gradients in the body at rest.
struct CellPoint {
  Eigen::Vector3d X;          // m
  Eigen::VectorXd shape;      // per node of the cell
  Eigen::Matrix3Xd gradient;  // 1/m, a column per node
  double jacobian;            // m³, the volume that a weight of 1 stands for
};

inline CellPoint PointInCell(const mesh::TetMesh& mesh, int cell, const Eigen::Vector4d& b) {
  Eigen::Matrix<double, 3, 4> db;  // of the barycentric coordinates, by the last three of them
  db << -1, 1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 1;
  const int n = static_cast<int>(mesh.elements.rows());
  CellPoint point{{}, Eigen::VectorXd(n), Eigen::Matrix3Xd(3, n), 0};
  for (int i = 0; i < 4; ++i) {
    point.shape(i) = n == 4 ? b(i) : b(i) * (2 * b(i) - 1);
    point.gradient.col(i) = (n == 4 ? 1 : 4 * b(i) - 1) * db.col(i);
  }
  for (int e = 4; e < n; ++e) {
    const auto [i, j] = mesh::kEdges[e - 4];
    point.shape(e) = 4 * b(i) * b(j);
    point.gradient.col(e) = 4 * (b(i) * db.col(j) + b(j) * db.col(i));
  }
  Eigen::Matrix3Xd X(3, n);
  for (int i = 0; i < n; ++i) X.col(i) = mesh.nodes.col(mesh.elements(i, cell));
  const Eigen::Matrix3d dX = X * point.gradient.transpose();
  point.X = X * point.shape;
  point.gradient = dX.inverse().transpose() * point.gradient;
  point.jacobian = dX.determinant() / 6;
  return point;
}

// The displacements (3×N) of a cell's own nodes.
inline Eigen::Matrix3Xd OfCell(const mesh::TetMesh& mesh, int cell, const Eigen::Matrix3Xd& u) {
  Eigen::Matrix3Xd own(3, mesh.elements.rows());
  for (int i = 0; i < own.cols(); ++i) own.col(i) = u.col(mesh.elements(i, cell));
  return own;
}

// Integrals of the shape functions over a triangle of 3 or 6 nodes (3×3 or 3×6, m), straight or
// curved, m²; the middle nodes belong to the edges 01 12 20.
inline Eigen::VectorXd ShapeIntegrals(const Eigen::Matrix3Xd& X) {
  const int n = static_cast<int>(X.cols());
  Eigen::Matrix<double, 2, 3> db;
  db << -1, 1, 0, -1, 0, 1;
  Eigen::VectorXd integrals = Eigen::VectorXd::Zero(n);
  for (const Place1d& place : kGauss4) {
    for (const Place1d& other : kGauss4) {
      const double collapse = 1 - place.at;
      const Eigen::Vector3d b(collapse * (1 - other.at), place.at, other.at * collapse);
      Eigen::VectorXd shape(n);
      Eigen::Matrix2Xd slope(2, n);
      for (int i = 0; i < 3; ++i) {
        shape(i) = n == 3 ? b(i) : b(i) * (2 * b(i) - 1);
        slope.col(i) = (n == 3 ? 1 : 4 * b(i) - 1) * db.col(i);
      }
      for (int i = 3; i < n; ++i) {
        const int j = i - 3, k = (i - 2) % 3;
        shape(i) = 4 * b(j) * b(k);
        slope.col(i) = 4 * (b(j) * db.col(k) + b(k) * db.col(j));
      }
      const Eigen::Matrix<double, 3, 2> dX = X * slope.transpose();
      const double area = dX.col(0).cross(dX.col(1)).norm();
      integrals += collapse * place.weight * other.weight * area * shape;
    }
  }
  return integrals;
}

}  // namespace softforce::testing
