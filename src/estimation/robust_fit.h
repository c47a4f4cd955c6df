#pragma once

#include <Eigen/Core>
#include <vector>

namespace softforce::estimation {

// Whitened residuals that are linear in the parameters: residual + J (θ − θ0), at most a few rows.
struct ResidualBlock {
  Eigen::VectorXd residual;  // at θ0
  Eigen::MatrixXd J;         // a column per parameter
  bool robust = true;        // Huber's loss, else the plain square
};

struct Bounds {
  Eigen::VectorXd lower, upper;  // per parameter; ∓ infinity for none
};

struct RobustFit {
  bool ok = false;
  Eigen::VectorXd parameters;
  double cost = 0;             // half of the sum of the losses there
  std::vector<char> at_bound;  // per parameter: held there by the bound
};

// Minimises ½ Σ ρ(|residual|²) over the parameters within their bounds: by Ceres on the parameters
// that are free, and the active-set method (Nocedal & Wright, Numerical Optimization, 2nd ed.,
// 16.5) on the bounds. ρ is Huber's, linear beyond a norm of `loss_scale`. Convex, so the start
// matters for the time alone; it must lie within the bounds.
RobustFit FitRobustly(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& theta0,
                      const Eigen::VectorXd& start, const Bounds& bounds, double loss_scale);

// ½ Σ ρ at θ.
double RobustCost(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& theta0,
                  const Eigen::VectorXd& theta, double loss_scale);

}  // namespace softforce::estimation
