#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/rig_texts.h"
#include "scene/temp_scene.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/rig_file.h"
#include "support/stereo_rig.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using softforce::testing::MakeStereoRig;
using testing::ExpectSameRig;
using ::testing::HasSubstr;
using testing::kCamchain;
using testing::kRosLeft;
using testing::RefusalOf;
using testing::RefusalOfText;
using testing::Replaced;
using testing::TempFolder;
using testing::WriteFile;

TEST(SaveRigAs, WritesFisheyesInEveryFormat) {
  camera::Rig rig = MakeStereoRig();
  for (camera::Camera& camera : rig.cameras) {
    camera.lens.model = camera::LensModel::kKannalaBrandt;
    camera.lens.distortion = {0.02, -0.003, 1e-4, -1.0 / 3e5, 0, 0, 0, 0};
  }
  const fs::path folder = TempFolder();
  SaveRigAs(rig, RigFormat::kOpenCv, folder / "opencv.yaml");
  SaveRigAs(rig, RigFormat::kKalibr, folder / "kalibr.yaml");
  SaveRigAs(rig, RigFormat::kRos, folder);

  ExpectSameRig(LoadRig(folder / "opencv.yaml"), rig);
  ExpectSameRig(LoadRig(folder / "kalibr.yaml"), rig);
  ExpectSameRig(LoadRig({folder / "left.yaml", folder / "right.yaml"}, {}), rig);
}

TEST(SaveRigAs, WritesEightCoefficientsWhereTheFormatHasThem) {
  camera::Rig rig = MakeStereoRig();
  rig.cameras[1].lens.distortion = {0.1, -0.2, 1e-3, 2e-3, 0.3, 0.2, -0.1, 0.05};
  const fs::path folder = TempFolder();
  SaveRigAs(rig, RigFormat::kOpenCv, folder / "opencv.yaml");
  SaveRigAs(rig, RigFormat::kRos, folder);

  ExpectSameRig(LoadRig(folder / "opencv.yaml"), rig);
  ExpectSameRig(LoadRig({folder / "left.yaml", folder / "right.yaml"}, {}), rig);
  EXPECT_THROW(SaveRigAs(rig, RigFormat::kKalibr, folder / "kalibr.yaml"), base::InputError);
}

TEST(SaveRigAs, SaysWhatAFormatCannotHold) {
  camera::Rig three = MakeStereoRig();
  three.cameras.push_back(three.cameras[0]);
  EXPECT_THROW(SaveRigAs(three, RigFormat::kOpenCv, TempFolder() / "x.yaml"), base::InputError);
  camera::Rig sizes = MakeStereoRig();
  sizes.cameras[1].width = 640;
  EXPECT_THROW(SaveRigAs(sizes, RigFormat::kOpenCv, TempFolder() / "x.yaml"), base::InputError);
  EXPECT_FALSE(fs::exists(TempFolder() / "x.yaml"));
}

TEST(LoadRig, RefusesFilesOfDifferentTools) {
  const fs::path left = WriteFile(TempFolder() / "left.yaml", kRosLeft);
  const fs::path chain = WriteFile(TempFolder() / "camchain.yaml", kCamchain);
  EXPECT_THAT(RefusalOf({left, chain}),
              HasSubstr("camchain.yaml:1: is a file of Kalibr, expected one of ROS"));
  EXPECT_THAT(RefusalOf({chain, chain}), HasSubstr("is a second file, expected one"));
}

TEST(LoadRig, NamesTheKeysOfAFileThatIsNoRig) {
  EXPECT_THAT(RefusalOfText("width: 3\nheight: 4\n"),
              HasSubstr("rig.yml:1: got only the keys width, height, expected \"softforce\""));
}

TEST(LoadRig, RefusesARotationThatIsNoneInEachFormat) {
  EXPECT_THAT(RefusalOfText(Replaced(kRosLeft, "-0.28000000", "-0.29000000")),
              HasSubstr("rectification_matrix: rotation has determinant"));
  EXPECT_THAT(RefusalOfText(Replaced(kCamchain, "[-0.6, 0.0, 0.8,", "[-0.6, 0.0, 0.9,")),
              HasSubstr("cam1: T_cn_cnm1: rotation has determinant"));
}

TEST(ParseRigFormat, KnowsTheFormatsByName) {
  EXPECT_EQ(ParseRigFormat("opencv", "--also"), RigFormat::kOpenCv);
  EXPECT_EQ(ParseRigFormat("kalibr", "--also"), RigFormat::kKalibr);
  EXPECT_EQ(ParseRigFormat("ros", "--also"), RigFormat::kRos);
  EXPECT_THROW(ParseRigFormat("matlab", "--also"), base::InputError);
}

}  // namespace
}  // namespace softforce::scene
