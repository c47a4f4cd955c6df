#include "softforce/scene/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kRigText;
using testing::RigRefusal;
using ::testing::StartsWith;
using testing::TempFolder;
using testing::WriteFile;

camera::Rig LoadText(const std::string& text) {
  return LoadRig(WriteFile(TempFolder() / "rig.yaml", text));
}

TEST(LoadRig, ReadsTheCamerasInTheFilesOrder) {
  const camera::Rig rig = LoadText(kRigText);

  ASSERT_EQ(rig.cameras.size(), 2);
  const camera::Camera& left = rig.cameras[0];
  EXPECT_EQ(left.name, "left");
  EXPECT_EQ(left.width, 1280);
  EXPECT_EQ(left.height, 1024);
  EXPECT_EQ(left.lens.fx, 1603.2);
  EXPECT_EQ(left.lens.cy, 498.6);
  EXPECT_THAT(left.lens.distortion, ElementsAre(-0.12, 0.08, 0.0006, -0.0004, 0.01, 0, 0, 0));
  EXPECT_EQ(rig.cameras[1].name, "right");
  EXPECT_EQ(rig.cameras[1].T_camera_rig.translation(), Eigen::Vector3d(-0.1, 0, 0.02));
  EXPECT_FALSE(rig.T_rig_robot.has_value());
}

TEST(SaveRig, WritesWhatLoadRigReadsBackToTheLastBit) {
  camera::Rig rig = LoadText(kRigText);
  rig.cameras[0].name = "left: \"upper\" #1";
  rig.cameras[0].lens.fx = 4000.0 / 3;
  rig.cameras[1].lens.distortion = {0.1, -0.2, 1e-7, 1.0 / 3, 0.5, 0.6, 0.7, 0.8};
  rig.T_rig_robot = Eigen::Translation3d(0.1, -0.2, 1.0 / 3) *
                    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  rig.T_rig_robot_covariance.diagonal().setConstant(1e-6 / 3);
  rig.T_rig_robot_covariance(0, 4) = rig.T_rig_robot_covariance(4, 0) = -3e-7;

  SaveRig(rig, TempFolder() / "saved.yaml");
  const camera::Rig loaded = LoadRig(TempFolder() / "saved.yaml");

  ASSERT_EQ(loaded.cameras.size(), rig.cameras.size());
  for (size_t c = 0; c < rig.cameras.size(); ++c) {
    EXPECT_EQ(loaded.cameras[c].name, rig.cameras[c].name);
    EXPECT_EQ(loaded.cameras[c].width, rig.cameras[c].width);
    EXPECT_EQ(loaded.cameras[c].height, rig.cameras[c].height);
    EXPECT_EQ(loaded.cameras[c].lens.fx, rig.cameras[c].lens.fx);
    EXPECT_EQ(loaded.cameras[c].lens.fy, rig.cameras[c].lens.fy);
    EXPECT_EQ(loaded.cameras[c].lens.cx, rig.cameras[c].lens.cx);
    EXPECT_EQ(loaded.cameras[c].lens.cy, rig.cameras[c].lens.cy);
    EXPECT_EQ(loaded.cameras[c].lens.distortion, rig.cameras[c].lens.distortion);
    EXPECT_EQ(loaded.cameras[c].T_camera_rig.matrix(), rig.cameras[c].T_camera_rig.matrix());
  }
  ASSERT_TRUE(loaded.T_rig_robot.has_value());
  EXPECT_EQ(loaded.T_rig_robot->matrix(), rig.T_rig_robot->matrix());
  EXPECT_EQ(loaded.T_rig_robot_covariance, rig.T_rig_robot_covariance);
}

TEST(SaveRig, WritesAFisheyeThatLoadRigReadsBack) {
  camera::Rig rig = LoadText(kRigText);
  rig.cameras[1].lens.model = camera::LensModel::kKannalaBrandt;
  rig.cameras[1].lens.distortion = {0.1, -0.2, 1e-7, 1.0 / 3, 0, 0, 0, 0};

  SaveRig(rig, TempFolder() / "saved.yaml");
  const camera::Rig loaded = LoadRig(TempFolder() / "saved.yaml");

  EXPECT_EQ(loaded.cameras[0].lens.model, camera::LensModel::kBrownConrady);
  EXPECT_EQ(loaded.cameras[1].lens.model, camera::LensModel::kKannalaBrandt);
  EXPECT_EQ(loaded.cameras[1].lens.distortion, rig.cameras[1].lens.distortion);
}

TEST(SaveRig, KeepsTheStatisticsOfTheCalibration) {
  RigStatistics statistics;
  statistics.board = "chessboard:9x6,square=25mm";
  statistics.views = 14;
  statistics.rms_px = 0.2134567890123;
  statistics.held_out_px = 1.0 / 3;
  statistics.cameras = {{"left", 14, 756, 0.2}, {"upper: 2", 13, 700, 0.3}};
  statistics.parameters = {"left: fx", "upper: 2: translation x"};
  statistics.covariance = (Eigen::Matrix2d() << 0.16, -1e-5, -1e-5, 1.0 / 3e9).finished();
  const fs::path file = TempFolder() / "saved.yaml";

  SaveRig(LoadText(kRigText), file, statistics);
  const std::optional<RigStatistics> loaded = LoadRigStatistics(file);

  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->board, statistics.board);
  EXPECT_EQ(loaded->views, 14);
  EXPECT_EQ(loaded->rms_px, statistics.rms_px);
  EXPECT_EQ(loaded->held_out_px, statistics.held_out_px);
  EXPECT_TRUE(std::isnan(loaded->held_out_board));
  ASSERT_EQ(loaded->cameras.size(), 2);
  EXPECT_EQ(loaded->cameras[1].name, "upper: 2");
  EXPECT_EQ(loaded->cameras[1].points, 700);
  EXPECT_EQ(loaded->parameters, statistics.parameters);
  EXPECT_EQ(loaded->covariance, statistics.covariance);
  EXPECT_EQ(LoadRig(file).cameras.size(), 2);  // which does not need them
}

TEST(LoadRigStatistics, GivesNothingForARigWithoutThem) {
  EXPECT_FALSE(LoadRigStatistics(WriteFile(TempFolder() / "rig.yaml", kRigText)).has_value());
}

TEST(LoadRig, RefusesACovarianceOfAnotherSize) {
  EXPECT_THAT(RigRefusal("softforce: 1",
                         "softforce: 1\ncalibration: {board: b, views: 3, parameters: [a, b], "
                         "covariance: [[1], [1]]}"),
              HasSubstr("calibration: covariance[1]: got 1 items, expected 2"));
}

TEST(SaveRig, RefusesAFolderThatIsNotThere) {
  EXPECT_THROW(SaveRig({}, TempFolder() / "missing" / "rig.yaml"), base::InputError);
}

TEST(LoadRig, RefusesAMissingFile) { EXPECT_THROW(LoadRig("no/such/rig.yaml"), base::InputError); }

TEST(LoadRig, RefusesAMatrixThatIsNoRotation) {
  EXPECT_EQ(
      RigRefusal("[0.6, 0, 0.8, -0.1]", "[0.6, 0, 0.7, -0.1]"),
      "rig.yaml:14: cameras: right: T_camera_rig: rotation has determinant 0.92 and is off by "
      "0.15, expected determinant 1 and at most 1e-06 off in any entry of R'R - I\n"
      "  Write the matrix with at least 7 digits, as the calibration gave it.");
}

TEST(LoadRig, RefusesAMirror) {
  EXPECT_THAT(RigRefusal("[0.6, 0, 0.8, -0.1], [0, 1, 0, 0]", "[0.6, 0, 0.8, -0.1], [0, -1, 0, 0]"),
              HasSubstr("rotation has determinant -1 "));
}

TEST(LoadRig, RefusesAnotherLastRow) {
  EXPECT_EQ(RigRefusal("[-0.8, 0, 0.6, 0.02], [0, 0, 0, 1]", "[-0.8, 0, 0.6, 0.02], [0, 0, 1, 1]"),
            "rig.yaml:14: cameras: right: T_camera_rig[3]: got another last row, "
            "expected [0, 0, 0, 1]");
}

TEST(LoadRig, RefusesAMatrixOfThreeRows) {
  EXPECT_THAT(RigRefusal("[-0.8, 0, 0.6, 0.02], [0, 0, 0, 1]", "[-0.8, 0, 0.6, 0.02]"),
              HasSubstr("T_camera_rig: got 3 items, expected 4"));
}

TEST(LoadRig, RefusesAnUnknownLensModel) {
  EXPECT_THAT(RigRefusal("left:\n    model: brown_conrady", "left:\n    model: fisheye"),
              StartsWith("rig.yaml:4: cameras: left: model: got \"fisheye\", expected "
                         "brown_conrady, kannala_brandt"));
}

TEST(LoadRig, RefusesAFocalLengthThatIsNotPositive) {
  EXPECT_EQ(RigRefusal("[800, 801,", "[800, -801,"),
            "rig.yaml:12: cameras: right: intrinsics: got the focal lengths 800 and -801, "
            "expected more than 0 px");
}

TEST(LoadRig, RefusesAResolutionThatIsNotPositive) {
  EXPECT_EQ(RigRefusal("[640, 480]", "[640, 0]"),
            "rig.yaml:11: cameras: right: resolution[1]: got \"0\", "
            "expected a whole number, at least 1");
}

TEST(LoadRig, RefusesADistortionOfAnotherLength) {
  EXPECT_EQ(RigRefusal("[0, 0, 0, 0]\n    T", "[0, 0]\n    T"),
            "rig.yaml:13: cameras: right: distortion: got 2 items, expected 4 or 5 or 8");
}

TEST(LoadRig, RefusesAFisheyeOfFiveParameters) {
  EXPECT_THAT(RigRefusal("left:\n    model: brown_conrady", "left:\n    model: kannala_brandt"),
              HasSubstr("distortion: got 5 items, expected 4"));
}

TEST(LoadRig, RefusesNumbersThatAreNone) {
  EXPECT_THAT(RigRefusal("[800, 801,", "[.nan, 801,"),
              StartsWith("rig.yaml:12: cameras: right: intrinsics[0]: got \".nan\""));
}

TEST(LoadRig, RefusesACameraGivenTwice) {
  EXPECT_EQ(RigRefusal("  right:", "  left:"),
            "rig.yaml:9: cameras: left: the key is given twice, expected once");
}

TEST(LoadRig, RefusesAnUnknownKey) {
  EXPECT_EQ(RigRefusal("softforce: 1", "softforce: 1\nT_rig_robots: 1"),
            "rig.yaml:2: T_rig_robots: unknown key, expected one of T_rig_robot, "
            "T_rig_robot_covariance, calibration, cameras, softforce\n"
            "  Did you mean \"T_rig_robot\"?");
}

TEST(LoadRig, RefusesARigWithoutCameras) {
  const std::string text = kRigText;
  EXPECT_EQ(RigRefusal(text.substr(text.find("cameras:")), "cameras: {}"),
            "rig.yaml:2: cameras: got no cameras, expected at least one");
}

}  // namespace
}  // namespace softforce::scene
