#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

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
using testing::RefusalOf;
using testing::RefusalOfText;
using testing::Replaced;
using testing::TempFolder;
using testing::WriteFile;

// As OpenCV's sample stereo_calib.cpp writes them, with -s=25 (millimetres).
const char* const kIntrinsics = R"(%YAML:1.0
---
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.3480126953125000e+02, 0., 3.4243811035156250e+02, 0.,
       5.3475006103515625e+02, 2.3472499084472656e+02, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 14
   dt: d
   data: [ -2.8e-01, 6.8e-02, 1.0e-03, 1.0e-04, 0., 0., 0., 1.2e-02, 0.,
       0., 0., 0., 0., 0. ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.3480126953125000e+02, 0., 3.2789685058593750e+02, 0.,
       5.3475006103515625e+02, 2.4978973388671875e+02, 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 1
   cols: 14
   dt: d
   data: [ -2.9e-01, 1.2e-01, 1.3e-04, -4.3e-04, 0., 0., 0., 4.6e-02, 0.,
       0., 0., 0., 0., 0. ]
)";

const char* const kExtrinsics = R"(%YAML:1.0
---
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0.8, 0., 0.6, 0., 1., 0., -0.6, 0., 0.8 ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -8.3e+01, 1.1e+00, -5.0e-01 ]
Q: !!opencv-matrix
   rows: 1
   cols: 1
   dt: d
   data: [ 1. ]
)";

std::vector<fs::path> StereoCalibFiles() {
  return {WriteFile(TempFolder() / "intrinsics.yml", kIntrinsics),
          WriteFile(TempFolder() / "extrinsics.yml", kExtrinsics)};
}

RigReadOptions MillimetresAt640x480() {
  RigReadOptions options;
  options.metres_per_unit = 1e-3;
  options.resolution = {640, 480};
  return options;
}

TEST(LoadRig, ReadsTheTwoFilesOfStereoCalib) {
  const camera::Rig rig = LoadRig(StereoCalibFiles(), MillimetresAt640x480());

  ASSERT_EQ(rig.cameras.size(), 2);
  EXPECT_EQ(rig.cameras[0].name, "left");
  EXPECT_EQ(rig.cameras[1].name, "right");
  EXPECT_EQ(rig.cameras[1].width, 640);
  EXPECT_EQ(rig.cameras[1].height, 480);
  EXPECT_TRUE(rig.cameras[0].T_camera_rig.isApprox(Eigen::Isometry3d::Identity()));
  const Eigen::Isometry3d& T = rig.cameras[1].T_camera_rig;
  EXPECT_LT((T.translation() - Eigen::Vector3d(-0.083, 0.0011, -0.0005)).norm(), 1e-15);  // m
  EXPECT_NEAR(T(0, 2), 0.6, 1e-12);
  // On the optical axis p1 and p2 do nothing.
  EXPECT_NEAR(camera::Project(rig.cameras[1].lens, {0, 0, 1}).pixel.x(), 327.8968505859375, 1e-12);
}

TEST(LoadRig, ReadsThemInOneFile) {
  const std::string both = kIntrinsics + std::string(kExtrinsics).substr(14) +
                           "image_width: 640\nimage_height: 480\nunit: mm\n";
  const camera::Rig rig = LoadRig(WriteFile(TempFolder() / "stereo.yml", both));

  ExpectSameRig(rig, LoadRig(StereoCalibFiles(), MillimetresAt640x480()));
}

TEST(LoadRig, ReadsWhatFileStorageWritesOfOneCamera) {
  const fs::path file = TempFolder() / "camera.yml";
  {
    cv::FileStorage storage(file.string(), cv::FileStorage::WRITE);
    storage << "calibration_time"
            << "Thu 01 Jan 2015"
            << "image_width" << 640 << "image_height" << 480 << "cameraMatrix"
            << cv::Mat((cv::Mat_<double>(3, 3) << 500.5, 0, 320.25, 0, 501.5, 240.75, 0, 0, 1))
            << "distCoeffs" << cv::Mat((cv::Mat_<double>(5, 1) << -0.1, 0.02, 1e-3, -2e-4, 0.003));
  }
  const camera::Rig rig = LoadRig(file);

  ASSERT_EQ(rig.cameras.size(), 1);
  EXPECT_EQ(rig.cameras[0].name, "camera");
  // At the normalised point (0.1, 0.2): r² = 0.05, radial 1 - 0.1·0.05 + 0.02·0.0025 +
  // 0.003·0.000125 = 0.995050375, tangential x 2e-3·0.02 - 2e-4·(0.05 + 0.02) = 2.6e-5,
  // y 1e-3·(0.05 + 0.08) - 4e-4·0.02 = 1.22e-4.
  const Eigen::Vector2d pixel = camera::Project(rig.cameras[0].lens, {0.1, 0.2, 1}).pixel;
  EXPECT_NEAR(pixel.x(), 320.25 + 500.5 * (0.0995050375 + 2.6e-5), 1e-9);
  EXPECT_NEAR(pixel.y(), 240.75 + 501.5 * (0.199010075 + 1.22e-4), 1e-9);
}

TEST(SaveRigAs, WritesAPairThatFileStorageReads) {
  const camera::Rig rig = MakeStereoRig();
  const fs::path file = TempFolder() / "stereo.yaml";

  SaveRigAs(rig, RigFormat::kOpenCv, file);

  const cv::FileStorage storage(file.string(), cv::FileStorage::READ);
  cv::Mat M2, D1, R, T;
  storage["M2"] >> M2;
  storage["D1"] >> D1;
  storage["R"] >> R;
  storage["T"] >> T;
  EXPECT_EQ(M2.at<double>(0, 0), 1400);
  EXPECT_EQ(M2.at<double>(1, 2), 509.8);
  EXPECT_EQ(D1.size(), cv::Size(4, 1));
  EXPECT_EQ(D1.at<double>(0, 3), -0.0004);
  EXPECT_EQ(R.at<double>(0, 2), rig.cameras[1].T_camera_rig(0, 2));
  EXPECT_EQ(T.at<double>(0, 0), rig.cameras[1].T_camera_rig(0, 3));
  EXPECT_EQ(static_cast<int>(storage["image_width"]), 1280);
  EXPECT_EQ(static_cast<std::string>(storage["camera_names"][1]), "right");
  ExpectSameRig(LoadRig(file), rig);
}

TEST(SaveRigAs, WritesOneCameraThatFileStorageReads) {
  camera::Rig rig = MakeStereoRig();
  rig.cameras.resize(1);
  const fs::path file = TempFolder() / "camera.yaml";

  SaveRigAs(rig, RigFormat::kOpenCv, file);

  const cv::FileStorage storage(file.string(), cv::FileStorage::READ);
  cv::Mat K;
  storage["camera_matrix"] >> K;
  EXPECT_EQ(K.at<double>(1, 1), 1402);
  ExpectSameRig(LoadRig(file), rig);
}

TEST(LoadRig, AsksForWhatFilesOfOpenCvLeaveOpen) {
  const std::vector<fs::path> files = StereoCalibFiles();
  EXPECT_THAT(RefusalOf({files[0]}), HasSubstr("missing key \"R\", got only M1, D1, M2, D2\n"
                                               "  stereoCalibrate gives R and T. If they are in "
                                               "another file, convert both"));
  EXPECT_THAT(RefusalOf({files[1]}), HasSubstr("missing key \"cameraMatrix1\" or"));
  RigReadOptions no_unit = MillimetresAt640x480();
  no_unit.metres_per_unit.reset();
  EXPECT_THAT(RefusalOf(files, no_unit),
              HasSubstr("extrinsics.yml:8: T: the cameras are 83.009 apart, expected metres"));
  RigReadOptions no_size = MillimetresAt640x480();
  no_size.resolution.reset();
  EXPECT_THAT(RefusalOf(files, no_size),
              HasSubstr("missing keys \"image_width\" and \"image_height\""));
}

TEST(LoadRig, RefusesThinPrismCoefficients) {
  const std::string text = Replaced(kIntrinsics, "0., 0., 1.2e-02, 0.,\n       0.,",
                                    "0., 0., 1.2e-02, 0.,\n       0.1,") +
                           std::string(kExtrinsics).substr(14);
  EXPECT_THAT(RefusalOfText(text), HasSubstr("D1: got coefficients of thin prism or tilt"));
}

}  // namespace
}  // namespace softforce::scene
