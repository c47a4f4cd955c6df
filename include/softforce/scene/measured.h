#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softforce/geometry/rigid.h"

namespace softforce::scene {

struct Markers;

// The section "measured" of a scene: points in space that a motion-capture system measured, instead
// of cameras. The system's frame is the rig's.
struct Measured {
  std::filesystem::path file;
  std::optional<double> metres_per_unit;  // of a table whose columns do not name their unit
  std::optional<double> rate;             // Hz, of a table that numbers its frames only
  // m, standard deviation of each coordinate where the file does not say: what systems of the usual
  // size reach in a lab, not what their makers print.
  double noise = 0.2e-3;
  bool labels = true;               // false: what the points are called is not relied on
  std::vector<std::string> ignore;  // labels of points that are none of the markers
  // Where the system's frame is; at most one of them. Neither: it is the robot's.
  std::filesystem::path rig;
  std::optional<Eigen::Isometry3d> T_rig_robot;
};

struct MeasuredPoint {
  Eigen::Vector3d p_rig;  // m
  double sd = NAN;        // m, of each coordinate
  int marker = -1;        // number in the scene's list; −1: without a label
};

struct MeasuredFrame {
  int frame = -1;  // as the file numbers it, or counted from 0
  double time_s = NAN;
  std::vector<MeasuredPoint> points;  // those that were seen
};

struct MeasuredPoints {
  std::string format;                 // "Motive 1.23", "table"; for a person
  std::vector<MeasuredFrame> frames;  // numbers and times ascend
};

// Reads a CSV export of OptiTrack's Motive, of which the columns of type Marker are used; or a
// table with a row for every point (time_s or frame, marker, x_mm, y_mm, z_mm, sd_mm) or for every
// frame (time_s or frame, LABEL_x_mm, LABEL_y_mm, LABEL_z_mm …). Empty cells are points that were
// not seen. Throws InputError naming file, line and column: an unknown unit or label, coordinates
// without unit, a point with two of three coordinates, times that do not ascend, …
MeasuredPoints ReadMeasuredPoints(const Measured& measured, const Markers& markers);

}  // namespace softforce::scene
