#include "vision/local_map.h"

#include <Eigen/Dense>
#include <cmath>

namespace softforce::vision {

Eigen::Vector2d LocalMap::Pixel(const Eigen::Vector2d& offset) const {
  return (pixel_from_offset * offset.homogeneous()).hnormalized();
}

Eigen::Vector2d LocalMap::Offset(const Eigen::Vector2d& pixel) const {
  return (offset_from_pixel * pixel.homogeneous()).hnormalized();
}

Eigen::Matrix2d LocalMap::Jacobian() const {
  const Eigen::Matrix3d& H = pixel_from_offset;
  const Eigen::Vector2d p = Pixel(Eigen::Vector2d::Zero());
  return (H.topLeftCorner<2, 2>() - p * H.row(2).head<2>()) / H(2, 2);
}

std::optional<LocalMap> FitLocalMap(const BoardSightings& sightings, const Eigen::Vector2d& place,
                                    double range) {
  const size_t count = sightings.places.size();
  if (count < 4) return std::nullopt;
  // Unknowns h of x (1 + h6 u + h7 v) = h0 u + h1 v + h2 and its like for y, about the mean pixel.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& pixel : sightings.pixels) middle += pixel / double(count);
  Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> b = Eigen::Matrix<double, 8, 1>::Zero();
  for (size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d d = (sightings.places[k] - place) / range;
    // Falls slowly, so that four points are always found, if far away.
    const double weight = 1 / std::pow(1 + d.squaredNorm(), 3);
    const Eigen::Vector2d p = sightings.pixels[k] - middle;
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Matrix<double, 8, 1> row = Eigen::Matrix<double, 8, 1>::Zero();
      row.segment<3>(3 * axis) = d.homogeneous();
      row.tail<2>() = -p(axis) * d;
      A += weight * row * row.transpose();
      b += weight * p(axis) * row;
    }
  }
  // Rows differ in size (pixels against their squares); scaling keeps the rank test meaningful.
  const Eigen::Matrix<double, 8, 1> scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt();
  A = scale.cwiseInverse().asDiagonal() * A * scale.cwiseInverse().asDiagonal();
  const Eigen::FullPivLU<Eigen::Matrix<double, 8, 8>> lu(A);
  if (lu.rcond() < 1e-12) return std::nullopt;
  const Eigen::Matrix<double, 8, 1> h =
      scale.cwiseInverse().asDiagonal() * lu.solve(scale.cwiseInverse().asDiagonal() * b);
  Eigen::Matrix3d H;
  H << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1;
  H.topRows<2>() += middle * H.row(2);
  H.leftCols<2>() /= range;
  if (std::abs(H.determinant()) < 1e-12) return std::nullopt;
  return LocalMap{H, H.inverse()};
}

}  // namespace softforce::vision
