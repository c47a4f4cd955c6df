#include "softforce/camera/lens.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "camera/lens_models.h"

namespace softforce::camera {

int NumDistortion(LensModel model) { return model == LensModel::kKannalaBrandt ? 4 : 8; }

Projection Project(const Lens& lens, const Eigen::Vector3d& p_camera) {
  const Distorted d = lens.model == LensModel::kKannalaBrandt
                          ? kannala_brandt::Distort(lens, p_camera)
                          : brown_conrady::Distort(lens, p_camera);
  Projection projection;
  if (!d.within_field) return projection;
  const Eigen::Vector2d f(lens.fx, lens.fy);
  projection.pixel = f.cwiseProduct(d.point) + Eigen::Vector2d(lens.cx, lens.cy);
  projection.jacobian = f.asDiagonal() * d.jacobian;
  projection.visible = true;
  return projection;
}

LensJacobian ProjectionByLens(const Lens& lens, const Eigen::Vector3d& p_camera) {
  const bool fisheye = lens.model == LensModel::kKannalaBrandt;
  const Distorted d =
      fisheye ? kannala_brandt::Distort(lens, p_camera) : brown_conrady::Distort(lens, p_camera);
  const Eigen::Vector2d f(lens.fx, lens.fy);
  LensJacobian jacobian;
  jacobian.leftCols<2>() = d.point.asDiagonal();
  jacobian.middleCols<2>(2).setIdentity();
  jacobian.rightCols<8>() =
      f.asDiagonal() * (fisheye ? kannala_brandt::ByDistortion(lens, p_camera)
                                : brown_conrady::ByDistortion(lens, p_camera));
  return jacobian;
}

std::optional<Eigen::Vector3d> UnprojectRay(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d point((pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy);
  const std::optional<Eigen::Vector3d> direction = lens.model == LensModel::kKannalaBrandt
                                                       ? kannala_brandt::Undistort(lens, point)
                                                       : brown_conrady::Undistort(lens, point);
  if (!direction) return std::nullopt;
  return direction->normalized();
}

std::optional<Eigen::Vector2d> Unproject(const Lens& lens, const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector3d> ray = UnprojectRay(lens, pixel);
  if (!ray || !(ray->z() > 0)) return std::nullopt;
  return ray->hnormalized();
}

std::optional<Eigen::Vector2d> ProjectDiscCentroid(const Lens& lens,
                                                   const Eigen::Vector3d& centre_camera,
                                                   const Eigen::Vector3d& normal_camera,
                                                   double diameter) {
  const Eigen::Vector3d e1 = normal_camera.unitOrthogonal();
  const Eigen::Vector3d e2 = normal_camera.normalized().cross(e1);
  // The mean of the projection over the picture's area: a rule over the disc that is exact for
  // polynomials of degree 5 (six points on one circle and the centre), each point weighted by how
  // much picture its surroundings cover.
  constexpr int kPoints = 6;
  const double ring = diameter / 2 * std::sqrt(2.0 / 3.0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * M_PI * i / kPoints;
    const bool centre = i == kPoints;
    const Eigen::Vector3d offset =
        centre ? Eigen::Vector3d(Eigen::Vector3d::Zero())
               : Eigen::Vector3d(ring * (std::cos(angle) * e1 + std::sin(angle) * e2));
    const Projection at = Project(lens, centre_camera + offset);
    if (!at.visible) return std::nullopt;
    Eigen::Matrix2d d_pixel;  // by the disc's own two coordinates
    d_pixel << at.jacobian * e1, at.jacobian * e2;
    const double weight = (centre ? 1.0 / 4 : 1.0 / 8) * std::abs(d_pixel.determinant());
    sum += weight * at.pixel;
    area += weight;
  }
  if (!(area > 0)) return std::nullopt;  // seen exactly from the side
  return sum / area;
}

}  // namespace softforce::camera
