#include <gtest/gtest.h>

#include <iostream>

#include "softforce/calibration/register.h"
#include "softforce/vision/dots.h"
#include "vision/recording_truth.h"

namespace softforce::calibration {
namespace {

using softforce::testing::LoadRecordingTruth;
using softforce::testing::RecordingTruth;

void Print(const std::string& what, double value, const std::string& unit) {
  std::cout << "  " << what << ": " << value << " " << unit << "\n";
  ::testing::Test::RecordProperty(what, std::to_string(value) + " " + unit);
}

class OnRecording : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    truth_ = LoadRecordingTruth(GetParam());
    if (!truth_) GTEST_SKIP() << "no recordings beside the project";
  }
  std::optional<RecordingTruth> truth_;
};
class OnRecordingWithDots : public OnRecording {};
class OnRecordingWithTags : public OnRecording {};

vision::RigPose Register(const RecordingTruth& truth, int frames, double* corner_rms_px) {
  std::vector<Fiducial> fiducials;
  for (const RecordingTruth::Tag& tag : truth.fiducials) {
    fiducials.push_back({"tag36h11", tag.id, tag.corners});
  }
  FiducialRegistration registration(truth.rig, fiducials);
  const vision::TagDetector detector("tag36h11");
  vision::Recording recording = truth.Open();
  double square = 0;
  int count = 0;
  for (int k = 0; k < frames; ++k) {
    const auto frame = recording.Next();
    if (!frame) break;
    std::vector<std::vector<vision::Tag>> tags;
    for (size_t c = 0; c < 2; ++c) {
      tags.push_back(detector.Detect(frame->pictures[c]));
      const camera::Camera& camera = truth.rig.cameras[c];
      std::vector<RecordingTruth::Tag> known = truth.fiducials;
      known.insert(known.end(), truth.frames[k].tags.begin(), truth.frames[k].tags.end());
      for (const vision::Tag& tag : tags.back()) {
        for (const RecordingTruth::Tag& true_tag : known) {
          if (true_tag.id != tag.id) continue;
          for (int i = 0; i < 4; ++i) {
            const Eigen::Vector3d p =
                camera.T_camera_rig * (*truth.rig.T_rig_robot * true_tag.corners[i]);
            square += (tag.corners[i] - camera::Project(camera.lens, p).pixel).squaredNorm();
            ++count;
          }
        }
      }
    }
    registration.Add(tags);
  }
  *corner_rms_px = std::sqrt(square / count);
  return registration.Solve();
}

TEST_P(OnRecording, RegistrationMeetsTheTruth) {
  double corner_rms_px = NAN;
  const vision::RigPose pose = Register(*truth_, 10, &corner_rms_px);

  ASSERT_TRUE(pose.ok());
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  // the middle of all fiducials, m
  for (const RecordingTruth::Tag& tag : truth_->fiducials) {
    for (const Eigen::Vector3d& corner : tag.corners) {
      base += corner / (4.0 * static_cast<double>(truth_->fiducials.size()));
    }
  }
  const double place_mm = 1e3 * (pose.T_rig_robot * base - *truth_->rig.T_rig_robot * base).norm();
  const Eigen::AngleAxisd turn(pose.T_rig_robot.linear() *
                               truth_->rig.T_rig_robot->linear().transpose());
  const double turn_mrad = 1e3 * std::abs(turn.angle());
  Print("registration_at_base", place_mm, "mm");
  Print("registration_turn", turn_mrad, "mrad");
  Print("tag_corner_rms_2d", corner_rms_px, "px");
  EXPECT_LT(place_mm, 0.1);
  EXPECT_LT(turn_mrad, 0.2);
  EXPECT_LT(corner_rms_px, 0.1);
}

TEST_P(OnRecordingWithDots, DotsLieAtTheProjectedDiscs) {
  vision::Recording recording = truth_->Open();
  double square = 0;
  int found = 0, visible = 0;
  for (size_t k = 0; k < truth_->frames.size(); ++k) {
    const auto frame = recording.Next();
    ASSERT_TRUE(frame.has_value()) << k;
    for (size_t c = 0; c < 2; ++c) {
      const auto dots = vision::DetectDots(frame->pictures[c]);
      for (size_t m = 0; m < truth_->frames[k].pixels.size(); ++m) {
        if (!truth_->frames[k].visible[m][c]) continue;
        ++visible;
        const Eigen::Vector2d centre = truth_->frames[k].pixels[m][c];
        const vision::Dot* nearest = nullptr;
        for (const vision::Dot& dot : dots) {
          const double distance = (dot.centroid - centre).norm();
          if (distance < 2 && (!nearest || distance < (nearest->centroid - centre).norm())) {
            nearest = &dot;
          }
        }
        if (nearest == nullptr) continue;
        ++found;
        square += (nearest->centroid - centre).squaredNorm();
      }
    }
  }
  const double rms = std::sqrt(square / 2 / found);
  Print("dot_rms_per_axis", rms, "px");
  Print("dots_found", 100.0 * found / visible, "%");
  // Against the projected CENTRE, of which the picture's centroid is up to 0.04 px away.
  EXPECT_LT(rms, 0.05);
  EXPECT_EQ(found, visible);
}

TEST_P(OnRecordingWithTags, BodyTagsLieWhereTheBodyCarriesThem) {
  const vision::TagDetector detector("tag36h11");
  vision::Recording recording = truth_->Open();
  double square = 0;
  int found = 0, visible = 0;
  for (const RecordingTruth::Frame& truth : truth_->frames) {
    const auto frame = recording.Next();
    ASSERT_TRUE(frame.has_value());
    for (size_t c = 0; c < 2; ++c) {
      const camera::Camera& camera = truth_->rig.cameras[c];
      const auto seen = detector.Detect(frame->pictures[c]);
      for (size_t m = 0; m < truth.tags.size(); ++m) {
        visible += truth.visible[m][c] ? 1 : 0;
        for (const vision::Tag& tag : seen) {
          if (tag.id != truth.tags[m].id) continue;
          ++found;
          for (int i = 0; i < 4; ++i) {
            const Eigen::Vector3d p =
                camera.T_camera_rig * (*truth_->rig.T_rig_robot * truth.tags[m].corners[i]);
            square += (tag.corners[i] - camera::Project(camera.lens, p).pixel).squaredNorm();
          }
        }
      }
    }
  }
  const double rms = std::sqrt(square / (4 * found));
  Print("body_tag_corner_rms_2d", rms, "px");
  Print("body_tags_found", 100.0 * found / visible, "%");
  EXPECT_LT(rms, 0.06);
  EXPECT_EQ(found, visible);
}

INSTANTIATE_TEST_SUITE_P(Shared, OnRecording,
                         ::testing::Values("sheet_two_weights", "sheet_two_weights_tags",
                                           "robot_tip_weight"));
INSTANTIATE_TEST_SUITE_P(Shared, OnRecordingWithDots,
                         ::testing::Values("sheet_two_weights", "robot_tip_weight"));
INSTANTIATE_TEST_SUITE_P(Shared, OnRecordingWithTags, ::testing::Values("sheet_two_weights_tags"));

}  // namespace
}  // namespace softforce::calibration
