#include "softforce/camera/triangulate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "softforce/base/input_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::camera {
namespace {

struct Ray {
  Eigen::Vector3d origin, direction;  // rig frame; direction of unit length
};

std::vector<Ray> Rays(const Rig& rig, const std::vector<PixelObservation>& pixels) {
  std::vector<Ray> rays;
  for (const PixelObservation& seen : pixels) {
    const Camera& camera = rig.cameras[seen.camera];
    const std::optional<Eigen::Vector3d> ray = UnprojectRay(camera.lens, seen.pixel);
    if (!ray) continue;
    const Eigen::Isometry3d T_rig_camera = camera.T_camera_rig.inverse();
    rays.push_back({T_rig_camera.translation(), T_rig_camera.linear() * *ray});
  }
  return rays;
}

double WidestAngle(const std::vector<Ray>& rays) {
  double widest = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    for (size_t j = i + 1; j < rays.size(); ++j) {
      widest = std::max(widest, std::atan2(rays[i].direction.cross(rays[j].direction).norm(),
                                           rays[i].direction.dot(rays[j].direction)));
    }
  }
  return widest;
}

// The point with the least sum of squared distances from the rays.
Eigen::Vector3d ClosestToAll(const std::vector<Ray>& rays) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
    A += across;
    b += across * ray.origin;
  }
  return A.ldlt().solve(b);
}

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // 1/m²
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double chi2 = 0;
  bool visible = true;
};

NormalEquations Linearise(const Rig& rig, const std::vector<PixelObservation>& pixels,
                          const Eigen::Vector3d& p_rig) {
  NormalEquations normal;
  for (const PixelObservation& seen : pixels) {
    const Camera& camera = rig.cameras[seen.camera];
    const Projection at = Project(camera.lens, camera.T_camera_rig * p_rig);
    normal.visible = normal.visible && at.visible;
    if (!normal.visible) return normal;
    const Eigen::Matrix<double, 2, 3> J = at.jacobian * camera.T_camera_rig.linear();
    const Eigen::Matrix2d weight = seen.covariance.inverse();
    const Eigen::Vector2d misfit = seen.pixel - at.pixel;
    normal.information += J.transpose() * weight * J;
    normal.gradient += J.transpose() * weight * misfit;
    normal.chi2 += misfit.dot(weight * misfit);
  }
  return normal;
}

}  // namespace

void TriangulationOptions::Check() const {
  if (!(min_parallax >= 0)) {
    throw base::InputError("triangulation: min_parallax", "must be 0 rad or more");
  }
  if (!(consistency_probability > 0 && consistency_probability < 1)) {
    throw base::InputError("triangulation: consistency_probability", "must lie between 0 and 1");
  }
  if (max_iterations < 1) {
    throw base::InputError("triangulation: max_iterations", "must be 1 or more");
  }
}

Triangulation Triangulate(const Rig& rig, const std::vector<PixelObservation>& pixels,
                          const TriangulationOptions& options) {
  options.Check();
  Triangulation result;
  const std::vector<Ray> rays = Rays(rig, pixels);
  if (rays.size() < 2 || rays.size() < pixels.size()) {
    result.status = Triangulation::Status::kTooFewCameras;
    return result;
  }
  result.p_rig = ClosestToAll(rays);
  if (WidestAngle(rays) < options.min_parallax) {
    result.status = Triangulation::Status::kLowParallax;
    return result;
  }

  NormalEquations normal = Linearise(rig, pixels, result.p_rig);
  for (int i = 0; i < options.max_iterations && normal.visible; ++i) {
    const Eigen::Vector3d step = normal.information.ldlt().solve(normal.gradient);
    result.p_rig += step;
    normal = Linearise(rig, pixels, result.p_rig);
    if (step.norm() < 1e-12) break;  // m; far below any camera's resolution
  }
  if (!normal.visible) {
    result.status = Triangulation::Status::kBehindCamera;
    return result;
  }
  result.covariance = normal.information.inverse();
  result.chi2 = normal.chi2;
  const int degrees_of_freedom = 2 * static_cast<int>(pixels.size()) - 3;
  const double limit =
      geometry::ChiSquareQuantile(options.consistency_probability, degrees_of_freedom);
  result.status =
      normal.chi2 <= limit ? Triangulation::Status::kOk : Triangulation::Status::kInconsistent;
  return result;
}

}  // namespace softforce::camera
