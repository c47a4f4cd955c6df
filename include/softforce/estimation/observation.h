#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "softforce/mesh/surface.h"

namespace softforce::estimation {

// A place where an external force acts, and the directions that it may have there.
struct ForceSite {
  std::string name;       // for messages
  mesh::NodalWeights at;  // the mean over its patch
  Eigen::Matrix3Xd
      directions;  // orthonormal columns: 3×1 for a known direction, 3×3 for a free one
  // N, of the intensity along every direction: 0 … ∞ for a push along the inward normal.
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
};

// How well an actuator's command is known: the standard deviation of what it really does about what
// it was told (N or m of a cable, Pa of a chamber). 0: exactly (paper eqs. 11 and 12); infinity:
// not at all, so that it is found along with the forces (Remark 3).
using ActuatorUncertainty = double;

// k×3: whitening · (model − measured) has unit covariance (1/m).
using Whitening = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>;

// Where a point of the body was measured to be.
struct Observation {
  mesh::NodalWeights at;                             // the point, as a mean of nodes
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // m, measured point − that mean, body at rest
  Eigen::Vector3d position = Eigen::Vector3d::Constant(NAN);  // m, robot frame
  // For the measurement's own noise; k = 3, or 2 where only one camera sees the point.
  Whitening whitening;
  // Observations of one number ≥ 0 share one local model error: the corners of a tag stand so close
  // together that the model errs alike in all of them. −1: it has its own.
  int marker = -1;
};

}  // namespace softforce::estimation
