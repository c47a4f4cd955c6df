#include "softforce/camera/lens.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace softforce::camera {
namespace {

const Lens kLens{
    1603.2, 1601.7, 655.3, 498.6, {-0.12, 0.08, 0.0006, -0.0004, 0.01, 0.02, 0.01, 0.005}};
const Lens kFisheye{
    420.5, 421.3, 655.3, 498.6, {0.031, -0.012, 0.004, -0.0007}, LensModel::kKannalaBrandt};

// Directions up to `widest` rad from the axis, all around, each at a length of its own.
std::vector<Eigen::Vector3d> PointsWithin(double widest) {
  std::vector<Eigen::Vector3d> points = {{0, 0, 0.4}};
  for (int i = 1; i <= 10; ++i) {
    for (int j = 0; j < 7; ++j) {
      const double theta = widest * i / 10;
      const double phi = 0.1 * i + 2 * M_PI * j / 7;
      points.push_back((0.2 + 0.1 * i) * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                                         std::sin(theta) * std::sin(phi),
                                                         std::cos(theta)));
    }
  }
  return points;
}

class OfEveryModel : public ::testing::TestWithParam<Lens> {
 protected:
  bool fisheye() const { return GetParam().model == LensModel::kKannalaBrandt; }
  std::vector<Eigen::Vector3d> Points() const { return PointsWithin(fisheye() ? 1.9 : 0.42); }
};
INSTANTIATE_TEST_SUITE_P(Lens, OfEveryModel, ::testing::Values(kLens, kFisheye), [](const auto& p) {
  return p.param.model == LensModel::kKannalaBrandt ? "KannalaBrandt" : "BrownConrady";
});

TEST_P(OfEveryModel, UnprojectRayUndoesProject) {
  for (const Eigen::Vector3d& p : Points()) {
    const Projection at = Project(GetParam(), p);
    ASSERT_TRUE(at.visible) << p.transpose();

    const auto ray = UnprojectRay(GetParam(), at.pixel);

    ASSERT_TRUE(ray.has_value()) << p.transpose();
    EXPECT_LT((*ray - p.normalized()).norm(), 1e-12) << p.transpose();  // exact up to rounding
  }
}

TEST_P(OfEveryModel, UnprojectGivesTheRayOnThePlane) {
  const Eigen::Vector3d p(0.2, -0.1, 0.9);
  const auto n = Unproject(GetParam(), Project(GetParam(), p).pixel);
  ASSERT_TRUE(n.has_value());
  EXPECT_LT((*n - p.hnormalized()).norm(), 1e-12);  // exact up to rounding
}

TEST_P(OfEveryModel, JacobianIsTheDerivative) {
  const double h = 1e-6;  // m
  for (const Eigen::Vector3d& p : Points()) {
    const Projection at = Project(GetParam(), p);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      const Eigen::Vector2d slope =
          (Project(GetParam(), p + step).pixel - Project(GetParam(), p - step).pixel) / (2 * h);
      // px/m, of about 4000; by the truncated and the rounded part of the difference
      EXPECT_LT((at.jacobian.col(i) - slope).norm(), 1e-5) << i << " at " << p.transpose();
    }
  }
}

double& Parameter(Lens* lens, int i) {
  double* const core[] = {&lens->fx, &lens->fy, &lens->cx, &lens->cy};
  return i < 4 ? *core[i] : lens->distortion[i - 4];
}

TEST_P(OfEveryModel, JacobianByTheLensIsTheDerivative) {
  for (const Eigen::Vector3d& p : Points()) {
    const LensJacobian jacobian = ProjectionByLens(GetParam(), p);
    for (int i = 0; i < 4 + NumDistortion(GetParam().model); ++i) {
      const double h = i < 4 ? 1e-2 : 1e-6;  // px; distortion
      Lens more = GetParam(), less = GetParam();
      Parameter(&more, i) += h;
      Parameter(&less, i) -= h;
      const Eigen::Vector2d slope = (Project(more, p).pixel - Project(less, p).pixel) / (2 * h);
      // relative; up to 1e5 px for the 9th power of a fisheye's 1.9 rad
      EXPECT_LT((jacobian.col(i) - slope).norm(), 1e-6 * (1 + slope.norm()))
          << i << " at " << p.transpose();
    }
  }
}

TEST_P(OfEveryModel, AgreesWithOpenCv) {
  const Lens& lens = GetParam();
  const cv::Matx33d K(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
  const cv::Mat D(1, fisheye() ? 4 : 8, CV_64F, const_cast<double*>(lens.distortion.data()));
  std::vector<cv::Point3d> points;
  for (const Eigen::Vector3d& p : PointsWithin(fisheye() ? 1.5 : 0.42)) {  // OpenCV's ends at 90°
    points.emplace_back(p.x(), p.y(), p.z());
  }
  const cv::Vec3d none(0, 0, 0);
  std::vector<cv::Point2d> pixels;
  if (fisheye()) {
    cv::fisheye::projectPoints(points, pixels, none, none, K, D);
  } else {
    cv::projectPoints(points, none, none, K, D, pixels);
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const Projection at = Project(lens, {points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(at.visible);
    EXPECT_NEAR(at.pixel.x(), pixels[i].x, 1e-9) << i;  // px; the same but for rounding
    EXPECT_NEAR(at.pixel.y(), pixels[i].y, 1e-9) << i;
  }
}

TEST(Lens, AgreesWithTheModelWrittenOut) {
  Lens lens;
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

TEST(Lens, DoesNotSeeWhatIsBehindOrFoldedBack) {
  EXPECT_FALSE(Project(kLens, {0, 0, -1}).visible);
  EXPECT_FALSE(Project(kLens, {0, 0, 0}).visible);
  Lens barrel = kLens;
  barrel.distortion = {-0.3, 0, 0, 0, 0, 0, 0, 0};  // turns back at r = 1.05
  EXPECT_TRUE(Project(barrel, {0.5, 0, 1}).visible);
  EXPECT_FALSE(Project(barrel, {1.5, 0, 1}).visible);
}

TEST(Lens, OfAFisheyeSeesBesideAndBehindItself) {
  EXPECT_TRUE(Project(kFisheye, {1, 0, 0}).visible);
  const Projection behind = Project(kFisheye, {1, 0, -0.3});
  ASSERT_TRUE(behind.visible);
  EXPECT_LT(UnprojectRay(kFisheye, behind.pixel).value().z(), 0);
  EXPECT_FALSE(Unproject(kFisheye, behind.pixel).has_value());  // not on the plane z = 1
  EXPECT_FALSE(Project(kFisheye, {0, 0, 0}).visible);
  EXPECT_FALSE(Project(kFisheye, {0, 0, -1}).visible);  // in no direction of the picture
}

// Newton's steps and the bracket around them must agree wherever the answer falls.
TEST(Lens, OfAFisheyeIsUndoneAtEveryAngle) {
  for (const Lens& lens :
       {kFisheye,
        Lens{330, 331, 641.3, 509.8, {0.03, -0.01, 0.003, -0.0006}, LensModel::kKannalaBrandt}}) {
    for (double theta = 0; theta < 2; theta += 1e-3) {
      const Eigen::Vector3d direction(std::sin(theta), 0, std::cos(theta));
      const auto ray = UnprojectRay(lens, Project(lens, direction).pixel);
      ASSERT_TRUE(ray.has_value()) << theta;
      EXPECT_LT((*ray - direction).norm(), 1e-12) << theta;  // exact up to rounding
    }
  }
}

TEST(Lens, OfAFisheyeEndsWhereItFirstFoldsBack) {
  Lens folding = kFisheye;
  // The radius has its top at 0.95 rad, falls, and rises again after 1.36 rad.
  folding.distortion = {-0.55, 0.12, 0, 0};
  ASSERT_TRUE(Project(folding, {std::sin(0.9), 0, std::cos(0.9)}).visible);
  EXPECT_FALSE(Project(folding, {std::sin(1.2), 0, std::cos(1.2)}).visible);
  EXPECT_FALSE(Project(folding, {std::sin(1.5), 0, std::cos(1.5)}).visible);
  EXPECT_FALSE(UnprojectRay(folding, {folding.cx + 0.9 * folding.fx, folding.cy}).has_value());
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
