// What the observations say of the loads: whether they tell them apart, and how well.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/force_estimator_state.h"

namespace softforce::estimation {
namespace {

Eigen::MatrixXd Stack(const std::vector<ResidualBlock>& blocks, bool observations_only) {
  int rows = 0;
  for (const ResidualBlock& block : blocks) {
    if (block.robust || !observations_only) rows += static_cast<int>(block.J.rows());
  }
  Eigen::MatrixXd J(rows, blocks.empty() ? 0 : blocks.front().J.cols());
  int row = 0;
  for (const ResidualBlock& block : blocks) {
    if (!block.robust && observations_only) continue;
    J.middleRows(row, block.J.rows()) = block.J;
    row += static_cast<int>(block.J.rows());
  }
  return J;
}

}  // namespace

bool ForceEstimator::State::AreLoadsObservable(const std::vector<ResidualBlock>& blocks,
                                               ForceEstimate* estimate) const {
  using Status = ForceEstimate::Status;
  const int n = num_loads();
  if (n == 0 || std::isfinite(options.force_scale)) return true;
  // What the observations say by themselves, the offset being known. An actuator that is known
  // somewhat counts as observed by that.
  Eigen::MatrixXd J = Stack(blocks, true).leftCols(n);
  const auto measured = J.rows();
  // Newtons, metres and pascals side by side: each actuator's column as large as the largest
  // force's.
  const double largest =
      num_components() > 0 ? J.leftCols(num_components()).colwise().norm().maxCoeff() : 1;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  int prior_rows = 0;
  for (int i = num_components(); i < n; ++i) {
    const double norm = J.col(i).norm();
    if (norm > 0 && largest > 0) scale(i) = largest / norm;
    if (std::isfinite(actuators[body.uncertain()[i - num_components()]])) ++prior_rows;
  }
  J = J * scale.asDiagonal();
  J.conservativeResize(measured + prior_rows, n);
  J.bottomRows(prior_rows).setZero();
  int row = static_cast<int>(measured);
  for (int i = num_components(); i < n; ++i) {
    const double sd = actuators[body.uncertain()[i - num_components()]];
    if (std::isfinite(sd)) J(row++, i) = scale(i) / sd;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(J.transpose() * J);
  const double strongest = std::sqrt(std::max(0.0, spectrum.eigenvalues()(n - 1)));
  Eigen::VectorXd unseen = Eigen::VectorXd::Zero(n);
  int count = 0;
  for (int i = 0; i < n; ++i) {
    const double strength = std::sqrt(std::max(0.0, spectrum.eigenvalues()(i)));
    if (strength > options.min_singular_ratio * strongest && i >= n - J.rows()) continue;
    unseen += spectrum.eigenvectors().col(i).cwiseAbs2();
    ++count;
  }
  if (count == 0) return true;
  const bool too_few = J.rows() < n;  // Theorem 2
  estimate->status = too_few ? Status::kTooFewObservations : Status::kUnobservable;
  const std::string names = NamesIn(unseen.cwiseSqrt());
  estimate->reason = too_few ? fmt::format(
                                   "{} measured coordinates for {} unknowns; they cannot "
                                   "tell apart: {}",
                                   measured, n, names)
                             : "the markers in view cannot tell apart: " + names;
  return false;
}

void ForceEstimator::State::Conclude(const std::vector<ResidualBlock>& blocks,
                                     const Eigen::VectorXd& parameters,
                                     ForceEstimate* estimate) const {
  const int n = num_components();
  const Eigen::MatrixXd J = Stack(blocks, false);
  // Newtons and metres differ by orders of magnitude: scale the columns before inverting.
  const Eigen::VectorXd scale = J.colwise().norm().cwiseInverse();
  const Eigen::MatrixXd scaled = J * scale.asDiagonal();
  const Eigen::MatrixXd covariance =
      scale.asDiagonal() * (scaled.transpose() * scaled).inverse() * scale.asDiagonal();
  estimate->intensity = parameters.head(n);
  estimate->covariance = covariance.topLeftCorner(n, n);
  SetActuators(body, static_cast<int>(actuators.size()), parameters.head(num_loads()), covariance,
               estimate);
  estimate->offset = {parameters.segment<3>(num_loads()), parameters.tail<3>()};
  estimate->status = ForceEstimate::Status::kOk;
}

void SetActuators(const LoadedBody& body, int num_actuators, const Eigen::VectorXd& loads,
                  const Eigen::MatrixXd& covariance, ForceEstimate* estimate) {
  estimate->actuator_change = estimate->actuator_sd = Eigen::VectorXd::Zero(num_actuators);
  for (int i = body.num_components(); i < body.num_loads(); ++i) {
    const int a = body.uncertain()[i - body.num_components()];
    estimate->actuator_change(a) = loads(i);
    estimate->actuator_sd(a) = std::sqrt(covariance(i, i));
  }
}

}  // namespace softforce::estimation
