#include "softforce/pipeline/observe.h"

#include <gtest/gtest.h>

#include <random>

#include "support/stereo_rig.h"

namespace softforce::pipeline {
namespace {

// Dots of 6 mm on a plate that faces the cameras, 0.45 m away, in a grid of 30 mm; robot frame =
// rig frame.
struct Plate {
  camera::Rig rig = testing::MakeStereoRig();
  Eigen::Isometry3d T_rig_robot = Eigen::Isometry3d::Identity();
  std::vector<PredictedFeature> predicted;
  std::vector<Eigen::Vector3d> truth;
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, -1).normalized();

  explicit Plate(const Eigen::Vector3d& moved = Eigen::Vector3d::Zero()) {
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const Eigen::Vector3d p(0.03 * i, 0.03 * j, 0.45);
        predicted.push_back({p, 4e-6 * Eigen::Matrix3d::Identity(), normal, 0.006});  // (2 mm)²
        truth.push_back(p + moved);
      }
    }
  }

  // What the cameras see of the dots at their true places.
  std::vector<CameraDetections> See(double noise_px = 0, std::mt19937* random = nullptr) const {
    std::vector<CameraDetections> cameras(rig.cameras.size());
    std::normal_distribution<double> noise(0, noise_px);
    for (size_t c = 0; c < cameras.size(); ++c) {
      const camera::Camera& camera = rig.cameras[c];
      for (const Eigen::Vector3d& p : truth) {
        vision::Dot dot;
        dot.centroid = *camera::ProjectDiscCentroid(camera.lens, camera.T_camera_rig * p,
                                                    camera.T_camera_rig.linear() * normal, 0.006);
        if (random != nullptr) dot.centroid += Eigen::Vector2d(noise(*random), noise(*random));
        dot.covariance = 1e-4 * Eigen::Matrix2d::Identity();
        dot.long_axis = dot.short_axis = 18;
        cameras[c].dots.push_back(dot);
      }
    }
    return cameras;
  }

  std::vector<FeatureObservation> Observe(const std::vector<CameraDetections>& cameras) const {
    const ObserveOptions options;
    return Locate(rig, T_rig_robot, predicted,
                  AllocateDots(rig, T_rig_robot, predicted, cameras, 0.03, options), options);
  }
};

TEST(Observe, LocatesDotsByTheirCentres) {
  const Plate plate(Eigen::Vector3d(0.001, -0.002, 0.003));

  const auto observations = plate.Observe(plate.See());

  for (size_t f = 0; f < observations.size(); ++f) {
    ASSERT_EQ(observations[f].status, FeatureObservation::Status::kSeen);
    // The centroid's shift against the centre is taken off at the predicted place: good to a
    // micrometre.
    EXPECT_LT((observations[f].position - plate.truth[f]).norm(), 1e-6);  // m
  }
}

TEST(Observe, AMissingDotIsHiddenAndNothingElseChanges) {
  const Plate plate;
  auto cameras = plate.See();
  for (CameraDetections& camera : cameras) camera.dots.erase(camera.dots.begin() + 4);

  const auto observations = plate.Observe(cameras);

  for (size_t f = 0; f < observations.size(); ++f) {
    EXPECT_EQ(observations[f].status,
              f == 4 ? FeatureObservation::Status::kHidden : FeatureObservation::Status::kSeen);
  }
}

TEST(Observe, ADotSeenByOneCameraGivesTwoEquations) {
  const Plate plate(Eigen::Vector3d(0.001, 0.001, 0));
  auto cameras = plate.See();
  cameras[1].dots.erase(cameras[1].dots.begin() + 4);

  const FeatureObservation seen = plate.Observe(cameras)[4];

  ASSERT_EQ(seen.status, FeatureObservation::Status::kOneCamera);
  ASSERT_EQ(seen.whitening.rows(), 2);
  // Across the ray it is measured; along the ray it says nothing.
  EXPECT_LT((seen.whitening * (seen.position - plate.truth[4])).norm(),
            0.05);                                          // standard deviations
  const Eigen::Vector3d ray = plate.truth[4].normalized();  // left camera at the origin
  EXPECT_LT((seen.whitening * (1e-3 * ray)).norm(), 0.1);
}

TEST(Observe, ThreeCamerasLocateBetterThanTwo) {
  Plate three;
  camera::Camera top = three.rig.cameras[0];
  top.name = "top";
  top.T_camera_rig =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) * Eigen::Translation3d(-0.07, 0.15, 0.01);
  three.rig.cameras.push_back(top);
  const Plate two;

  const auto by_three = three.Observe(three.See());
  const auto by_two = two.Observe(two.See());

  for (size_t f = 0; f < by_three.size(); ++f) {
    ASSERT_EQ(by_three[f].cameras, 3);
    EXPECT_LT((by_three[f].position - three.truth[f]).norm(), 1e-6);  // m
    EXPECT_LT(by_three[f].covariance.trace(), by_two[f].covariance.trace());
  }
}

TEST(Observe, OfThreeCamerasAnyTwoAreEnough) {
  Plate plate;
  camera::Camera top = plate.rig.cameras[0];
  top.name = "top";
  top.T_camera_rig =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) * Eigen::Translation3d(-0.07, 0.15, 0.01);
  plate.rig.cameras.push_back(top);
  for (int blind = 0; blind < 3; ++blind) {
    auto cameras = plate.See();
    cameras[blind].dots.erase(cameras[blind].dots.begin() + 4);
    const FeatureObservation seen = plate.Observe(cameras)[4];
    EXPECT_EQ(seen.status, FeatureObservation::Status::kSeen);
    EXPECT_EQ(seen.cameras, 2);
    EXPECT_LT((seen.position - plate.truth[4]).norm(), 1e-6);  // m
  }
}

TEST(Observe, ClutterOfOtherSizeOrPlaceIsLeftAlone) {
  const Plate plate;
  auto cameras = plate.See();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(100, 200);  // px
  for (CameraDetections& camera : cameras) {
    vision::Dot decoy = camera.dots[4];
    decoy.long_axis = decoy.short_axis = 60;  // far too large, right on top of a marker
    camera.dots.push_back(decoy);
    for (int i = 0; i < 3; ++i) {
      decoy = camera.dots[0];
      decoy.centroid = {1100 + 20 * i, height(random)};  // far from every marker
      camera.dots.push_back(decoy);
    }
  }

  const auto observations = plate.Observe(cameras);

  for (size_t f = 0; f < observations.size(); ++f) {
    ASSERT_EQ(observations[f].status, FeatureObservation::Status::kSeen) << f;
    EXPECT_LT((observations[f].position - plate.truth[f]).norm(), 1e-6);  // m
  }
}

TEST(Observe, AMarkerThatFacesAwayIsNotExpected) {
  Plate plate;
  const auto cameras = plate.See();
  for (PredictedFeature& feature : plate.predicted) feature.normal = -feature.normal;
  for (const FeatureObservation& seen : plate.Observe(cameras)) {
    EXPECT_EQ(seen.status, FeatureObservation::Status::kHidden);
  }
}

TEST(Observe, AMarkerBehindTheBodyIsNotExpected) {
  Plate plate;
  const auto cameras = plate.See();
  plate.predicted[3].covered = {1, 1};
  plate.predicted[5].covered = {0, 1};
  const auto observations = plate.Observe(cameras);
  for (size_t f = 0; f < observations.size(); ++f) {
    using Status = FeatureObservation::Status;
    EXPECT_EQ(observations[f].status, f == 3   ? Status::kHidden
                                      : f == 5 ? Status::kOneCamera
                                               : Status::kSeen)
        << f;
  }
}

}  // namespace
}  // namespace softforce::pipeline
