#include "softforce/camera/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "softforce/base/input_error.h"
#include "support/stereo_rig.h"

namespace softforce::camera {
namespace {

TEST(Triangulate, RecoversAProjectedPoint) {
  const Rig rig = testing::MakeStereoRig();
  const Eigen::Vector3d p_rig(0.03, -0.02, 0.45);

  const Triangulation result = Triangulate(rig, testing::ProjectInto(rig, p_rig));

  ASSERT_EQ(result.status, Triangulation::Status::kOk);
  EXPECT_LT((result.p_rig - p_rig).norm(), 1e-9);  // m; exact up to rounding
  EXPECT_LT(result.chi2, 1e-12);
}

TEST(Triangulate, ReportsTheScatterThatNoiseMakes) {
  const Rig rig = testing::MakeStereoRig();
  const Eigen::Vector3d p_rig(0.03, -0.02, 0.45);
  const double sigma = 0.1;  // px
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, sigma);
  constexpr int kTrials = 4000;
  double normalised = 0;
  double chi2 = 0;
  for (int i = 0; i < kTrials; ++i) {
    auto pixels = testing::ProjectInto(rig, p_rig, sigma);
    for (PixelObservation& seen : pixels)
      seen.pixel += Eigen::Vector2d(noise(random), noise(random));
    const Triangulation result = Triangulate(rig, pixels);
    const Eigen::Vector3d error = result.p_rig - p_rig;
    normalised += error.dot(result.covariance.ldlt().solve(error)) / 3;
    chi2 += result.chi2;
  }
  EXPECT_NEAR(normalised / kTrials, 1, 0.05);  // sampled: standard error 0.013
  EXPECT_NEAR(chi2 / kTrials, 1, 0.1);         // one degree of freedom: standard error 0.022
}

TEST(Triangulate, SaysWhyItFails) {
  const Rig rig = testing::MakeStereoRig();
  auto pixels = testing::ProjectInto(rig, {0.0, 0.0, 0.45});
  EXPECT_EQ(Triangulate(rig, {pixels[0]}).status, Triangulation::Status::kTooFewCameras);

  auto apart = pixels;
  apart[1].pixel.y() += 20;  // px across the epipolar line
  EXPECT_EQ(Triangulate(rig, apart).status, Triangulation::Status::kInconsistent);

  const auto far = testing::ProjectInto(rig, {-3, 0, 9});
  TriangulationOptions options;
  options.min_parallax = 0.5;  // rad
  EXPECT_EQ(Triangulate(rig, pixels, options).status, Triangulation::Status::kLowParallax);
}

TEST(Triangulate, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    TriangulationOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](TriangulationOptions& o) { o.min_parallax = -1; });
  refuses([](TriangulationOptions& o) { o.consistency_probability = 1; });
  refuses([](TriangulationOptions& o) { o.max_iterations = 0; });
}

}  // namespace
}  // namespace softforce::camera
