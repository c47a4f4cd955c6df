// The paper's estimator, one linear step per frame (IV.B, eqs. 3–13).
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "estimation/force_estimator_state.h"

namespace softforce::estimation {

// The body first takes its step under the last forces and the new actuation: δ_free of eqs. 3
// and 4. Then the change of the forces follows from eq. 9, with the actuation as equality (11 or
// 12) or, if uncertain, unknown (Remark 3), and moves the body along its compliance (6).
ForceEstimate ForceEstimator::State::StepLinearly(const std::vector<Observation>& observations,
                                                  const fem::Actuation& told) {
  using Status = ForceEstimate::Status;
  ForceEstimate estimate;
  estimate.rejected.assign(observations.size(), 0);
  const Bounds all_bounds = ParameterBounds(told);
  const Bounds bounds{all_bounds.lower.head(num_loads()), all_bounds.upper.head(num_loads())};
  const Eigen::VectorXd loads = AllowedLoads(all_bounds);
  if (!body.StepLinearly(loads, told)) {
    estimate.status = Status::kNotConverged;
    estimate.reason = "the tangent at the last frame's shape is not positive definite";
    return estimate;
  }
  std::vector<ResidualBlock> blocks;
  double measured_variance = 0;  // m², sum
  for (size_t i = 0; i < observations.size(); ++i) {
    const Observation& seen = observations[i];
    estimate.rejected[i] = !IsPossible(seen);
    if (estimate.rejected[i]) continue;
    // Directions that are measured count alike, whatever their noise.
    const Eigen::Matrix3d information = seen.whitening.transpose() * seen.whitening;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);  // ascending
    const auto rows = seen.whitening.rows();
    const Eigen::MatrixXd measured = axes.eigenvectors().rightCols(rows).transpose();
    measured_variance += 1 / axes.eigenvalues()(2);
    blocks.push_back({measured * (body.Position(seen.at) + seen.offset - seen.position),
                      measured * body.Response(seen.at, LoadedBody::Of::kTangent)});
  }
  estimate.iterations = 1;
  if (!AreLoadsObservable(blocks, &estimate)) return estimate;
  // Metres: no misfit is so large that the loss would be linear.
  const RobustFit fit = FitRobustly(blocks, loads, loads, bounds, 1e3 * kAbsurdDistance * diagonal);
  if (!fit.ok) {
    estimate.status = Status::kNotConverged;
    estimate.reason = "the least-squares step has no solution";
    return estimate;
  }
  body.Shift(fit.parameters, told);

  // What the misfit that is left says of the noise, the same for every coordinate; without any,
  // what the measurements themselves say.
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(num_loads(), num_loads());
  int rows = 0;
  for (const ResidualBlock& block : blocks) {
    information += block.J.transpose() * block.J;
    rows += static_cast<int>(block.residual.size());
  }
  estimate.degrees_of_freedom = rows - num_loads();
  const double variance = estimate.degrees_of_freedom > 0
                              ? 2 * fit.cost / estimate.degrees_of_freedom
                              : measured_variance / static_cast<double>(blocks.size());
  estimate.chi2 = estimate.degrees_of_freedom;  // by that choice of the noise
  const Eigen::MatrixXd covariance = variance * information.inverse();
  estimate.intensity = fit.parameters.head(num_components());
  estimate.covariance = covariance.topLeftCorner(num_components(), num_components());
  SetActuators(body, static_cast<int>(actuators.size()), fit.parameters, covariance, &estimate);
  estimate.status = Status::kOk;
  return estimate;
}

}  // namespace softforce::estimation
