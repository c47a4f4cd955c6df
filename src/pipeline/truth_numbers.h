#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace softforce::pipeline {

// How truth.json writes its numbers.

// Digits beyond what matters (1e-6 mm, N, px) only make the file large.
inline double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

template <class Vector>
nlohmann::ordered_json List(const Vector& vector, double factor = 1) {
  auto list = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) list.push_back(Rounded(factor * vector(i)));
  return list;
}

inline nlohmann::ordered_json Millimetres(const Eigen::Vector3d& p) { return List(p, 1e3); }

inline nlohmann::ordered_json Rows(const Eigen::MatrixXd& matrix) {  // with all digits
  auto rows = nlohmann::ordered_json::array();
  for (const auto row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

inline Eigen::Matrix4d InMillimetres(const Eigen::Isometry3d& T) {
  Eigen::Matrix4d matrix = T.matrix();
  matrix.topRightCorner<3, 1>() *= 1e3;
  return matrix;
}

}  // namespace softforce::pipeline
