// What goes into a fit besides the observations, and what comes out of it: the offset's prior, the
// misfits, the covariance.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/equilibrium_problem.h"
#include "softforce/estimation/force_estimator.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

constexpr double kOffsetFloor = 1e-9;  // m; far below what any camera sees

}  // namespace

OffsetPrior ForceEstimator::MakeOffsetPrior(const std::vector<WhitenedObservation>& observations,
                                            double model_sd) const {
  const Eigen::Matrix3Xd& X = solver_->body().mesh.nodes;
  OffsetPrior prior;
  prior.centre.setZero();
  for (const WhitenedObservation& seen : observations) {
    prior.centre += seen.observation->at.Apply(X) / static_cast<double>(observations.size());
  }
  double extent = 0;  // m, root mean square distance from the centre
  for (const WhitenedObservation& seen : observations) {
    extent += (seen.observation->at.Apply(X) - prior.centre).squaredNorm() /
              static_cast<double>(observations.size());
  }
  extent = std::sqrt(extent);

  // The rig's place, carried from the robot's origin to the centre.
  geometry::Matrix6d to_centre = geometry::Matrix6d::Identity();
  to_centre.topRightCorner<3, 3>() = -geometry::Skew(prior.centre);
  geometry::Matrix6d P = to_centre * registration_covariance_ * to_centre.transpose();
  // The model's common error moves the points about as far by turning as by shifting. The floor
  // keeps P regular.
  const double shift = std::hypot(model_sd, kOffsetFloor);
  const double turn = shift / std::max(extent, kOffsetFloor);
  P.diagonal().head<3>().array() += shift * shift;
  P.diagonal().tail<3>().array() += turn * turn;
  const geometry::Matrix6d L = P.llt().matrixL();
  prior.whitening = L.inverse();
  return prior;
}

int ForceEstimator::Assess(const std::vector<WhitenedObservation>& used, const OffsetPrior& prior,
                           const BodyResponse& body, const Eigen::VectorXd& parameters,
                           Eigen::MatrixXd* J, ForceEstimate* estimate) const {
  int worst = -1;
  double worst_excess = 1;
  estimate->chi2 = 0;
  int row = 0;
  for (int i = 0; i < static_cast<int>(used.size()); ++i) {
    const Observation& seen = *used[i].observation;
    const int k = static_cast<int>(used[i].whitening.rows());
    const double chi2 = (used[i].whitening * Misfit(body, prior, seen, parameters)).squaredNorm();
    J->middleRows(row, k) = used[i].whitening * ParameterJacobian(body, prior, seen);
    row += k;
    estimate->chi2 += chi2;
    const double excess = chi2 / geometry::ChiSquareQuantile(1 - options_.rejection_probability, k);
    if (excess > worst_excess) {
      worst_excess = excess;
      worst = i;
    }
  }
  J->bottomRows<6>().setZero();
  J->bottomRightCorner<6, 6>() = prior.whitening;
  return worst;
}

std::string ForceEstimator::SitesIn(const Eigen::VectorXd& combination) const {
  constexpr double kShare = 0.1;  // of a unit vector: smaller parts do not matter
  std::string names;
  for (int s = 0; s < static_cast<int>(sites_.size()); ++s) {
    const auto part = combination.segment(FirstComponent(s), sites_[s].directions.cols());
    if (part.norm() > kShare) names += (names.empty() ? "candidate " : ", ") + sites_[s].name;
  }
  return names;
}

void ForceEstimator::Conclude(const Eigen::MatrixXd& J, const Eigen::VectorXd& parameters,
                              ForceEstimate* estimate) const {
  const int n = num_components();
  // What the observations say of the forces by themselves, the offset being known.
  const Eigen::MatrixXd J_forces = J.topLeftCorner(J.rows() - 6, n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(J_forces.transpose() * J_forces);
  const double weakest = std::sqrt(std::max(0.0, spectrum.eigenvalues()(0)));
  const double strongest = std::sqrt(spectrum.eigenvalues()(n - 1));
  if (!(weakest > options_.min_singular_ratio * strongest)) {
    estimate->status = ForceEstimate::Status::kUnobservable;
    estimate->reason = "the markers in view cannot tell apart the forces at " +
                       SitesIn(spectrum.eigenvectors().col(0));
    return;
  }
  // Newtons and metres differ by orders of magnitude: scale the columns before inverting.
  const Eigen::VectorXd scale = J.colwise().norm().cwiseInverse();
  const Eigen::MatrixXd scaled = J * scale.asDiagonal();
  const Eigen::MatrixXd covariance =
      scale.asDiagonal() * (scaled.transpose() * scaled).inverse() * scale.asDiagonal();
  estimate->covariance = covariance.topLeftCorner(n, n);
  estimate->intensity = parameters.head(n);
  estimate->offset = {parameters.segment<3>(n), parameters.tail<3>()};
  estimate->status = ForceEstimate::Status::kOk;
}

}  // namespace softforce::estimation
