#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/rig_texts.h"
#include "scene/temp_scene.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using testing::ExpectSameRig;
using ::testing::HasSubstr;
using testing::kCamchain;
using testing::RefusalOfText;
using testing::Replaced;
using testing::TempFolder;
using testing::WriteFile;

TEST(LoadRig, ChainsTheCamerasOfKalibr) {
  const camera::Rig rig = LoadRig(WriteFile(TempFolder() / "camchain.yaml", kCamchain));

  ASSERT_EQ(rig.cameras.size(), 3);
  EXPECT_EQ(rig.cameras[1].name, "cam1");
  EXPECT_EQ(rig.cameras[2].width, 640);
  EXPECT_TRUE(rig.cameras[0].T_camera_rig.isApprox(Eigen::Isometry3d::Identity()));
  // cam2 from cam0: the second link after the first.
  const Eigen::Vector3d t = rig.cameras[2].T_camera_rig.translation();
  EXPECT_LT((t - Eigen::Vector3d(-0.01, 0.2004, 0.2992)).norm(), 1e-12);  // m, rounding
  EXPECT_NEAR(rig.cameras[2].T_camera_rig(0, 2), 0.6, 1e-12);
}

TEST(SaveRigAs, WritesACamchainThatIsReadBack) {
  camera::Rig rig = LoadRig(WriteFile(TempFolder() / "camchain.yaml", kCamchain));
  rig.cameras[1].name = "upper left";

  SaveRigAs(rig, RigFormat::kKalibr, TempFolder() / "written.yaml");

  ExpectSameRig(LoadRig(TempFolder() / "written.yaml"), rig);
}

TEST(LoadRig, RefusesLensModelsOfKalibrThatItDoesNotKnow) {
  for (const char* const model : {"omni", "eucm", "ds"}) {
    const std::string text =
        std::string(kCamchain).replace(std::string(kCamchain).find("pinhole"), 7, model);
    EXPECT_THAT(RefusalOfText(text),
                HasSubstr(std::string("rig.yml:3: cam0: camera_model: got \"") + model +
                          "\", expected pinhole\n"));
  }
  const std::string fov =
      std::string(kCamchain).replace(std::string(kCamchain).find("radtan"), 6, "fov");
  EXPECT_THAT(RefusalOfText(fov),
              HasSubstr("distortion_model: got \"fov\", expected radtan or equi or none"));
}

TEST(LoadRig, RefusesACameraOfKalibrWithoutItsLink) {
  EXPECT_THAT(RefusalOfText(Replaced(kCamchain, "cam0:", "cam0: {}\nunused:")),
              HasSubstr("rig.yml:1: cam0: missing key \"camera_model\""));
  EXPECT_THAT(RefusalOfText(Replaced(kCamchain, "cam1:\n  T_cn_cnm1:", "cam1:\n  T_cn_cnm2:")),
              HasSubstr("T_cn_cnm2: unknown key, expected \"T_cn_cnm1\", which is missing"));
}

}  // namespace
}  // namespace softforce::scene
