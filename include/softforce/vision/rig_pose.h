#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/geometry/rigid.h"

namespace softforce::vision {

// A point of known place in the robot frame, seen by one camera of the rig.
struct PointSighting {
  Eigen::Vector3d p_robot;  // m
  int camera = -1;
  Eigen::Vector2d pixel;       // px, distorted
  Eigen::Matrix2d covariance;  // px²
};

struct RigPose {
  enum class Status { kNotRun, kOk, kTooFewPoints, kDegenerate, kNotConverged };

  Status status = Status::kNotRun;
  Eigen::Isometry3d T_rig_robot = Eigen::Isometry3d::Identity();
  // Of a small twist xi (m, rad) in the rig frame: T_rig_robot = ExpSe3(xi) · estimate.
  geometry::Matrix6d covariance = geometry::Matrix6d::Constant(NAN);
  double rms_px = NAN;  // reprojection error, root mean square of the 2-D distance over the points
  int num_points = 0;

  bool ok() const { return status == Status::kOk; }
};

// Where the rig stands in the robot frame, by ViSP: vpPose (Dementhon or Lagrange, then virtual
// visual servoing) in the camera that sees most, then virtual visual servoing over the points of
// all cameras together, each camera's image Jacobian carried to the rig frame by its velocity twist
// matrix and each point weighted by its covariance. The returned covariance scales with the
// residuals where these exceed what the points' own covariances allow.
RigPose EstimateRigPose(const camera::Rig& rig, const std::vector<PointSighting>& sightings);

// The same from a pose near the right one, with no need of four points in one camera.
RigPose RefineRigPose(const camera::Rig& rig, const std::vector<PointSighting>& sightings,
                      const Eigen::Isometry3d& start);

}  // namespace softforce::vision
