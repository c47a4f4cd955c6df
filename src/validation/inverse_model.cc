#include "softforce/validation/inverse_model.h"

#include <algorithm>
#include <cmath>

#include "softforce/validation/measures.h"

namespace softforce::validation {
namespace {

constexpr double kRounding = 1e-9;  // share of a bound

std::vector<estimation::ForceSite> Sites(const Model& model, const Layout& layout) {
  std::vector<estimation::ForceSite> sites;
  for (const Eigen::Vector3d& place : layout.candidates) sites.push_back(SiteAt(model, place));
  return sites;
}

}  // namespace

estimation::EstimatorOptions LeastSquares(double tolerance) {
  estimation::EstimatorOptions options;
  options.common_model_error = 0;
  options.local_model_error = 0;
  options.tolerance = tolerance / kWideSd;
  options.min_singular_ratio = 1e-9;  // candidates of I_w = 2000 N/mm are to be told apart
  options.max_staleness = 1e-5;       // so that Gauss–Newton's steps are those of the shape
  return options;
}

geometry::Matrix6d RegistrationCovariance() {
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(kRegistrationSd * kRegistrationSd);
  covariance.diagonal().tail<3>().setConstant(kOrientationSd * kOrientationSd);
  return covariance;
}

InverseModel::InverseModel(const Model& model, fem::StaticSolver* solver, const Layout& layout,
                           const estimation::EstimatorOptions& options, double sd)
    : offsets_(layout.markers.size(), Eigen::Vector3d::Zero()),
      sd_(sd),
      applied_(Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(layout.candidates.size()))),
      estimator_(solver, Sites(model, layout), options) {
  for (const Eigen::Vector3d& place : layout.markers) markers_.push_back(PointAt(model, place));
  Eigen::Index component = 0;  // the loaded places are the first candidates
  for (const AppliedForce& force : AppliedForces(layout.body)) {
    applied_.segment<3>(component) = force.force;
    component += 3;
  }
}

void InverseModel::FreeRegistration() {
  estimator_.SetRegistrationCovariance(RegistrationCovariance());
}

void InverseModel::SetOffsets(const std::vector<Eigen::Vector3d>& offsets) { offsets_ = offsets; }

void InverseModel::SetLargestForce(double largest) {
  largest_ = largest;
  for (size_t site = 0; site < estimator_.sites().size(); ++site) {
    Bound(static_cast<int>(site), largest);
  }
}

std::vector<estimation::Observation> InverseModel::Observe(
    const std::vector<Eigen::Vector3d>& seen) const {
  std::vector<estimation::Observation> observations;
  for (size_t i = 0; i < markers_.size(); ++i) {
    estimation::Observation observation;
    observation.at = markers_[i];
    observation.offset = offsets_[i];
    observation.position = seen[i];
    observation.whitening = Eigen::Matrix3d::Identity() / sd_;
    observations.push_back(observation);
  }
  return observations;
}

double InverseModel::ErrorOf(const estimation::ForceEstimate& estimate) const {
  const bool answered =
      estimate.ok() && estimate.intensity.lpNorm<Eigen::Infinity>() < (1 - kRounding) * largest_;
  return answered ? ForceError(estimate.intensity, applied_) : NAN;
}

double InverseModel::Error(const std::vector<Eigen::Vector3d>& seen,
                           const fem::Actuation& actuation) {
  return ErrorOf(estimator_.Estimate(Observe(seen), actuation));
}

bool InverseModel::GiveUpWeak(const estimation::ForceEstimate& estimate, std::vector<char>* kept) {
  std::vector<double> norms;
  for (size_t site = 0; site < kept->size(); ++site) {
    norms.push_back(estimator_.Force(estimate.intensity, static_cast<int>(site)).norm());
  }
  const double threshold = kSelectionThreshold * *std::max_element(norms.begin(), norms.end());
  bool any = false;
  for (size_t site = 0; site < kept->size(); ++site) {
    if (!(*kept)[site] || norms[site] >= threshold) continue;
    (*kept)[site] = false;
    Bound(static_cast<int>(site), 0);
    any = true;
  }
  return any;
}

ForceErrors InverseModel::SelectedError(const std::vector<Eigen::Vector3d>& seen,
                                        const fem::Actuation& actuation) {
  const std::vector<estimation::Observation> observations = Observe(seen);
  estimation::ForceEstimate estimate = estimator_.Estimate(observations, actuation);
  ForceErrors errors{ErrorOf(estimate), NAN};
  std::vector<char> kept(estimator_.sites().size(), true);
  while (estimate.ok() && GiveUpWeak(estimate, &kept)) {
    estimate = estimator_.Estimate(observations, actuation);
  }
  errors.selected = ErrorOf(estimate);
  SetLargestForce(largest_);
  return errors;
}

Eigen::MatrixXd InverseModel::Compliance() const {
  Eigen::MatrixXd W(3 * static_cast<Eigen::Index>(markers_.size()), applied_.size());
  for (size_t i = 0; i < markers_.size(); ++i) {
    W.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = estimator_.Compliance(markers_[i]);
  }
  return W;
}

}  // namespace softforce::validation
