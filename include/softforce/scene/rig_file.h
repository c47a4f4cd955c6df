#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"

namespace softforce::scene {

// Files that say what cameras are and how they stand. docs/rig.md shows each of them.
enum class RigFormat {
  kSoftforce,  // rig.yaml: any number of cameras, any lens, statistics of the calibration
  kOpenCv,     // cv::FileStorage: one camera, or the two of stereo_calib
  kKalibr,     // camchain.yaml: any number of cameras
  kRos         // camera_info: a file for each camera; the baseline of a pair in P
};

// What files of OpenCV may leave open.
struct RigReadOptions {
  std::optional<double> metres_per_unit;         // of T; the file's own key "unit" wins
  std::optional<std::array<int, 2>> resolution;  // px, width and height; the file's own wins
};

RigFormat FormatOfRig(const std::filesystem::path& file);  // as its content shows
std::string NameOf(RigFormat format);                      // for a person

// Reads a rig of any format; which one is seen from the content. Throws InputError naming file,
// camera and key: a rotation that is none, a lens model it does not know, a resolution or focal
// length that is not positive, …
camera::Rig LoadRig(const std::filesystem::path& file);

// The same for a rig in one or several files: intrinsics and extrinsics of OpenCV, or the files of
// a rectified pair of ROS. The first camera's frame becomes the rig's, but for our own format.
camera::Rig LoadRig(const std::vector<std::filesystem::path>& files, const RigReadOptions& options);

// How a rig was calibrated and how well: the section "calibration" of a rig.yaml. RMS values are
// roots of the mean squared length of the error vectors.
struct RigStatistics {
  struct Camera {
    std::string name;
    int pictures = 0, points = 0;
    double rms_px = NAN;
  };

  std::string board;  // as the command line has it
  int views = 0;
  double rms_px = NAN;
  // Of views that were held out; NaN if there were none, m if only one camera saw them.
  double held_out_px = NAN, held_out_square = NAN, held_out_board = NAN;
  std::vector<Camera> cameras;
  // "left: fx", "right: translation x", "board: warp x"; px, rad, m. The covariance is joint.
  std::vector<std::string> parameters;
  Eigen::MatrixXd covariance;
};

// The statistics in a rig.yaml; nothing if it has none, or is of another format.
std::optional<RigStatistics> LoadRigStatistics(const std::filesystem::path& file);

// Writes a rig.yaml so that LoadRig reads back the same values.
void SaveRig(const camera::Rig& rig, const std::filesystem::path& file,
             const std::optional<RigStatistics>& statistics = std::nullopt);

// Writes a rig in any format. `path` is a folder for RigFormat::kRos, which gets NAME.yaml for each
// camera. Throws InputError if the format cannot hold the rig: a lens that it does not know, or
// more cameras.
void SaveRigAs(const camera::Rig& rig, RigFormat format, const std::filesystem::path& path);

// "softforce", "opencv", "kalibr" or "ros". Throws InputError, naming `where`, on another word.
RigFormat ParseRigFormat(const std::string& word, const std::string& where);

}  // namespace softforce::scene
