#include "softforce/allocation/allocate.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numeric>

#include "allocation/assignment.h"
#include "softforce/base/input_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::allocation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kForbidden =
    1e9;  // stands for "not in the gate" where the assignment wants finite costs

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

// Features that compete, directly or through others, for the same detections.
std::vector<std::vector<int>> CompetingFeatures(const Eigen::MatrixXd& distances) {
  const int features = static_cast<int>(distances.rows());
  std::vector<int> group(features);
  std::iota(group.begin(), group.end(), 0);
  for (int d = 0; d < distances.cols(); ++d) {
    int first = -1;
    for (int f = 0; f < features; ++f) {
      if (!std::isfinite(distances(f, d))) continue;
      if (first < 0) {
        first = f;
        continue;
      }
      const int from = group[f];
      const int to = group[first];
      for (int& g : group) g = g == from ? to : g;
    }
  }
  std::vector<std::vector<int>> members(features);
  for (int f = 0; f < features; ++f) members[group[f]].push_back(f);
  return members;
}

// Costs of one group: its detections, then for each feature a column of its own that leaves it
// hidden.
Eigen::MatrixXd GroupCosts(const Eigen::MatrixXd& distances, const std::vector<int>& features,
                           double hidden_price) {
  const Eigen::Index detections = distances.cols();
  const int n = static_cast<int>(features.size());
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(n, detections + n, kForbidden);
  for (int i = 0; i < n; ++i) {
    for (int d = 0; d < detections; ++d) {
      if (std::isfinite(distances(features[i], d))) cost(i, d) = distances(features[i], d);
    }
    cost(i, detections + i) = hidden_price;
  }
  return cost;
}

// By how much the best assignment in which row i has a different detection, or its detection goes
// to a different feature, is dearer; in units of half χ².
double Margin(Eigen::MatrixXd cost, const Assignment& best, int i, Eigen::Index detections) {
  const int taken = best.column_of_row[i];
  cost(i, taken) = kForbidden;
  bool contested = false;  // someone else in the gate wants, or offers, another pairing
  for (int d = 0; d < detections; ++d) contested = contested || cost(i, d) < kForbidden;
  for (int r = 0; r < cost.rows(); ++r)
    contested = contested || (r != i && cost(r, taken) < kForbidden);
  if (!contested) return kInfinity;
  return 0.5 * (AssignRows(cost).cost - best.cost);
}

}  // namespace

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
  std::vector<AllocatedPixel> allocated(predictions.size());
  const double gate = geometry::ChiSquareQuantile(options.gate_probability, 2);
  const Eigen::MatrixXd distances =
      GatedDistances(predictions, detections, gate, options.threshold_displacement_px);

  for (const std::vector<int>& features : CompetingFeatures(distances)) {
    if (features.empty()) continue;
    const Eigen::MatrixXd cost = GroupCosts(distances, features, gate);
    const Assignment best = AssignRows(cost);
    for (int i = 0; i < static_cast<int>(features.size()); ++i) {
      const int d = best.column_of_row[i];
      if (d >= distances.cols() || cost(i, d) >= kForbidden) continue;  // hidden
      AllocatedPixel& result = allocated[features[i]];
      result.distance2 = distances(features[i], d);
      const bool clear = Margin(cost, best, i, distances.cols()) >= options.min_margin;
      result.status = clear ? AllocatedPixel::Status::kSeen : AllocatedPixel::Status::kAmbiguous;
      if (clear) result.detection = d;
    }
  }
  return allocated;
}

}  // namespace softforce::allocation
