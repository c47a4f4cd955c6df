#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/rig_pose.h"

namespace softforce::calibration {

// A dot of known place on the robot.
struct KnownDot {
  Eigen::Vector3d p_robot;  // m
  Eigen::Vector3d normal;   // of the surface there, outward
  double diameter = 0;      // m
};

// Something in a picture that may be one of them.
struct DetectedSpot {
  Eigen::Vector2d pixel;       // px, centroid
  Eigen::Matrix2d covariance;  // px²
  double long_axis = NAN;      // px
};

struct MatchOptions {
  // How far a dot may be from where rig, cameras and the list of places have it: m, and px.
  double max_misplacement = 1.5e-3;
  double max_misfit_px = 1;
  double size_tolerance = 1.7;  // as in a run
  double min_facing = 0.1;      // cosine between a dot's normal and the way to the camera
  double min_share = 0.5;       // of the dots that two cameras must see
  // Another labelling that explains less than so many dots fewer, about as well, makes it
  // ambiguous.
  int min_lead = 2;
  int max_triples = 400;  // of dots to start from; more are sampled

  void Check() const;  // throws InputError naming the option
};

struct MarkerMatch {
  enum class Status { kNotRun, kOk, kTooFewSeen, kNoMatch, kAmbiguous };

  Status status = Status::kNotRun;
  vision::RigPose pose;                 // if kOk
  int matched = 0;                      // dots that two cameras or more see where they should
  std::vector<std::vector<int>> spots;  // [camera][dot]: the spot that is its picture; −1: none
  int rival = 0;                        // dots that the best other labelling explains
  bool by_guess = false;                // the guess decided between labellings
  int points = 0;                       // places in space at which cameras agree to see a spot

  bool ok() const { return status == Status::kOk; }
};

// Finds where the rig stands from spots without labels, of which some are none of the dots, while
// some dots are hidden. Spots of two cameras whose rays meet make points in space; triples of dots
// and triples of points with the same distances between them propose a pose; those poses that put
// most dots onto points are refined by what all cameras see, and compared. A symmetric layout fits
// in several ways: then the one close to `guess` (T_rig_robot) is taken if there is such, and else
// it is kAmbiguous. Needs two cameras. The same input gives the same answer.
MarkerMatch MatchMarkers(const camera::Rig& rig, const std::vector<KnownDot>& dots,
                         const std::vector<std::vector<DetectedSpot>>& spots,
                         const std::optional<Eigen::Isometry3d>& guess,
                         const MatchOptions& options = {});

}  // namespace softforce::calibration
