#include "scene/temp_scene.h"

#include <gtest/gtest.h>

#include <fstream>

#include "softforce/base/input_error.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"

namespace softforce::scene::testing {
namespace fs = std::filesystem;

const char* const kSceneText = R"(softforce: 1
name: finger
body:
  mesh: {file: finger.msh, unit: mm, order: 1}
  material:
    soft: {model: neo_hookean, youngs_modulus: 290 kPa, poissons_ratio: 0.45}
    hard: {model: corotational, youngs_modulus: 2 MPa, poissons_ratio: 0.3}
  fixed:
    - {box: {min: 0 0 0 mm, max: 10 20 30 mm}}
    - {group: base}
  gravity: 0 0 -9.81 m/s^2
  density: 1.07 g/cm^3
actuators:
  - {name: left, type: cable, points: [20 0 45 mm, 10 0 20 mm], guide: 0 0 5 mm, input: displacement, patch: 6 mm}
  - {name: right, type: cable, points: [-20 0 45 mm], guide: 0 0 5 mm, input: tension}
  - {name: chamber, type: pressure, group: cavity}
actuation: actuation.csv
markers:
  type: apriltag
  family: tag25h9
  size: 14 mm
  points:
    - {id: 0, position: 30 40 10 mm}
    - {id: 7, position: 30 50 10 mm}
forces:
  known: false
  patch: 5 mm
  candidates:
    - {id: 0, position: 65 130 10 mm, direction: free}
    - {id: 1, position: 65 140 10 mm, direction: normal}
    - {id: 2, position: 65 150 10 mm, direction: [0, 3, -4]}
cameras:
  rig: rig.yaml
  sources: {left: left.mp4, right: "rtsp://cell/right"}
  fiducials:
    - {id: 100, corners: [0 20 0 mm, 20 20 0 mm, 20 0 0 mm, 0 0 0 mm]}
)";

const char* const kActuationText =
    "time_s,chamber_kPa,left_mm,right_N\n"
    "0,0,0,0\n"
    "0.5,10,8,1.5\n";

const char* const kRigText = R"(softforce: 1
cameras:
  left:
    model: brown_conrady
    resolution: [1280, 1024]
    intrinsics: [1603.2, 1601.7, 655.3, 498.6]
    distortion: [-0.12, 0.08, 0.0006, -0.0004, 0.01]
    T_camera_rig: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  right:
    model: brown_conrady
    resolution: [640, 480]
    intrinsics: [800, 801, 320, 240]
    distortion: [0, 0, 0, 0]
    T_camera_rig: [[0.6, 0, 0.8, -0.1], [0, 1, 0, 0], [-0.8, 0, 0.6, 0.02], [0, 0, 0, 1]]
)";

fs::path TempFolder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(::testing::TempDir()) / "softforce_scene_test" /
                          test->test_suite_name() / test->name();
  fs::create_directories(folder);
  return folder;
}

fs::path WriteFile(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is not in the text";
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " is there twice";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

fs::path WriteScene(const std::string& scene_text, const std::string& actuation_text) {
  const fs::path folder = TempFolder();
  for (const char* name : {"finger.msh", "left.mp4"}) WriteFile(folder / name, "");
  WriteFile(folder / "rig.yaml", kRigText);
  WriteFile(folder / "actuation.csv", actuation_text);
  return WriteFile(folder / "scene.yaml", scene_text);
}

std::string Refusal(const std::function<void()>& load) {
  try {
    load();
  } catch (const base::InputError& error) {
    std::string message = error.what();
    const std::string folder = (TempFolder() / "").string();
    for (size_t at; (at = message.find(folder)) != std::string::npos;) {
      message.erase(at, folder.size());
    }
    return message;
  }
  ADD_FAILURE() << "it was accepted";
  return "";
}

std::string SceneRefusal(const std::string& from, const std::string& to) {
  const fs::path file = WriteScene(Replaced(kSceneText, from, to));
  return Refusal([&] { LoadScene(file); });
}

std::string ActuationRefusal(const std::string& actuation_text) {
  const fs::path file = WriteScene(kSceneText, actuation_text);
  return Refusal([&] { LoadScene(file); });
}

std::string RigRefusal(const std::string& from, const std::string& to) {
  const fs::path file = WriteFile(TempFolder() / "rig.yaml", Replaced(kRigText, from, to));
  return Refusal([&] { LoadRig(file); });
}

}  // namespace softforce::scene::testing
