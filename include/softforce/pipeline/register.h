#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "softforce/calibration/match_markers.h"
#include "softforce/calibration/point_pairs.h"
#include "softforce/pipeline/run.h"
#include "softforce/vision/rig_pose.h"

namespace softforce::pipeline {

enum class RegisterFrom {
  kAnything,   // fiducials if the scene has any, else markers
  kFiducials,  // tags of known place on the base
  kMarkers,    // the body's own markers, while nothing but its actuators acts on it
               // (the only way of motion capture)
  kPairs       // points that a person typed
};

struct RegisterOptions {
  RegisterFrom from = RegisterFrom::kAnything;
  std::filesystem::path pairs;  // file of kPairs
  int frame = 0;                // the first, or for markers the only one to look at
  int fiducial_frames = 10;
  std::map<std::string, std::string> sources;    // camera → file or live source; not the scene's
  std::map<std::string, double> time_offsets_s;  // camera → s; not the rig's
  vision::LiveOptions live;
  calibration::MatchOptions match;
  calibration::PairOptions typed;
  const std::atomic<bool>* stop = nullptr;  // set from outside

  void Check() const;  // throws InputError naming the option
};

struct RegisterReport {
  std::filesystem::path rig_file;
  vision::RigPose pose;
  double rms = NAN;  // m, misfit of the markers in space, by motion capture
  std::string how;   // what it was found from, for a person
  std::vector<std::string> warnings;
  Eigen::Vector3d body_centre = Eigen::Vector3d::Zero();      // m, robot frame, of the markers
  Eigen::Matrix3d body_covariance = Eigen::Matrix3d::Zero();  // m², of that point by the pose, rig
  // Against T_rig_robot in the file, if it has one: m, of the centre; rad.
  double moved = NAN, turned = NAN;

  std::string Spread() const;  // standard deviations, lines of text
  std::string FullReport() const;
};

// Finds where the rig, or the frame of motion capture, stands in the robot frame. Throws InputError
// if it cannot be found, saying what is missing: a place is never guessed.
RegisterReport Register(const std::filesystem::path& scene_file, const RegisterOptions& options);

}  // namespace softforce::pipeline
