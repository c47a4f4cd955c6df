#include "estimation/equilibrium_problem.h"

#include <ceres/ceres.h>

#include "softforce/geometry/rigid.h"

namespace softforce::estimation {
namespace {

constexpr int kOffset = 6;  // parameters of the rigid offset, after the intensities

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Moves the body before Ceres evaluates any residual at a new point.
class EquilibriumCallback : public ceres::EvaluationCallback {
 public:
  EquilibriumCallback(const BodyResponse& body, const Eigen::VectorXd& parameters)
      : body_(body), parameters_(parameters) {}

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool new_evaluation_point) override {
    if (new_evaluation_point) reached_ = body_.move(parameters_.head(parameters_.size() - kOffset));
  }
  bool reached() const { return reached_; }

 private:
  const BodyResponse& body_;
  const Eigen::VectorXd& parameters_;  // Ceres keeps the point it evaluates here
  bool reached_ = false;
};

class MarkerCost : public ceres::CostFunction {
 public:
  MarkerCost(const WhitenedObservation& seen, const BodyResponse& body, const OffsetPrior& prior,
             const EquilibriumCallback& callback, int num_parameters)
      : seen_(seen), body_(body), prior_(prior), callback_(callback) {
    set_num_residuals(static_cast<int>(seen.whitening.rows()));
    mutable_parameter_block_sizes()->push_back(num_parameters);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    if (!callback_.reached()) return false;  // Ceres tries a shorter step
    const int n = parameter_block_sizes()[0];
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
        seen_.whitening * Misfit(body_, prior_, *seen_.observation,
                                 Eigen::Map<const Eigen::VectorXd>(parameters[0], n));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], num_residuals(), n) =
          seen_.whitening * ParameterJacobian(body_, prior_, *seen_.observation);
    }
    return true;
  }

 private:
  const WhitenedObservation& seen_;
  const BodyResponse& body_;
  const OffsetPrior& prior_;
  const EquilibriumCallback& callback_;
};

class OffsetCost : public ceres::CostFunction {
 public:
  OffsetCost(const OffsetPrior& prior, int num_parameters) : prior_(prior) {
    set_num_residuals(kOffset);
    mutable_parameter_block_sizes()->push_back(num_parameters);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const int n = parameter_block_sizes()[0];
    const Eigen::Map<const geometry::Vector6d> offset(parameters[0] + n - kOffset);
    Eigen::Map<geometry::Vector6d> whitened(residuals);
    whitened = prior_.whitening * offset;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor> jacobian(jacobians[0], kOffset, n);
      jacobian.setZero();
      jacobian.rightCols<kOffset>() = prior_.whitening;
    }
    return true;
  }

 private:
  const OffsetPrior& prior_;
};

// Ends when a step lowers the cost, which is half of χ², by so little that it cannot matter:
// residuals are whitened, so this is a share of the parameters' own standard deviations, whatever
// the size of the misfit that remains.
class NegligibleStep : public ceres::IterationCallback {
 public:
  explicit NegligibleStep(double tolerance) : tolerance_(tolerance) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const bool negligible =
        summary.iteration > 0 && summary.step_is_successful && summary.cost_change < tolerance_;
    return negligible ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  double tolerance_;
};

}  // namespace

Eigen::Matrix3Xd ParameterJacobian(const BodyResponse& body, const OffsetPrior& prior,
                                   const Observation& observation) {
  const Eigen::Matrix3Xd W = body.compliance(observation.at);
  Eigen::Matrix3Xd J(3, W.cols() + kOffset);
  J.leftCols(W.cols()) = W;
  J.middleCols<3>(W.cols()).setIdentity();
  J.rightCols<3>() = -geometry::Skew(body.position(observation.at) - prior.centre);
  return J;
}

Eigen::Vector3d Misfit(const BodyResponse& body, const OffsetPrior& prior,
                       const Observation& observation, const Eigen::VectorXd& parameters) {
  const Eigen::Vector3d model = body.position(observation.at);
  const Eigen::Vector3d translation = parameters.tail<kOffset>().head<3>();
  const Eigen::Vector3d rotation = parameters.tail<3>();
  return model + translation - geometry::Skew(model - prior.centre) * rotation +
         observation.offset - observation.position;
}

FitResult FitParameters(const std::vector<WhitenedObservation>& observations,
                        const Eigen::VectorXd& start, const OffsetPrior& prior,
                        const BodyResponse& body, const EstimatorOptions& options) {
  FitResult result;
  result.parameters = start;
  const int num_parameters = static_cast<int>(start.size());
  EquilibriumCallback callback(body, result.parameters);

  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &callback;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::HuberLoss loss(options.loss_scale);
  ceres::Problem problem(problem_options);
  for (const WhitenedObservation& seen : observations) {
    problem.AddResidualBlock(new MarkerCost(seen, body, prior, callback, num_parameters), &loss,
                             result.parameters.data());
  }
  problem.AddResidualBlock(new OffsetCost(prior, num_parameters), nullptr,
                           result.parameters.data());

  ceres::Solver::Options solver_options;
  solver_options.linear_solver_type = ceres::DENSE_QR;
  solver_options.initial_trust_region_radius = 1e12;  // Gauss–Newton unless a step fails
  solver_options.max_num_iterations = options.max_iterations;
  NegligibleStep negligible_step(options.cost_tolerance);
  solver_options.callbacks.push_back(&negligible_step);
  solver_options.function_tolerance = 1e-12;
  solver_options.parameter_tolerance = 1e-10;
  solver_options.gradient_tolerance = 1e-14;
  solver_options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options, &problem, &summary);

  result.converged =
      summary.IsSolutionUsable() && summary.termination_type != ceres::NO_CONVERGENCE;
  result.iterations = static_cast<int>(summary.iterations.size());
  result.message = summary.message;
  return result;
}

}  // namespace softforce::estimation
