#include "vision/recording_truth.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace softforce::testing {
namespace {

using Json = nlohmann::json;
using Tag = RecordingTruth::Tag;

Eigen::Isometry3d Transform(const Json& rows_mm) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c)
      T.matrix()(r, c) = rows_mm[r][c].get<double>() * (c == 3 ? 1e-3 : 1);
  }
  return T;
}

Tag TagAt(int id, const Json& corners_mm) {
  Tag tag;
  tag.id = id;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) tag.corners[i](k) = 1e-3 * corners_mm[i][k].get<double>();
  }
  return tag;
}

camera::Camera CameraFrom(const std::string& name, const Json& truth) {
  const Json& K = truth[name]["K"];
  camera::Camera camera;
  camera.name = name;
  camera.width = truth["image_size"][0];
  camera.height = truth["image_size"][1];
  camera.lens.fx = K[0][0];
  camera.lens.fy = K[1][1];
  camera.lens.cx = K[0][2];
  camera.lens.cy = K[1][2];
  for (size_t i = 0; i < truth[name]["D"].size(); ++i) {
    camera.lens.distortion[i] = truth[name]["D"][i];
  }
  return camera;
}

RecordingTruth::Frame FrameFrom(const Json& truth, const Json& markers) {
  RecordingTruth::Frame frame;
  for (size_t m = 0; m < markers.size(); ++m) {
    std::array<Eigen::Vector2d, 2> pixels;
    std::array<bool, 2> visible{};
    for (int c = 0; c < 2; ++c) {
      const char* side = c == 0 ? "left" : "right";
      const Json& pixel = truth["pixels"][side][m];
      pixels[c] = Eigen::Vector2d(pixel[0], pixel[1]);
      visible[c] = truth["visible"][side][m];
    }
    frame.pixels.push_back(pixels);
    frame.visible.push_back(visible);
    if (truth["markers"].contains("corners")) {
      frame.tags.push_back(TagAt(markers[m]["id"], truth["markers"]["corners"][m]));
    }
  }
  return frame;
}

}  // namespace

vision::Recording RecordingTruth::Open() const {
  return {rig, {{"left", folder / "left.mp4"}, {"right", folder / "right.mp4"}}};
}

std::optional<RecordingTruth> LoadRecordingTruth(const std::string& name) {
  RecordingTruth result;
  result.folder = std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings" / name;
  std::ifstream stream(result.folder / "truth.json");
  if (!stream) return std::nullopt;
  const Json truth = Json::parse(stream);
  const Json& cameras = truth["cameras"];
  const Eigen::Isometry3d T_left_robot = Transform(cameras["left"]["T_camera_robot"]);
  for (const char* side : {"left", "right"}) {
    camera::Camera camera = CameraFrom(side, cameras);
    camera.T_camera_rig = Transform(cameras[side]["T_camera_robot"]) * T_left_robot.inverse();
    result.rig.cameras.push_back(camera);
  }
  result.rig.T_rig_robot = T_left_robot;
  for (const Json& tag : truth["fiducials"]) {
    result.fiducials.push_back(TagAt(tag["id"], tag["corners_TL_TR_BR_BL"]));
  }
  for (const Json& frame : truth["frames"]) {
    result.frames.push_back(FrameFrom(frame, truth["markers"]));
  }
  return result;
}

}  // namespace softforce::testing
