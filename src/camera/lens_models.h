#pragma once

#include "softforce/camera/lens.h"

// The models behind camera/lens.h. Each maps the direction of a point to f · d(p) + c, and has the
// same three functions.
namespace softforce::camera {

struct Distorted {
  Eigen::Vector2d point = Eigen::Vector2d::Constant(NAN);  // at unit focal length
  Eigen::Matrix<double, 2, 3> jacobian;                    // d point / d p_camera, 1/m
  bool within_field = false;                               // else nothing else is set
};
using DistortionJacobian = Eigen::Matrix<double, 2, 8>;  // d point / d distortion

namespace brown_conrady {
Distorted Distort(const Lens& lens, const Eigen::Vector3d& p_camera);
DistortionJacobian ByDistortion(const Lens& lens, const Eigen::Vector3d& p_camera);
std::optional<Eigen::Vector3d> Undistort(const Lens& lens, const Eigen::Vector2d& point);
}  // namespace brown_conrady

namespace kannala_brandt {
Distorted Distort(const Lens& lens, const Eigen::Vector3d& p_camera);
DistortionJacobian ByDistortion(const Lens& lens, const Eigen::Vector3d& p_camera);
std::optional<Eigen::Vector3d> Undistort(const Lens& lens, const Eigen::Vector2d& point);
}  // namespace kannala_brandt

}  // namespace softforce::camera
