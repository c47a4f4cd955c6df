#include "softforce/design/sight.h"

#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::design {
namespace {

constexpr int kRim = 8;         // points of a marker's rim that are looked at
constexpr double kLift = 0.05;  // marker sizes above the surface, so that it does not hide itself

// Where the ray from `origin` along `way` crosses the triangle abc: in lengths of `way`, negative
// if it does not.
double Crossing(const Eigen::Vector3d& origin, const Eigen::Vector3d& way, const Eigen::Vector3d& a,
                const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a;
  const Eigen::Vector3d across = way.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0) return -1;
  const Eigen::Vector3d from_a = origin - a;
  const double u = from_a.dot(across) / determinant;
  if (u < 0 || u > 1) return -1;
  const Eigen::Vector3d aside = from_a.cross(ab);
  const double v = way.dot(aside) / determinant;
  if (v < 0 || u + v > 1) return -1;
  return ac.dot(aside) / determinant;
}

}  // namespace

void SightOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(option, rule);
  };
  require(pixel_sd > 0 && std::isfinite(pixel_sd), "--pixel-noise", "must be greater than 0 px");
  require(marker_size > 0 && std::isfinite(marker_size), "design: marker_size",
          "must be greater than 0 m");
  require(min_facing > 0 && min_facing < 1, "design: min_facing", "must lie between 0 and 1");
  require(edge >= 0 && std::isfinite(edge), "design: edge", "must be 0 px or more");
}

Sight::Sight(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
             const mesh::Surface& surface, const Eigen::Matrix3Xd& x, const SightOptions& options)
    : rig_(rig), T_rig_robot_(T_rig_robot), surface_(surface), x_(x), options_(options) {
  options.Check();
}

bool Sight::Hidden(const Eigen::Vector3d& point, const Eigen::Vector3d& eye) const {
  const Eigen::Vector3d way = eye - point;
  for (int t = 0; t < surface_.num_triangles(); ++t) {
    const double share =
        Crossing(point, way, x_.col(surface_.triangles(0, t)), x_.col(surface_.triangles(1, t)),
                 x_.col(surface_.triangles(2, t)));
    if (share > 0 && share < 1) return true;
  }
  return false;
}

bool Sight::Sees(int c, const mesh::SurfacePoint& at) const {
  const camera::Camera& camera = rig_.cameras[c];
  const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot_;
  const Eigen::Vector3d eye = T_camera_robot.inverse().translation();
  const Eigen::Vector3d middle = mesh::Position(surface_, x_, at);
  const Eigen::Vector3d normal = mesh::Normal(surface_, x_, at);
  if (normal.dot((eye - middle).normalized()) < options_.min_facing) return false;

  const Eigen::Vector3d right = normal.unitOrthogonal(), up = normal.cross(right);
  for (int i = -1; i < kRim; ++i) {
    Eigen::Vector3d point = middle + kLift * options_.marker_size * normal;
    if (i >= 0) {
      const double angle = 2 * M_PI * i / kRim;
      point += options_.marker_size / 2 * (std::cos(angle) * right + std::sin(angle) * up);
    }
    const camera::Projection seen = camera::Project(camera.lens, T_camera_robot * point);
    const Eigen::Vector2d& pixel = seen.pixel;
    const bool inside = seen.visible && pixel.x() >= options_.edge && pixel.y() >= options_.edge &&
                        pixel.x() <= camera.width - 1 - options_.edge &&
                        pixel.y() <= camera.height - 1 - options_.edge;
    if (!inside || Hidden(point, eye)) return false;
  }
  return true;
}

MarkerSight Sight::Of(const mesh::SurfacePoint& at) const {
  MarkerSight sight;
  sight.position = mesh::Position(surface_, x_, at);
  for (int c = 0; c < static_cast<int>(rig_.cameras.size()); ++c) {
    if (!Sees(c, at)) continue;
    const Eigen::Isometry3d T_camera_robot = rig_.cameras[c].T_camera_rig * T_rig_robot_;
    const Eigen::Matrix<double, 2, 3> J =
        camera::Project(rig_.cameras[c].lens, T_camera_robot * sight.position).jacobian *
        T_camera_robot.linear();
    sight.information += J.transpose() * J / (options_.pixel_sd * options_.pixel_sd);
  }
  return sight;
}

int Sight::NumCameras(const mesh::SurfacePoint& at) const {
  int count = 0;
  for (int c = 0; c < static_cast<int>(rig_.cameras.size()); ++c) count += Sees(c, at) ? 1 : 0;
  return count;
}

}  // namespace softforce::design
