#include "softforce/pipeline/frame_result.h"

#include <cmath>

namespace softforce::pipeline {

double ForceResult::NormSd() const {
  const double norm = force.norm();
  if (!(norm > 0)) return std::sqrt(covariance.trace());
  const Eigen::Vector3d along = force / norm;
  return std::sqrt(along.dot(covariance * along));
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
