// The least-squares problem of an identification, solved by Ceres.
#include <ceres/ceres.h>

#include <cmath>
#include <utility>

#include "estimation/identification_fit.h"

namespace softforce::estimation {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Moves the body before Ceres evaluates any residual at a new point.
class MoveBody : public ceres::EvaluationCallback {
 public:
  MoveBody(ParametricBody* body, const IdentificationFit& fit, const Eigen::VectorXd& parameters)
      : body_(body), fit_(fit), parameters_(parameters) {}

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool /*new_evaluation_point*/) override {
    reached_ = body_->MoveTo(fit_.Theta(parameters_));
  }
  bool reached() const { return reached_; }

 private:
  ParametricBody* body_;
  const IdentificationFit& fit_;
  const Eigen::VectorXd& parameters_;  // Ceres keeps the point it evaluates here
  bool reached_ = false;
};

// Ends the minimisation after the iteration in which it was asked to.
class EndWhenAsked : public ceres::IterationCallback {
 public:
  explicit EndWhenAsked(const std::atomic<bool>* asked) : asked_(asked) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return asked_ != nullptr && *asked_ ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::atomic<bool>* asked_;
};

class BlockCost : public ceres::CostFunction {
 public:
  BlockCost(const IdentificationFit& fit, const IdentificationFit::Block& block,
            const MoveBody& body)
      : fit_(fit), block_(block), body_(body) {
    set_num_residuals(static_cast<int>(block.whitening.rows()));
    mutable_parameter_block_sizes()->push_back(fit.num_parameters());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    if (!body_.reached()) return false;  // Ceres tries a shorter step
    const int n = fit_.num_parameters();
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
        fit_.Residuals(block_, Eigen::Map<const Eigen::VectorXd>(parameters[0], n));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], num_residuals(), n) = fit_.Jacobian(block_);
    }
    return true;
  }

 private:
  const IdentificationFit& fit_;
  const IdentificationFit::Block& block_;
  const MoveBody& body_;
};

// Each parameter divided by its prior's standard deviation, in the parameters' own scale.
class PriorCost : public ceres::CostFunction {
 public:
  explicit PriorCost(Eigen::VectorXd weights) : weights_(std::move(weights)) {
    set_num_residuals(static_cast<int>(weights_.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(weights_.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Index n = weights_.size();
    Eigen::Map<Eigen::VectorXd>(residuals, n) =
        weights_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(parameters[0], n));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], n, n) = weights_.asDiagonal();
    }
    return true;
  }

 private:
  Eigen::VectorXd weights_;
};

// Ends when a step changes the cost, which is half of χ², by so little that it cannot matter: the
// equilibria are not found more exactly than that.
class NegligibleStep : public ceres::IterationCallback {
 public:
  explicit NegligibleStep(double tolerance) : negligible_(0.5 * tolerance * tolerance) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const bool there = summary.iteration > 0 && summary.step_is_valid &&
                       std::abs(summary.cost_change) < negligible_;
    return there ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  double negligible_;
};

}  // namespace

IdentificationFit::Result IdentificationFit::Minimise(Eigen::VectorXd* parameters) {
  MoveBody move(body_, *this, *parameters);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &move;
  ceres::Problem problem(problem_options);
  for (const Block& block : blocks_) {
    problem.AddResidualBlock(new BlockCost(*this, block, move),
                             new ceres::HuberLoss(LossScale(block)), parameters->data());
  }
  problem.AddResidualBlock(new PriorCost(PriorWeights()), nullptr, parameters->data());
  for (int p = 0; p < body_->num_unknowns(); ++p) {
    if (!std::isfinite(body_->Lower(p))) continue;
    problem.SetParameterLowerBound(parameters->data(), p, body_->Lower(p) / guess_(p));
    problem.SetParameterUpperBound(parameters->data(), p, body_->Upper(p) / guess_(p));
  }

  ceres::Solver::Options solver_options;
  solver_options.linear_solver_type = ceres::DENSE_QR;
  // Gauss–Newton unless a step fails. Steps that go too far are refused before anything is solved.
  solver_options.initial_trust_region_radius = 1e4;
  solver_options.max_num_consecutive_invalid_steps = 100;
  solver_options.max_num_iterations = options_.estimator.max_iterations;
  NegligibleStep negligible_step(options_.tolerance);
  solver_options.callbacks.push_back(&negligible_step);
  EndWhenAsked end_when_asked(options_.stop);
  solver_options.callbacks.push_back(&end_when_asked);
  solver_options.function_tolerance = 1e-14;
  solver_options.parameter_tolerance = 1e-12;
  solver_options.gradient_tolerance = 1e-14;
  solver_options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options, &problem, &summary);

  Result result;
  result.converged =
      summary.IsSolutionUsable() && summary.termination_type != ceres::NO_CONVERGENCE;
  result.iterations = static_cast<int>(summary.iterations.size());
  return result;
}

}  // namespace softforce::estimation
