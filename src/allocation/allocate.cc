#include "softforce/allocation/allocate.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "allocation/gated_assignment.h"
#include "softforce/base/input_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::allocation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Squared Mahalanobis distance of every pair within its gate, infinity elsewhere; features ×
// detections.
Eigen::MatrixXd GatedDistances(const std::vector<PredictedPixel>& predictions,
                               const std::vector<DetectedPixel>& detections, double gate,
                               double threshold_displacement) {
  Eigen::MatrixXd distances =
      Eigen::MatrixXd::Constant(predictions.size(), detections.size(), kInfinity);
  for (size_t f = 0; f < predictions.size(); ++f) {
    for (size_t d = 0; d < detections.size(); ++d) {
      const Eigen::Vector2d nu = detections[d].pixel - predictions[f].pixel;
      const Eigen::Matrix2d S = predictions[f].covariance + detections[d].covariance;
      if (!nu.allFinite() || !S.allFinite()) continue;
      if (threshold_displacement > 0 && nu.norm() > threshold_displacement) continue;
      const double distance2 = nu.dot(S.inverse() * nu);
      if (distance2 >= 0 && distance2 <= gate) distances(f, d) = distance2;
    }
  }
  return distances;
}

// The paper's rule. A detection that is nearest to several features goes to the nearest of them.
std::vector<AllocatedPixel> AllocateNearest(const std::vector<PredictedPixel>& predictions,
                                            const std::vector<DetectedPixel>& detections,
                                            double threshold) {
  std::vector<AllocatedPixel> allocated(predictions.size());
  std::vector<int> owner(detections.size(), -1);
  std::vector<double> nearest_to(detections.size(), kInfinity);
  for (size_t f = 0; f < predictions.size(); ++f) {
    int nearest = -1;
    double least = threshold > 0 ? threshold : kInfinity;
    for (size_t d = 0; d < detections.size(); ++d) {
      const double distance = (detections[d].pixel - predictions[f].pixel).norm();
      if (!(distance <= least)) continue;
      nearest = static_cast<int>(d);
      least = distance;
    }
    if (nearest < 0 || least >= nearest_to[nearest]) continue;
    if (owner[nearest] >= 0) allocated[owner[nearest]] = {};
    owner[nearest] = static_cast<int>(f);
    nearest_to[nearest] = least;
    allocated[f].status = AllocatedPixel::Status::kSeen;
    allocated[f].detection = nearest;
  }
  return allocated;
}

}  // namespace

const char* Name(Rule rule) { return rule == Rule::kOptimal ? "optimal" : "nearest"; }

void AllocationOptions::Check() const {
  if (!(gate_probability > 0 && gate_probability < 1)) {
    throw base::InputError("allocation: gate_probability", "must lie between 0 and 1");
  }
  if (!(threshold_displacement_px >= 0)) {
    throw base::InputError("allocation: threshold_displacement_px", "must be 0 px or more");
  }
  if (!(min_margin >= 0)) {
    throw base::InputError("allocation: min_margin", "must be 0 or more");
  }
}

std::vector<AllocatedPixel> Allocate(const std::vector<PredictedPixel>& predictions,
                                     const std::vector<DetectedPixel>& detections,
                                     const AllocationOptions& options) {
  options.Check();
  if (options.rule == Rule::kNearest) {
    return AllocateNearest(predictions, detections, options.threshold_displacement_px);
  }
  const double gate = geometry::ChiSquareQuantile(options.gate_probability, 2);
  return AssignGated(
      GatedDistances(predictions, detections, gate, options.threshold_displacement_px), gate,
      options.min_margin);
}

}  // namespace softforce::allocation
