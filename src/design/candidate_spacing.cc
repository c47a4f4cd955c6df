#include "softforce/design/candidate_spacing.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "softforce/fem/compliance.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::design {
namespace {

constexpr double kFalseAlarm = 1e-3;  // as of estimation::LocationOptions
constexpr double kWider = 1.25;
constexpr double kInRegion = 0.95;
constexpr double kMost = 0.9;

Eigen::MatrixXd Compliance(const std::vector<PlacedLoad>& candidates,
                           const Eigen::MatrixXd& response, int components) {
  const Eigen::Index markers = response.cols() / 3;
  Eigen::MatrixXd W(3 * markers, components);
  Eigen::Index first = 0;
  for (const PlacedLoad& candidate : candidates) {
    for (Eigen::Index i = 0; i < markers; ++i) {
      W.block(3 * i, first, 3, candidate.num_directions()) =
          candidate.Rows(response, i).leftCols(candidate.num_directions());
    }
    first += candidate.num_directions();
  }
  return W;
}

// The standard deviation of each component, ascending; empty if they cannot be told.
std::vector<double> ForceDeviations(const Eigen::MatrixXd& W,
                                    const std::vector<MarkerSight>& markers) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(W.cols(), W.cols());
  for (size_t i = 0; i < markers.size(); ++i) {
    const auto own = W.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    information += own.transpose() * markers[i].information * own;
  }
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return {};
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * information * scale.asDiagonal());
  if (factor.info() != Eigen::Success) return {};
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(W.cols(), W.cols()));
  const Eigen::VectorXd deviations = inverse.diagonal().cwiseSqrt().cwiseProduct(scale);
  std::vector<double> ascending(deviations.begin(), deviations.end());
  std::sort(ascending.begin(), ascending.end());
  return ascending;
}

}  // namespace

CandidateGrid JudgeCandidates(double spacing, const std::vector<PlacedLoad>& candidates,
                              const Eigen::MatrixXd& response,
                              const std::vector<MarkerSight>& markers, double expected) {
  CandidateGrid grid;
  grid.spacing = spacing;
  grid.candidates = static_cast<int>(candidates.size());
  for (const PlacedLoad& candidate : candidates) grid.components += candidate.num_directions();
  grid.enough_markers = grid.components <= response.cols();
  if (!grid.enough_markers || candidates.empty()) return grid;
  const Eigen::MatrixXd W = Compliance(candidates, response, grid.components);
  grid.I_w = fem::InverseComplianceNorm(W);
  const std::vector<double> deviations = ForceDeviations(W, markers);
  if (deviations.empty()) return grid;
  grid.force_sd = deviations[deviations.size() / 2];
  grid.worst_force_sd = deviations.back();
  const double most = expected / std::sqrt(geometry::ChiSquareQuantile(1 - kFalseAlarm, 1));
  const auto stand_out = std::upper_bound(deviations.begin(), deviations.end(), most);
  grid.told_apart =
      static_cast<double>(stand_out - deviations.begin()) / static_cast<double>(deviations.size());
  return grid;
}

std::vector<double> SpacingsToJudge(double area, int markers, int components_each) {
  std::vector<double> spacings;
  const double most = std::max(2.0, std::floor(3.0 * markers / components_each));
  const double widest = std::sqrt(kFilling * area / 2);
  for (double s = std::sqrt(kFilling * area / most); s <= widest * (1 + 1e-9); s *= kWider) {
    spacings.push_back(s);
  }
  return spacings;
}

LocationSpacing SpacingOf(const std::vector<ExpectedError>& errors) {
  LocationSpacing spacing;
  if (errors.empty()) return spacing;
  const double radius = std::sqrt(geometry::ChiSquareQuantile(kInRegion, 2));
  std::vector<double> widths;
  widths.reserve(errors.size());
  for (const ExpectedError& error : errors) widths.push_back(2 * radius * error.location_major);
  std::sort(widths.begin(), widths.end());
  spacing.median = widths[widths.size() / 2];
  spacing.most = widths[std::min(widths.size() - 1,
                                 static_cast<size_t>(kMost * static_cast<double>(widths.size())))];
  return spacing;
}

}  // namespace softforce::design
