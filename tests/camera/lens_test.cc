#include "softforce/camera/lens.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace softforce::camera {
namespace {

const BrownConrady kLens{
    1603.2, 1601.7, 655.3, 498.6, {-0.12, 0.08, 0.0006, -0.0004, 0.01, 0.02, 0.01, 0}};

TEST(Lens, UnprojectUndoesProject) {
  for (double x = -0.35; x <= 0.35; x += 0.1) {
    for (double y = -0.3; y <= 0.3; y += 0.1) {
      const Projection at = Project(kLens, Eigen::Vector3d(x, y, 1) * 0.7);
      ASSERT_TRUE(at.visible);

      const auto back = Unproject(kLens, at.pixel);

      ASSERT_TRUE(back.has_value());
      EXPECT_LT((*back - Eigen::Vector2d(x, y)).norm(), 1e-12);  // exact up to rounding
    }
  }
}

TEST(Lens, AgreesWithTheModelWrittenOut) {
  BrownConrady lens;
  lens.fx = 1000, lens.fy = 900, lens.cx = 640, lens.cy = 480;
  lens.distortion = {0.1, -0.05, 0.001, 0.002, 0.01, 0, 0, 0};
  const double x = 0.2, y = -0.1, r2 = 0.05;
  const double radial = 1 + 0.1 * r2 - 0.05 * r2 * r2 + 0.01 * r2 * r2 * r2;

  const Projection at = Project(lens, {x, y, 1});

  EXPECT_NEAR(at.pixel.x(),
              1000 * (x * radial + 2 * 0.001 * x * y + 0.002 * (r2 + 2 * x * x)) + 640, 1e-10);
  EXPECT_NEAR(at.pixel.y(), 900 * (y * radial + 0.001 * (r2 + 2 * y * y) + 2 * 0.002 * x * y) + 480,
              1e-10);
}

TEST(Lens, JacobianIsTheDerivative) {
  const Eigen::Vector3d p(0.08, -0.05, 0.6);
  const double h = 1e-6;  // m
  const Projection at = Project(kLens, p);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d slope =
        (Project(kLens, p + step).pixel - Project(kLens, p - step).pixel) / (2 * h);
    EXPECT_LT((at.jacobian.col(i) - slope).norm(), 1e-4) << i;  // px/m, of about 2500
  }
}

TEST(Lens, DoesNotSeeWhatIsBehindOrFoldedBack) {
  EXPECT_FALSE(Project(kLens, {0, 0, -1}).visible);
  EXPECT_FALSE(Project(kLens, {0, 0, 0}).visible);
  BrownConrady barrel = kLens;
  barrel.distortion = {-0.3, 0, 0, 0, 0, 0, 0, 0};  // turns back at r = 1.05
  EXPECT_TRUE(Project(barrel, {0.5, 0, 1}).visible);
  EXPECT_FALSE(Project(barrel, {1.5, 0, 1}).visible);
}

// The centroid of many points spread evenly over the disc's picture, by brute force.
Eigen::Vector2d SampledCentroid(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal,
                                double diameter) {
  const Eigen::Vector3d e1 = normal.unitOrthogonal();
  const Eigen::Vector3d e2 = normal.cross(e1);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0;
  constexpr int kRings = 200;
  for (int i = 0; i < kRings; ++i) {
    const double radius = diameter / 2 * std::sqrt((i + 0.5) / kRings);
    for (int j = 0; j < 100; ++j) {
      const double angle = 2 * M_PI * j / 100;
      const Projection at =
          Project(kLens, centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2));
      Eigen::Matrix2d d;
      d << at.jacobian * e1, at.jacobian * e2;
      sum += std::abs(d.determinant()) * at.pixel;
      area += std::abs(d.determinant());
    }
  }
  return sum / area;
}

TEST(DiscCentroid, IsTheCentroidOfTheDiscsPicture) {
  const Eigen::Vector3d centre(0.08, 0.06, 0.5);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, 0.4, -0.7).normalized();
  const double diameter = 0.012;

  const auto centroid = ProjectDiscCentroid(kLens, centre, normal, diameter);

  ASSERT_TRUE(centroid.has_value());
  EXPECT_LT((*centroid - SampledCentroid(centre, normal, diameter)).norm(), 1e-4);  // px
  // and differs from the projection of the centre by something that matters
  EXPECT_GT((*centroid - Project(kLens, centre).pixel).norm(), 0.05);  // px
}

TEST(DiscCentroid, OfATinyDiscIsItsCentre) {
  const Eigen::Vector3d centre(0.02, -0.03, 0.5);
  const auto centroid = ProjectDiscCentroid(kLens, centre, {0, 0, -1}, 1e-5);
  ASSERT_TRUE(centroid.has_value());
  EXPECT_LT((*centroid - Project(kLens, centre).pixel).norm(), 1e-6);  // px
}

}  // namespace
}  // namespace softforce::camera
