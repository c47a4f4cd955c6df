#include "softforce/pipeline/frame_result.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace softforce::pipeline {

double ForceResult::NormSd() const {
  const double norm = force.norm();
  if (!(norm > 0)) return std::sqrt(covariance.trace());
  const Eigen::Vector3d along = force / norm;
  return std::sqrt(along.dot(covariance * along));
}

double ForceResult::PlaceSd() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(place_covariance,
                                                            Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues()(2)));
}

const char* Name(MarkerStatus status) {
  switch (status) {
    case MarkerStatus::kSeen:
      return "seen";
    case MarkerStatus::kOneCamera:
      return "one_camera";
    case MarkerStatus::kHidden:
      return "hidden";
    case MarkerStatus::kRejected:
      return "rejected";
  }
  return "";
}

}  // namespace softforce::pipeline
