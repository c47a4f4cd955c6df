#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <yaml-cpp/yaml.h>

#include <opencv2/core.hpp>

#include "scene/temp_scene.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/rig_file.h"
#include "support/stereo_rig.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using softforce::testing::MakeStereoRig;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Replaced;
using testing::TempFolder;
using testing::WriteFile;

// Everything but the rig's own frame.
void ExpectSameRig(const camera::Rig& got, const camera::Rig& wanted) {
  ASSERT_EQ(got.cameras.size(), wanted.cameras.size());
  for (size_t c = 0; c < got.cameras.size(); ++c) {
    const camera::Camera& a = got.cameras[c];
    const camera::Camera& b = wanted.cameras[c];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.lens.model, b.lens.model);
    // Where a ray of each camera is seen by the other: lens and place in one, to rounding, in px.
    const Eigen::Vector3d p_first(0.02, -0.03, 0.5);
    const Eigen::Isometry3d to_a = a.T_camera_rig * got.cameras[0].T_camera_rig.inverse();
    const Eigen::Isometry3d to_b = b.T_camera_rig * wanted.cameras[0].T_camera_rig.inverse();
    EXPECT_LT((to_a.matrix() - to_b.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((camera::Project(a.lens, to_a * p_first).pixel -
               camera::Project(b.lens, to_b * p_first).pixel)
                  .norm(),
              1e-8);
  }
}

std::string RefusalOf(const std::vector<fs::path>& files, const RigReadOptions& options = {}) {
  try {
    LoadRig(files, options);
  } catch (const base::InputError& error) {
    const std::string text = error.what();
    const std::string folder = TempFolder().string() + "/";
    const size_t at = text.find(folder);
    return at == std::string::npos ? text : text.substr(0, at) + text.substr(at + folder.size());
  }
  ADD_FAILURE() << "it was accepted";
  return "";
}

std::string RefusalOfText(const std::string& text) {
  return RefusalOf({WriteFile(TempFolder() / "rig.yml", text)});
}

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

// As kalibr_calibrate_cameras writes it.
const char* const kCamchain = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.2834, 0.0739, 0.0001, 1.76e-05]
  distortion_model: radtan
  intrinsics: [458.654, 457.296, 367.215, 248.375]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.8, 0.0, 0.6, -0.11]
  - [0.0, 1.0, 0.0, 0.0004]
  - [-0.6, 0.0, 0.8, -0.0008]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0, 2]
  camera_model: pinhole
  distortion_coeffs: [-0.2834, 0.0739, 0.0001, 1.76e-05]
  distortion_model: radtan
  intrinsics: [457.587, 456.134, 379.999, 255.238]
  resolution: [752, 480]
  rostopic: /cam1/image_raw
cam2:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, 0.1]
  - [0.0, 1.0, 0.0, 0.2]
  - [0.0, 0.0, 1.0, 0.3]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [457.587, 456.134, 379.999, 255.238]
  resolution: [640, 512]
  rostopic: /cam2/image_raw
)";

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

// As ROS's camera_calibration writes a rectified pair: 8 digits in R, 5 in the others.
const char* const kRosLeft = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo/left
camera_matrix:
  rows: 3
  cols: 3
  data: [430.15433,   0.     , 311.71339,
           0.     , 430.60920, 221.06824,
           0.     ,   0.     ,   1.     ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.36378, 0.11426, 0.00092, 0.00051, 0.     ]
rectification_matrix:
  rows: 3
  cols: 3
  data: [ 0.96000000, 0.        , 0.28000000,
          0.        , 1.        , 0.        ,
         -0.28000000, 0.        , 0.96000000]
projection_matrix:
  rows: 3
  cols: 4
  data: [395.6, 0, 296.1, 0, 0, 395.6, 224.8, 0, 0, 0, 1, 0]
)";

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
