#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <yaml-cpp/yaml.h>

#include "scene/rig_texts.h"
#include "scene/temp_scene.h"
#include "softforce/scene/rig_file.h"
#include "support/stereo_rig.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using softforce::testing::MakeStereoRig;
using testing::ExpectSameRig;
using ::testing::HasSubstr;
using testing::kRosLeft;
using testing::RefusalOf;
using testing::RefusalOfText;
using testing::Replaced;
using testing::TempFolder;
using testing::WriteFile;

std::vector<fs::path> RosFiles() {
  const std::string ros_right = Replaced(Replaced(kRosLeft, "stereo/left", "stereo/right"),
                                         "395.6, 0, 296.1, 0,", "395.6, 0, 296.1, -47.472,");
  return {WriteFile(TempFolder() / "left.yaml", kRosLeft),
          WriteFile(TempFolder() / "right.yaml", ros_right)};
}

TEST(LoadRig, TakesTheBaselineOfARosPairFromP) {
  const camera::Rig rig = LoadRig(RosFiles(), {});

  ASSERT_EQ(rig.cameras.size(), 2);
  EXPECT_EQ(rig.cameras[0].name, "narrow_stereo/left");
  // Both are turned alike to the rectified frame, in which the right one is 0.12 m to the right:
  // R' (-0.12, 0, 0) in its own frame.
  const Eigen::Isometry3d& T = rig.cameras[1].T_camera_rig;
  EXPECT_LT((T.translation() - Eigen::Vector3d(-0.1152, 0, -0.0336)).norm(), 1e-12);  // m
  EXPECT_LT((T.linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LoadRig, ReadsTheCameraInfoMessage) {
  const camera::Rig rig = LoadRig(WriteFile(TempFolder() / "upper.yaml", R"(header:
  stamp: {sec: 1, nanosec: 2}
  frame_id: camera
height: 480
width: 640
distortion_model: rational_polynomial
d: [0.1, -0.2, 0.001, 0.002, 0.3, 0.4, 0.5, 0.6]
k: [430.0, 0.0, 311.0, 0.0, 431.0, 221.0, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [430.0, 0.0, 311.0, 0.0, 0.0, 431.0, 221.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
---
)"));

  ASSERT_EQ(rig.cameras.size(), 1);
  EXPECT_EQ(rig.cameras[0].name, "upper");
  EXPECT_EQ(rig.cameras[0].height, 480);
}

TEST(SaveRigAs, WritesARosPairThatIsReadBack) {
  for (const double turn : {0.0, 1.57}) {  // side by side, and one above the other
    camera::Rig rig = MakeStereoRig();
    for (camera::Camera& camera : rig.cameras) {
      camera.T_camera_rig = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * camera.T_camera_rig;
    }
    const fs::path folder = TempFolder() / "ros";

    SaveRigAs(rig, RigFormat::kRos, folder);

    ExpectSameRig(LoadRig({folder / "left.yaml", folder / "right.yaml"}, {}), rig);
  }
}

TEST(SaveRigAs, GivesTheRosPairRowsThatMatch) {
  const camera::Rig rig = MakeStereoRig();
  SaveRigAs(rig, RigFormat::kRos, TempFolder() / "ros");

  // The rectified pixel of a point, P R p, must have the same row in both pictures.
  const Eigen::Vector3d p_rig(0.05, -0.06, 0.6);
  Eigen::Vector2d pixels[2];
  for (int c = 0; c < 2; ++c) {
    const fs::path file = TempFolder() / "ros" / (rig.cameras[c].name + ".yaml");
    const auto read = [&](const char* key, int count) {
      const YAML::Node data = YAML::LoadFile(file.string())[key]["data"];
      EXPECT_EQ(data.size(), count);
      return data.as<std::vector<double>>();
    };
    const std::vector<double> R = read("rectification_matrix", 9);
    const std::vector<double> P = read("projection_matrix", 12);
    const Eigen::Vector3d p_rect = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(R.data()) *
                                   (rig.cameras[c].T_camera_rig * p_rig);
    pixels[c] = (Eigen::Matrix<double, 3, 4, Eigen::RowMajor>(P.data()) * p_rect.homogeneous())
                    .hnormalized();
  }
  EXPECT_NEAR(pixels[0].y(), pixels[1].y(), 1e-9);  // px, rounding
  EXPECT_GT(pixels[0].x(), pixels[1].x());          // a point in front has a positive disparity
}

TEST(LoadRig, RefusesRosModelsThatItDoesNotKnow) {
  EXPECT_THAT(RefusalOfText(Replaced(kRosLeft, "plumb_bob", "thin_prism_fisheye")),
              HasSubstr("rig.yml:10: distortion_model: got \"thin_prism_fisheye\", expected"));
}

TEST(LoadRig, RefusesRosCamerasThatWereCalibratedOneByOne) {
  const fs::path left = WriteFile(TempFolder() / "left.yaml", kRosLeft);
  const fs::path other =
      WriteFile(TempFolder() / "other.yaml", Replaced(kRosLeft, "narrow_stereo/left", "other"));
  EXPECT_THAT(RefusalOf({left, other}), HasSubstr("other.yaml:1: the projection matrix P has no "
                                                  "baseline to the first camera"));
}

}  // namespace
}  // namespace softforce::scene
