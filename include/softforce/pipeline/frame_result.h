#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "softforce/estimation/force_estimator.h"

namespace softforce::pipeline {

struct ForceResult {
  int identity = -1;           // stays with a force from frame to frame
  int candidate = -1;          // id in the scene; the nearest one, if places are not known
  Eigen::Vector3d position;    // m, robot frame, on the deformed body
  Eigen::Vector3d rest;        // m, the same material place on the body at rest
  Eigen::Vector3d force;       // N
  Eigen::Matrix3d covariance;  // N²
  Eigen::Matrix3d place_covariance = Eigen::Matrix3d::Zero();  // m², of `rest`; 0 if it is known

  // Candidates (ids in the scene) at which it may act instead.
  std::vector<int> alternatives{};

  double NormSd() const;  // N, standard deviation of the force's norm
  double PlaceSd()
      const;  // m, standard deviation of the place, along the surface where it is largest
};

enum class MarkerStatus { kSeen, kOneCamera, kHidden, kRejected };

const char* Name(MarkerStatus status);

struct MarkerResult {
  int id = -1;
  MarkerStatus status = MarkerStatus::kHidden;
  Eigen::Vector3d measured = Eigen::Vector3d::Constant(NAN);  // m; NaN if hidden or rejected
  double sd = NAN;                                            // m, root mean square over the axes
  Eigen::Vector3d model = Eigen::Vector3d::Constant(NAN);     // m
  // No camera could have seen it: it faces away from all, or the body or the picture's edge is in
  // the way. That it is hidden says nothing then.
  bool expected_absent = false;
  bool used = false;         // whether the forces come from it, among others
  double information = NAN;  // share of what the observations tell about the forces; see
                             // estimation::ForceInformation; NaN if it was not observed
  // Where the marker is by all that was seen in the frame, for one that is hidden too, and the
  // covariance of that (m²); set in frames with forces.
  Eigen::Vector3d expected = Eigen::Vector3d::Constant(NAN);  // m
  Eigen::Matrix3d expected_covariance = Eigen::Matrix3d::Constant(NAN);
};

struct CableResult {
  std::string name;
  double tension = NAN;       // N
  double displacement = NAN;  // m, shortening
};

struct ChamberResult {
  std::string name;
  double pressure = NAN;  // Pa
};

// All that is known of one frame. If the status is not kOk the forces are empty and the model is
// where it was expected. If it is, and places are not known, forces may be empty, too: none acts.
struct FrameResult {
  int frame = -1;
  double time_s = NAN;
  estimation::ForceEstimate::Status status = estimation::ForceEstimate::Status::kNotRun;
  std::string reason;
  std::vector<ForceResult> forces;
  std::vector<MarkerResult> markers;
  std::vector<CableResult> cables;
  std::vector<ChamberResult> chambers;
  // If places are not known: that the forces are as many as found, and on these faces.
  double probability = NAN;
  double chi2 = NAN;
  int degrees_of_freedom = 0;

  bool ok() const { return status == estimation::ForceEstimate::Status::kOk; }
};

}  // namespace softforce::pipeline
