// The tracker's part that weighs what its markers tell.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "softforce/estimation/information.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {
namespace {

// p + translation + rotation × (p − centre), by the twist of both.
Eigen::Matrix<double, 3, 6> ByOffset(const Eigen::Vector3d& p, const Eigen::Vector3d& centre) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -geometry::Skew(p - centre);
  return jacobian;
}

// What the offset is known to be beforehand, about the centre: where the rig stands, and what the
// model gets wrong for all markers alike (sd: m, and rad over the markers' spread).
geometry::Matrix6d OffsetCovariance(const geometry::Matrix6d& registration,
                                    const Eigen::Vector3d& centre, double common, double spread) {
  geometry::Matrix6d to_centre = geometry::Matrix6d::Identity();
  to_centre.topRightCorner<3, 3>() = -geometry::Skew(centre);
  geometry::Matrix6d covariance = to_centre * registration * to_centre.transpose();
  covariance.diagonal().head<3>().array() += common * common;
  if (spread > 0) covariance.diagonal().tail<3>().array() += std::pow(common / spread, 2);
  return covariance;
}

}  // namespace

std::vector<char> Tracker::Choose(const std::vector<FeatureObservation>& located) {
  const Eigen::Matrix3Xd& u = estimator_.state().u;
  const Eigen::Matrix3Xd x = world_.mesh().nodes + u;
  std::vector<size_t> seen;  // features
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double displacement = 0;  // m, the largest
  for (size_t f = 0; f < located.size(); ++f) {
    if (located[f].whitening.rows() == 0) continue;
    seen.push_back(f);
    const BodyPoint& point = features_.features()[f].point;
    centre += point.weights.Apply(x) + point.offset;
    displacement = std::max(displacement, point.weights.Apply(u).norm());
  }
  if (!seen.empty()) centre /= static_cast<double>(seen.size());

  // Per marker, since the model errs alike in all features of one.
  const estimation::EstimatorOptions& model = options_.estimator;
  const double local = std::pow(model.local_model_error * displacement, 2);  // m²
  std::vector<estimation::MarkerRows> rows;
  std::vector<int> markers;
  double spread2 = 0;
  for (const size_t f : seen) {
    const Feature& feature = features_.features()[f];
    const Eigen::Vector3d p = feature.point.weights.Apply(x) + feature.point.offset;
    spread2 += (p - centre).squaredNorm() / static_cast<double>(seen.size());
    const Eigen::MatrixXd W = located[f].whitening;
    const auto companions = std::count_if(seen.begin(), seen.end(), [&](size_t other) {
      return features_.features()[other].marker == feature.marker;
    });
    const Eigen::MatrixXd R = Eigen::MatrixXd::Identity(W.rows(), W.rows()) +
                              static_cast<double>(companions) * local * W * W.transpose();
    const Eigen::MatrixXd whitening = R.llt().matrixL().solve(W);
    const size_t known =
        std::find(markers.begin(), markers.end(), feature.marker) - markers.begin();
    if (known == markers.size()) {
      markers.push_back(feature.marker);
      rows.push_back({Eigen::MatrixXd(0, estimator_.num_components()), {}});
    }
    estimation::MarkerRows& of = rows[known];
    const Eigen::Index before = of.forces.rows();
    of.forces.conservativeResize(before + W.rows(), Eigen::NoChange);
    of.offset.conservativeResize(before + W.rows(), Eigen::NoChange);
    of.forces.bottomRows(W.rows()) = whitening * estimator_.Compliance(feature.point.weights);
    of.offset.bottomRows(W.rows()) = whitening * ByOffset(p, centre);
  }
  const double common = model.common_model_error * displacement;
  const estimation::ForceInformation information(
      std::move(rows),
      OffsetCovariance(registration_covariance_, centre, common, std::sqrt(spread2)));

  information_.assign(world_.markers.size(), NAN);
  const std::vector<double> shares = information.Shares();
  for (size_t i = 0; i < markers.size(); ++i) information_[markers[i]] = shares[i];
  std::vector<char> wanted(world_.markers.size(), options_.max_markers == 0 ? 1 : 0);
  if (options_.max_markers > 0) {
    for (const int i : information.MostTelling(options_.max_markers)) wanted[markers[i]] = 1;
  }
  std::vector<char> chosen(located.size(), 0);
  for (const size_t f : seen) chosen[f] = wanted[features_.features()[f].marker];
  return chosen;
}

// A tag is used if one of its corners is.
void Tracker::TellWhatWasUsed(const std::vector<char>& chosen, const std::vector<char>& rejected,
                              std::vector<MarkerResult>* markers) const {
  for (size_t m = 0; m < markers->size(); ++m) (*markers)[m].information = information_[m];
  for (size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] && !rejected[f]) (*markers)[features_.features()[f].marker].used = true;
  }
}

}  // namespace softforce::pipeline
