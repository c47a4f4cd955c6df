#include "scene/rig_texts.h"

#include <gtest/gtest.h>

#include "scene/temp_scene.h"

namespace softforce::scene::testing {

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

std::string RefusalOf(const std::vector<std::filesystem::path>& files,
                      const RigReadOptions& options) {
  return Refusal([&] { LoadRig(files, options); });
}

std::string RefusalOfText(const std::string& text) {
  return RefusalOf({WriteFile(TempFolder() / "rig.yml", text)});
}

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

// 8 digits in R, 5 in the others.
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

}  // namespace softforce::scene::testing
