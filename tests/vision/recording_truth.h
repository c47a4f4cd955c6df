#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/recording.h"

namespace softforce::testing {

// What truth.json says of one of the shipped recordings. Metres, robot frame.
struct RecordingTruth {
  struct Tag {
    int id = -1;
    std::array<Eigen::Vector3d, 4> corners;  // TL TR BR BL
  };
  struct Frame {
    std::vector<std::array<Eigen::Vector2d, 2>> pixels;  // px; per marker, left and right
    std::vector<std::array<bool, 2>> visible;
    std::vector<Tag> tags;  // of the body; empty if its markers are dots
  };

  std::filesystem::path folder;
  camera::Rig rig;  // T_rig_robot set
  std::vector<Tag> fiducials;
  std::vector<Frame> frames;

  vision::Recording Open() const;
};

// Nothing if the recordings are not beside the project.
std::optional<RecordingTruth> LoadRecordingTruth(const std::string& name);

}  // namespace softforce::testing
