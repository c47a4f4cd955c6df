#pragma once

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/yaml_reader.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {

// The readers: `files` are the whole files, of one format.
// `statistics` may be null.
camera::Rig ReadSoftforceRig(const std::filesystem::path& file,
                             std::optional<RigStatistics>* statistics = nullptr);
RigStatistics ReadStatistics(YamlMap& map);
geometry::Matrix6d ReadPlaceCovariance(const YamlValue& value);
camera::Rig ReadOpenCvRig(const std::vector<YamlValue>& files, const RigReadOptions& options);
camera::Rig ReadKalibrRig(const YamlValue& file);
camera::Rig ReadRosRig(const std::vector<YamlValue>& files);

// The writers: the text of a file. `where` is its name, for messages.
std::string SoftforceText(const camera::Rig& rig, const std::optional<RigStatistics>& statistics);
std::string StatisticsText(const RigStatistics& statistics);
// T_rig_robot and, unless it is zero, its covariance; `comment` (lines) beside the first.
std::string PlaceText(const Eigen::Isometry3d& T_rig_robot, const geometry::Matrix6d& covariance,
                      const std::string& comment);
std::string OpenCvText(const camera::Rig& rig, const std::string& where);
std::string KalibrText(const camera::Rig& rig, const std::string& where);
std::vector<std::string> RosTexts(const camera::Rig& rig);  // one for each camera

// A lens as all files have it: fx, fy, cx, cy and the coefficients.
struct LensNumbers {
  bool fisheye = false;                // Kannala–Brandt, k1 … k4; else Brown–Conrady
  std::array<double, 4> intrinsics{};  // px
  std::vector<double> distortion;      // 4, 5 or 8 of OpenCV's order; 4 of a fisheye
};

LensNumbers NumbersOf(const camera::Camera& camera);
void SetLens(const LensNumbers& numbers, camera::Camera& camera);

// The same without zeros at the end that the smaller model has no place for: 4, 5 or 8 are left.
std::vector<double> ShortDistortion(const LensNumbers& lens);

// A matrix as a map of rows, cols and data (OpenCV's !!opencv-matrix, ROS), as a list of rows, or
// as one list.
struct YamlMatrix {
  YamlValue place;
  int rows = 0, cols = 0;
  std::vector<double> numbers;  // row by row
};

YamlMatrix ReadMatrix(const YamlValue& value);

// Refuses another size. A vector may be a row or a column; one list has as many numbers.
YamlMatrix ReadMatrix(const YamlValue& value, int rows, int cols);

// Coefficients in OpenCV's order as files have them: none, 4, 5, 8, or 12 or 14 if those after the
// eighth are zero; 4 of a fisheye.
std::vector<double> Coefficients(const YamlMatrix& D, bool fisheye);

// The pinhole of [fx, fy, cx, cy]: finite, focal lengths above 0 px.
std::array<double, 4> ReadIntrinsics(const YamlValue& list);

// The same of a 3×3 camera matrix without skew.
std::array<double, 4> IntrinsicsOfMatrix(const YamlMatrix& K);

// A rotation that other tools wrote with few digits, rows in a row: the nearest true one, if it is
// off by at most 1e-4.
Eigen::Matrix3d RoundedRotation(const YamlValue& place, const std::vector<double>& rows);

Eigen::Isometry3d Rigid(const Eigen::Matrix3d& R, const Eigen::Vector3d& t);

// From one camera of a rig to another: p_target = T · p_source.
Eigen::Isometry3d Between(const camera::Camera& target, const camera::Camera& source);

// The shortest digits that read back as the same doubles: "[1, 0.5]".
template <class Numbers>
std::string List(const Numbers& numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

// The rows of a 4×4 matrix as a YAML list, a line each.
std::string Rows(const Eigen::Isometry3d& T, const std::string& indent);

// A text as YAML spells it: quoted if need be.
std::string Quoted(const std::string& text);

}  // namespace softforce::scene
