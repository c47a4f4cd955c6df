#include "estimation/identification_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "estimation/shared_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

constexpr int kTwist = 6;

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

Eigen::VectorXd IdentificationFit::PriorWeights() const {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(num_parameters_);
  for (Eigen::Index p = 0; p < guess_.size(); ++p) {
    weights(p) = std::isfinite(prior_sd_(p)) ? guess_(p) / prior_sd_(p) : 0;
  }
  return weights;
}

double IdentificationFit::ChiSquare(const Eigen::VectorXd& parameters) const {
  double chi2 = PriorWeights().cwiseProduct(parameters).squaredNorm();
  for (const Block& block : blocks_) chi2 += Residuals(block, parameters).squaredNorm();
  return chi2;
}

Eigen::MatrixXd IdentificationFit::Information(const Eigen::VectorXd& parameters,
                                               bool with_loss) const {
  Eigen::MatrixXd information = PriorWeights().cwiseAbs2().asDiagonal();
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
