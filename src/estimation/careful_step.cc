// Steps of Gauss–Newton over movements that are too large for the linear answer.
#include <algorithm>
#include <cmath>

#include "estimation/force_estimator_state.h"

namespace softforce::estimation {

// A soft body that turns far seems to be shortened by its linear answer, which stretches what
// should turn: by about move²/(2 diagonal). Only forces along its stiff axes can explain that, and
// such as would make it buckle. So each observation is given that error, and the loads stay close
// to what they are: within the force that moves the softest place as far (an actuator: by what
// moves the body as far). Over small movements nothing changes.
Eigen::VectorXd ForceEstimator::State::CarefulStep(const std::vector<WhitenedObservation>& used,
                                                   const std::vector<ResidualBlock>& blocks,
                                                   const Eigen::VectorXd& parameters,
                                                   const Eigen::VectorXd& step,
                                                   const Bounds& bounds) const {
  // A share of the diagonal: beyond it even the careful step leads astray.
  constexpr double kFarthest = 0.1;
  const int n = num_loads();
  if (n == 0) return step;
  const double move = std::min(body.MoveBy(step.head(n)), diagonal);
  const double error = move * move / (2 * diagonal);
  double sd = INFINITY;
  for (const WhitenedObservation& seen : used) sd = std::min(sd, seen.sd);
  if (error <= sd) return step;

  std::vector<ResidualBlock> softened = blocks;
  for (size_t i = 0; i < used.size(); ++i) {
    const Eigen::VectorXd share =
        (1 + error * error * used[i].whitening.rowwise().squaredNorm().array()).rsqrt();
    softened[i].residual = share.asDiagonal() * softened[i].residual;
    softened[i].J = share.asDiagonal() * softened[i].J;
  }
  Eigen::VectorXd reach(n);  // m per unit of load
  for (int i = 0; i < n; ++i) reach(i) = body.MoveBy(Eigen::VectorXd::Unit(n, i));
  if (num_components() > 0) {
    reach.head(num_components()).setConstant(reach.head(num_components()).maxCoeff());
  }
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, parameters.size());
  J.leftCols(n) = (reach / move).asDiagonal();
  softened.push_back({Eigen::VectorXd::Zero(n), J, false});
  const RobustFit fit = FitRobustly(softened, parameters, parameters, bounds, options.loss_scale);
  if (!fit.ok) return step;
  const Eigen::VectorXd careful = fit.parameters - parameters;
  return std::min(1.0, kFarthest * diagonal / body.MoveBy(careful.head(n))) * careful;
}

}  // namespace softforce::estimation
