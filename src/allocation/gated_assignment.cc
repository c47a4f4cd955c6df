#include "allocation/gated_assignment.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "allocation/assignment.h"

namespace softforce::allocation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kForbidden =
    1e9;  // stands for "not in the gate" where the assignment wants finite costs

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

std::vector<AllocatedPixel> AssignGated(const Eigen::MatrixXd& distances2, double gate,
                                        double min_margin) {
  std::vector<AllocatedPixel> allocated(static_cast<size_t>(distances2.rows()));
  for (const std::vector<int>& features : CompetingFeatures(distances2)) {
    if (features.empty()) continue;
    const Eigen::MatrixXd cost = GroupCosts(distances2, features, gate);
    const Assignment best = AssignRows(cost);
    for (int i = 0; i < static_cast<int>(features.size()); ++i) {
      const int d = best.column_of_row[i];
      if (d >= distances2.cols() || cost(i, d) >= kForbidden) continue;  // hidden
      AllocatedPixel& result = allocated[features[i]];
      result.distance2 = distances2(features[i], d);
      const bool clear = Margin(cost, best, i, distances2.cols()) >= min_margin;
      result.status = clear ? AllocatedPixel::Status::kSeen : AllocatedPixel::Status::kAmbiguous;
      if (clear) result.detection = d;
    }
  }
  return allocated;
}

}  // namespace softforce::allocation
