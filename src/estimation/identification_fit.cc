#include "estimation/identification_fit.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "estimation/shared_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

constexpr int kTwist = 6;

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

// Weights of the priors, in the parameters' own scale; 0 where nothing was known.
Eigen::VectorXd PriorWeights(const Eigen::VectorXd& guess, const Eigen::VectorXd& prior_sd,
                             int num_parameters) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(num_parameters);
  for (Eigen::Index p = 0; p < guess.size(); ++p) {
    weights(p) = std::isfinite(prior_sd(p)) ? guess(p) / prior_sd(p) : 0;
  }
  return weights;
}

}  // namespace

OffsetModel MakeOffsetModel(const PointCloud& cloud, const geometry::Matrix6d& registration) {
  OffsetModel offset;
  offset.about.centre = cloud.centre;
  offset.registration = OffsetCovariance(cloud, registration, 0).llt().matrixL();
  offset.model = OffsetCovariance(cloud, geometry::Matrix6d::Zero(), 1).llt().matrixL();
  return offset;
}

IdentificationFit::IdentificationFit(ParametricBody* body, const std::vector<KnownState>& states,
                                     const std::vector<std::vector<char>>& rejected,
                                     const OffsetModel& offset, const Eigen::VectorXd& guess,
                                     const Eigen::VectorXd& prior_sd,
                                     const IdentificationOptions& options)
    : body_(body),
      states_(states),
      rejected_(rejected),
      offset_(offset),
      guess_(guess),
      prior_sd_(prior_sd),
      options_(options) {
  for (const KnownState& state : states) {
    companions_.push_back(CountCompanions(state.observations));
  }
  num_parameters_ = body->num_unknowns() + kTwist * (1 + static_cast<int>(states.size()));
}

// As when forces are estimated: see Whiten.
double IdentificationFit::LocalError(int state, int number) const {
  return options_.estimator.local_model_error * displacements_[state] *
         std::sqrt(companions_[state][number]);
}

void IdentificationFit::SetDisplacements(const std::vector<double>& displacements) {
  displacements_ = displacements;
  offset_roots_.clear();
  for (int s = 0; s < static_cast<int>(states_.size()); ++s) {
    offset_roots_.push_back(OffsetRoot(s));
  }
  std::map<std::pair<int, int>, Block> by_point;  // group and point
  blocks_.clear();
  for (int s = 0; s < static_cast<int>(states_.size()); ++s) {
    for (int i = 0; i < static_cast<int>(states_[s].observations.size()); ++i) {
      if (rejected_[s][i]) continue;
      if (states_[s].points.empty()) {
        blocks_.push_back({{{s, i}}, {}});
      } else {
        by_point[{states_[s].group, states_[s].points[i]}].members.emplace_back(s, i);
      }
    }
  }
  for (auto& [key, block] : by_point) blocks_.push_back(std::move(block));
  for (Block& block : blocks_) {
    std::vector<const Observation*> sharing;
    std::vector<double> sd;
    for (const auto& [s, i] : block.members) {
      sharing.push_back(&states_[s].observations[i]);
      sd.push_back(LocalError(s, i));
    }
    block.whitening = SharedErrorWhitening(sharing, sd);
  }
}

int IdentificationFit::num_rows() const {
  int rows = 0;
  for (const Block& block : blocks_) rows += static_cast<int>(block.whitening.rows());
  return rows;
}

// The offset's covariance between two states is that of the smaller displacement: increments along
// the way are independent, see ErrorCorrelation.
Eigen::MatrixXd IdentificationFit::OffsetRoot(int state) const {
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(kTwist, num_parameters_ - body_->num_unknowns());
  root.leftCols<kTwist>() = offset_.registration;
  std::vector<std::pair<double, int>> before;  // displacement and number, up to this state
  for (int s = 0; s < static_cast<int>(states_.size()); ++s) {
    const std::pair<double, int> there{displacements_[s], s};
    if (states_[s].group == states_[state].group &&
        there <= std::make_pair(displacements_[state], state)) {
      before.push_back(there);
    }
  }
  std::sort(before.begin(), before.end());
  double last = 0;
  for (const auto& [displacement, s] : before) {
    const double increment = std::sqrt(std::max(0.0, displacement * displacement - last * last));
    root.middleCols<kTwist>(kTwist * (1 + s)) =
        options_.estimator.common_model_error * increment * offset_.model;
    last = displacement;
  }
  return root;
}

Eigen::VectorXd IdentificationFit::Theta(const Eigen::VectorXd& parameters) const {
  return guess_.cwiseProduct(parameters.head(guess_.size()));
}

RigidOffset IdentificationFit::Offset(int state, const Eigen::VectorXd& parameters) const {
  const geometry::Vector6d twist =
      offset_roots_[state] * parameters.tail(num_parameters_ - body_->num_unknowns());
  return {twist.head<3>(), twist.tail<3>()};
}

Eigen::Vector3d IdentificationFit::Misfit(int state, const Observation& seen,
                                          const Eigen::VectorXd& parameters) const {
  const RigidOffset offset = Offset(state, parameters);
  geometry::Vector6d twist;
  twist << offset.translation, offset.rotation;
  return estimation::Misfit(seen, body_->Position(state, seen.at), offset_.about, twist);
}

Eigen::VectorXd IdentificationFit::Residuals(const Block& block,
                                             const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd stacked(block.whitening.rows());
  Eigen::Index row = 0;
  for (const auto& [s, i] : block.members) {
    const Observation& seen = states_[s].observations[i];
    stacked.segment(row, seen.whitening.rows()) = seen.whitening * Misfit(s, seen, parameters);
    row += seen.whitening.rows();
  }
  return block.whitening * stacked;
}

Eigen::MatrixXd IdentificationFit::Jacobian(const Block& block) const {
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(block.whitening.rows(), num_parameters_);
  const int n = body_->num_unknowns();
  Eigen::Index row = 0;
  for (const auto& [s, i] : block.members) {
    const Observation& seen = states_[s].observations[i];
    auto rows = stacked.middleRows(row, seen.whitening.rows());
    // That the offset's turn moves with the body itself is of second order, and left out.
    rows.leftCols(n) = seen.whitening * body_->Jacobian(s, seen.at) * guess_.asDiagonal();
    rows.rightCols(num_parameters_ - n) =
        seen.whitening * OffsetJacobian(body_->Position(s, seen.at), offset_.about) *
        offset_roots_[s];
    row += seen.whitening.rows();
  }
  return block.whitening * stacked;
}

double IdentificationFit::LossScale(const Block& block) const {
  // `loss_scale` is meant for one observation of three rows; more rows are further from zero.
  return options_.estimator.loss_scale *
         std::sqrt(std::max(1.0, static_cast<double>(block.whitening.rows()) / 3));
}

IdentificationFit::Result IdentificationFit::Minimise(Eigen::VectorXd* parameters) {
  MoveBody move(body_, *this, *parameters);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &move;
  ceres::Problem problem(problem_options);
  for (const Block& block : blocks_) {
    problem.AddResidualBlock(new BlockCost(*this, block, move),
                             new ceres::HuberLoss(LossScale(block)), parameters->data());
  }
  problem.AddResidualBlock(new PriorCost(PriorWeights(guess_, prior_sd_, num_parameters_)), nullptr,
                           parameters->data());
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

double IdentificationFit::ChiSquare(const Eigen::VectorXd& parameters) const {
  double chi2 =
      PriorWeights(guess_, prior_sd_, num_parameters_).cwiseProduct(parameters).squaredNorm();
  for (const Block& block : blocks_) chi2 += Residuals(block, parameters).squaredNorm();
  return chi2;
}

Eigen::MatrixXd IdentificationFit::Information(const Eigen::VectorXd& parameters,
                                               bool with_loss) const {
  Eigen::MatrixXd information =
      PriorWeights(guess_, prior_sd_, num_parameters_).cwiseAbs2().asDiagonal();
  for (const Block& block : blocks_) {
    const Eigen::MatrixXd J = Jacobian(block);
    // A marker that the loss holds back says less.
    const double norm = Residuals(block, parameters).norm();
    const double weight = with_loss && norm > LossScale(block) ? LossScale(block) / norm : 1;
    information += weight * J.transpose() * J;
  }
  return information;
}

std::pair<int, int> IdentificationFit::MostImpossible(const Eigen::VectorXd& parameters) const {
  std::pair<int, int> worst{-1, -1};
  double worst_excess = 1;
  for (const Block& block : blocks_) {
    for (const auto& [s, i] : block.members) {
      const Observation& seen = states_[s].observations[i];
      const Eigen::MatrixXd whitening = SharedErrorWhitening({&seen}, {LocalError(s, i)});
      const double chi2 =
          (whitening * (seen.whitening * Misfit(s, seen, parameters))).squaredNorm();
      const double excess =
          chi2 / geometry::ChiSquareQuantile(1 - options_.estimator.rejection_probability,
                                             static_cast<int>(seen.whitening.rows()));
      if (excess > worst_excess) {
        worst_excess = excess;
        worst = {s, i};
      }
    }
  }
  return worst;
}

}  // namespace softforce::estimation
