#include "softforce/allocation/allocate_places.h"

#include <Eigen/LU>
#include <limits>

#include "allocation/gated_assignment.h"
#include "softforce/base/input_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::allocation {

std::vector<AllocatedPixel> AllocatePlaces(const std::vector<PredictedPlace>& predictions,
                                           const std::vector<DetectedPlace>& detections,
                                           double threshold_displacement,
                                           const AllocationOptions& options) {
  options.Check();
  if (!(threshold_displacement >= 0)) {
    throw base::InputError("allocation: threshold_displacement", "must be 0 m or more");
  }
  const double gate = geometry::ChiSquareQuantile(options.gate_probability, 3);
  Eigen::MatrixXd distances2 = Eigen::MatrixXd::Constant(predictions.size(), detections.size(),
                                                         std::numeric_limits<double>::infinity());
  for (size_t f = 0; f < predictions.size(); ++f) {
    for (size_t d = 0; d < detections.size(); ++d) {
      const Eigen::Vector3d nu = detections[d].position - predictions[f].position;
      const Eigen::Matrix3d S = predictions[f].covariance + detections[d].covariance;
      if (!nu.allFinite() || !S.allFinite()) continue;
      if (threshold_displacement > 0 && nu.norm() > threshold_displacement) continue;
      const double distance2 = nu.dot(S.inverse() * nu);
      if (distance2 >= 0 && distance2 <= gate) distances2(f, d) = distance2;
    }
  }
  return AssignGated(distances2, gate, options.min_margin);
}

}  // namespace softforce::allocation
