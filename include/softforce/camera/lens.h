#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace softforce::camera {

enum class LensModel {
  // A pinhole with OpenCV's distortion k1, k2, p1, p2, k3, k4, k5, k6: radial k1 k2 k3 over
  // k4 k5 k6, tangential p1 p2. Zero in the models of 4 and 5 parameters: what comes after.
  kBrownConrady,
  // OpenCV's fisheye, Kalibr's "equidistant": the angle θ from the axis appears at the radius
  // θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸). It sees beyond 90° too.
  kKannalaBrandt,
};

// How many of `distortion` the model knows.
int NumDistortion(LensModel model);

struct Lens {
  double fx = NAN, fy = NAN, cx = NAN, cy = NAN;  // px; (0, 0) is the CENTRE of the top-left pixel
  std::array<double, 8> distortion{};             // in the order that the model gives
  LensModel model = LensModel::kBrownConrady;
};

struct Projection {
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(NAN);  // px, distorted; NaN unless `visible`
  Eigen::Matrix<double, 2, 3> jacobian =
      Eigen::Matrix<double, 2, 3>::Constant(NAN);  // d pixel / d p, px/m
  // Within the part of space that the model covers: before the distortion folds back, and in front
  // of the camera (Brown–Conrady). The pixel may still lie outside the picture.
  bool visible = false;
};

// Where a point p_camera (m; x right, y down, z forward) is seen.
Projection Project(const Lens& lens, const Eigen::Vector3d& p_camera);

// d pixel / d (fx, fy, cx, cy, distortion[0 … 7]) at a visible point; zero in the columns that the
// model does not know.
using LensJacobian = Eigen::Matrix<double, 2, 12>;
LensJacobian ProjectionByLens(const Lens& lens, const Eigen::Vector3d& p_camera);

// The direction (of unit length) seen at a pixel, by Newton's method; nothing if no such direction
// exists (a pixel far outside the calibrated field).
std::optional<Eigen::Vector3d> UnprojectRay(const Lens& lens, const Eigen::Vector2d& pixel);

// The point on the plane z = 1 (undistorted, normalised coordinates) seen at a pixel; nothing if
// there is none, as for what a fisheye sees at 90° and beyond.
std::optional<Eigen::Vector2d> Unproject(const Lens& lens, const Eigen::Vector2d& pixel);

// The centroid of the picture of a flat disc. It differs from the projection of the disc's centre
// by perspective and distortion (0.02–0.04 px for a 6 mm dot at 45°), so a dot's centroid must be
// compared with this. Nothing if any part of the disc is not visible.
std::optional<Eigen::Vector2d> ProjectDiscCentroid(const Lens& lens,
                                                   const Eigen::Vector3d& centre_camera,
                                                   const Eigen::Vector3d& normal_camera,
                                                   double diameter);

}  // namespace softforce::camera
