#include "softforce/validation/inverse_model.h"

#include <cmath>

#include "softforce/validation/measures.h"

namespace softforce::validation {
namespace {

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
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(kRegistrationSd * kRegistrationSd);
  covariance.diagonal().tail<3>().setConstant(kOrientationSd * kOrientationSd);
  estimator_.SetRegistrationCovariance(covariance);
}

void InverseModel::SetOffsets(const std::vector<Eigen::Vector3d>& offsets) { offsets_ = offsets; }

double InverseModel::Error(const std::vector<Eigen::Vector3d>& seen,
                           const fem::Actuation& actuation) {
  std::vector<estimation::Observation> observations;
  for (size_t i = 0; i < markers_.size(); ++i) {
    estimation::Observation observation;
    observation.at = markers_[i];
    observation.offset = offsets_[i];
    observation.position = seen[i];
    observation.whitening = Eigen::Matrix3d::Identity() / sd_;
    observations.push_back(observation);
  }
  const estimation::ForceEstimate estimate = estimator_.Estimate(observations, actuation);
  return estimate.ok() ? ForceError(estimate.intensity, applied_) : NAN;
}

Eigen::MatrixXd InverseModel::Compliance() const {
  Eigen::MatrixXd W(3 * static_cast<Eigen::Index>(markers_.size()), applied_.size());
  for (size_t i = 0; i < markers_.size(); ++i) {
    W.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = estimator_.Compliance(markers_[i]);
  }
  return W;
}

}  // namespace softforce::validation
