#include "estimation/robust_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

namespace softforce::estimation {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A block as a function of the free parameters alone.
class LinearCost : public ceres::CostFunction {
 public:
  LinearCost(Eigen::VectorXd at_zero, RowMajor J) : at_zero_(std::move(at_zero)), J_(std::move(J)) {
    set_num_residuals(static_cast<int>(J_.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(J_.cols()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], J_.cols());
    Eigen::Map<Eigen::VectorXd> result(residuals, J_.rows());
    result = at_zero_;
    result.noalias() += J_ * theta;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], J_.rows(), J_.cols()) = J_;
    }
    return true;
  }

 private:
  Eigen::VectorXd at_zero_;  // residual where the free parameters are zero
  RowMajor J_;
};

// The minimum over the parameters in `free`, the others staying as they are in `theta`.
bool MinimiseOver(const std::vector<int>& free, const std::vector<ResidualBlock>& blocks,
                  const Eigen::VectorXd& theta0, double loss_scale, Eigen::VectorXd* theta) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::HuberLoss loss(loss_scale);
  ceres::Problem problem(ownership);
  Eigen::VectorXd held = *theta - theta0;
  held(free).setZero();
  // Newtons, metres and pascals differ by orders of magnitude.
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(static_cast<int>(free.size()));
  for (const ResidualBlock& block : blocks) {
    scale += block.J(Eigen::all, free).colwise().squaredNorm();
  }
  scale = (scale.array() > 0).select(scale.cwiseSqrt().cwiseInverse(), 1.0);
  Eigen::VectorXd x = (*theta - theta0)(free).cwiseQuotient(scale);
  for (const ResidualBlock& block : blocks) {
    problem.AddResidualBlock(new LinearCost(block.residual + block.J * held,
                                            block.J(Eigen::all, free) * scale.asDiagonal()),
                             block.robust ? &loss : nullptr, x.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.initial_trust_region_radius = 1e16;  // Gauss–Newton: the problem is linear but for ρ
  options.max_trust_region_radius = 1e20;
  options.jacobi_scaling = false;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.gradient_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  (*theta)(free) = theta0(free) + x.cwiseProduct(scale);
  return summary.IsSolutionUsable() && x.allFinite();
}

double Weight(const ResidualBlock& block, const Eigen::VectorXd& residual, double loss_scale) {
  const double norm = residual.norm();
  return block.robust && norm > loss_scale ? loss_scale / norm : 1;
}

Eigen::VectorXd Gradient(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& change,
                         double loss_scale) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(change.size());
  for (const ResidualBlock& block : blocks) {
    const Eigen::VectorXd residual = block.residual + block.J * change;
    gradient += Weight(block, residual, loss_scale) * block.J.transpose() * residual;
  }
  return gradient;
}

std::vector<int> FreeOnes(const std::vector<char>& at_bound) {
  std::vector<int> free;
  for (size_t i = 0; i < at_bound.size(); ++i) {
    if (at_bound[i] == 0) free.push_back(static_cast<int>(i));
  }
  return free;
}

// Goes from one place within the bounds towards another, up to the first bound in the way, which
// becomes active. False if there is none.
bool StopAtBound(const Bounds& bounds, const std::vector<int>& free, const Eigen::VectorXd& from,
                 Eigen::VectorXd* to, std::vector<char>* at_bound) {
  double share = 1;
  int hit = -1;
  for (const int i : free) {
    const double bound = (*to)(i) < bounds.lower(i) ? bounds.lower(i) : bounds.upper(i);
    if ((*to)(i) >= bounds.lower(i) && (*to)(i) <= bounds.upper(i)) continue;
    const double reach = (bound - from(i)) / ((*to)(i)-from(i));
    if (hit >= 0 && reach >= share) continue;
    share = std::clamp(reach, 0.0, 1.0);
    hit = i;
  }
  if (hit < 0) return false;
  const double bound = (*to)(hit) < bounds.lower(hit) ? bounds.lower(hit) : bounds.upper(hit);
  *to = from + share * (*to - from);
  (*to)(hit) = bound;
  (*at_bound)[hit] = 1;
  return true;
}

// Lets go of the bound that holds the fit back most; false if none does.
bool ReleaseBound(const Bounds& bounds, const Eigen::VectorXd& theta,
                  const Eigen::VectorXd& gradient, const Eigen::VectorXd& curvature,
                  std::vector<char>* at_bound) {
  constexpr double kLeast = 1e-12;  // of a whitened residual
  int best = -1;
  double most = kLeast;
  for (int i = 0; i < theta.size(); ++i) {
    if ((*at_bound)[i] == 0 || bounds.lower(i) == bounds.upper(i)) continue;
    const double inward = theta(i) == bounds.lower(i) ? -gradient(i) : gradient(i);
    const double gain = inward / std::sqrt(std::max(curvature(i), 1e-300));
    if (gain > most) {
      most = gain;
      best = i;
    }
  }
  if (best >= 0) (*at_bound)[best] = 0;
  return best >= 0;
}

}  // namespace

double RobustCost(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& theta0,
                  const Eigen::VectorXd& theta, double loss_scale) {
  double cost = 0;
  for (const ResidualBlock& block : blocks) {
    const double norm = (block.residual + block.J * (theta - theta0)).norm();
    const bool linear = block.robust && norm > loss_scale;
    cost += linear ? loss_scale * norm - 0.5 * loss_scale * loss_scale : 0.5 * norm * norm;
  }
  return cost;
}

RobustFit FitRobustly(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& theta0,
                      const Eigen::VectorXd& start, const Bounds& bounds, double loss_scale) {
  const int n = static_cast<int>(theta0.size());
  RobustFit fit{false, start, 0, std::vector<char>(n, 0)};
  Eigen::VectorXd curvature = Eigen::VectorXd::Zero(n);
  for (const ResidualBlock& block : blocks) curvature += block.J.colwise().squaredNorm();
  for (int i = 0; i < n; ++i) {
    fit.at_bound[i] = start(i) <= bounds.lower(i) || start(i) >= bounds.upper(i);
  }
  // Every change of the active set lowers the cost or adds a bound: it ends. The limit is for
  // rounding alone.
  for (int change = 0; change < 20 * (n + 1); ++change) {
    const std::vector<int> free = FreeOnes(fit.at_bound);
    Eigen::VectorXd trial = fit.parameters;
    if (!free.empty() && !MinimiseOver(free, blocks, theta0, loss_scale, &trial)) return fit;
    const bool stopped = StopAtBound(bounds, free, fit.parameters, &trial, &fit.at_bound);
    fit.parameters = trial;
    if (stopped) continue;
    const Eigen::VectorXd gradient = Gradient(blocks, fit.parameters - theta0, loss_scale);
    if (!ReleaseBound(bounds, fit.parameters, gradient, curvature, &fit.at_bound)) {
      fit.ok = true;
      break;
    }
  }
  fit.cost = RobustCost(blocks, theta0, fit.parameters, loss_scale);
  return fit;
}

}  // namespace softforce::estimation
