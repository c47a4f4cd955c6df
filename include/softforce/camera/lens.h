#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace softforce::camera {

// A pinhole with the Brown–Conrady distortion of OpenCV: k1, k2, p1, p2, k3, k4, k5, k6 (k4 … k6 in
// the denominator; zero in the 4- and 5-parameter models).
struct BrownConrady {
  double fx = NAN, fy = NAN, cx = NAN, cy = NAN;  // px; (0, 0) is the CENTRE of the top-left pixel
  std::array<double, 8> distortion{};
};

struct Projection {
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(NAN);  // px, distorted; NaN unless `visible`
  Eigen::Matrix<double, 2, 3> jacobian =
      Eigen::Matrix<double, 2, 3>::Constant(NAN);  // d pixel / d p, px/m
  bool visible =
      false;  // in front of the camera, and within the part of the lens that the model covers
};

// Where a point p_camera (m; x right, y down, z forward) is seen.
Projection Project(const BrownConrady& lens, const Eigen::Vector3d& p_camera);

// The point on the plane z = 1 (undistorted, normalised coordinates) seen at a pixel, by Newton's
// method; nothing if no such point exists (a pixel far outside the calibrated field).
std::optional<Eigen::Vector2d> Unproject(const BrownConrady& lens, const Eigen::Vector2d& pixel);

// The centroid of the picture of a flat disc. It differs from the projection of the disc's centre
// by perspective and distortion (0.02–0.04 px for a 6 mm dot at 45°), so a dot's centroid must be
// compared with this. Nothing if any part of the disc is not visible.
std::optional<Eigen::Vector2d> ProjectDiscCentroid(const BrownConrady& lens,
                                                   const Eigen::Vector3d& centre_camera,
                                                   const Eigen::Vector3d& normal_camera,
                                                   double diameter);

}  // namespace softforce::camera
