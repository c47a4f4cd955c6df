#include "estimation/loaded_body.h"

#include <algorithm>
#include <limits>

namespace softforce::estimation {

LoadedBody::LoadedBody(fem::StaticSolver* solver, const std::vector<ForceSite>& sites,
                       const std::vector<ActuatorUncertainty>& actuators, double max_staleness)
    : solver_(solver), max_staleness_(max_staleness) {
  int components = 0;
  for (const ForceSite& site : sites) components += static_cast<int>(site.directions.cols());
  H_f_ = Eigen::MatrixXd::Zero(3 * solver->body().mesh.num_nodes(), components);
  int first = 0;
  for (const ForceSite& site : sites) {
    const auto directions = static_cast<int>(site.directions.cols());
    for (size_t i = 0; i < site.at.nodes.size(); ++i) {
      H_f_.block(3 * site.at.nodes[i], first, 3, directions) = site.at.weights[i] * site.directions;
    }
    first += directions;
  }
  for (int a = 0; a < static_cast<int>(actuators.size()); ++a) {
    if (actuators[a] > 0) uncertain_.push_back(a);
  }
  pose_ = {solver->AtRest(), Eigen::VectorXd::Zero(num_loads())};
}

fem::LoadCase LoadedBody::LoadOf(const Eigen::VectorXd& loads, const fem::Actuation& told) const {
  fem::LoadCase load{(H_f_ * loads.head(num_components())).reshaped(3, H_f_.rows() / 3), told};
  const int cables = static_cast<int>(told.cables.size());
  for (size_t i = 0; i < uncertain_.size(); ++i) {
    const int a = uncertain_[i];
    const double change = loads(num_components() + static_cast<int>(i));
    double& value =
        a < cables ? load.actuation.cables[a].value : load.actuation.pressures[a - cables];
    value += change;
    const bool tension = a < cables && told.cables[a].input == fem::CableInput::kTension;
    if (tension) value = std::max(0.0, value);
  }
  return load;
}

bool LoadedBody::IsTold(const fem::Actuation& told) const {
  const fem::LoadCase load = LoadOf(pose_.loads, told);
  const fem::LoadCase& now = pose_.state.load;
  const auto same = [](const fem::CableCommand& a, const fem::CableCommand& b) {
    return a.input == b.input && a.value == b.value;
  };
  return now.weight_share == load.weight_share &&
         now.actuation.pressures == load.actuation.pressures &&
         std::equal(now.actuation.cables.begin(), now.actuation.cables.end(),
                    load.actuation.cables.begin(), load.actuation.cables.end(), same);
}

bool LoadedBody::IsAt(const Eigen::VectorXd& loads, const fem::Actuation& told) const {
  return loads == pose_.loads && IsTold(told) && IsResponseFresh();
}

// Broyden's update: the response becomes right for the change of loads that has just been made,
// and stays as it was for all others. Loads count by how far they move the body.
void LoadedBody::LearnFrom(const Pose& before, const Eigen::VectorXd& change, double tolerance) {
  const Eigen::VectorXd moved = (pose_.state.u - before.state.u).reshaped();
  const Eigen::VectorXd missed = moved - response_ * change;
  constexpr double kClear = 10;  // tolerances: smaller movements are not known well enough
  if (!(moved.cwiseAbs().maxCoeff() > kClear * tolerance)) return;
  constexpr double kTooMuch = 0.5;  // of the movement: there is nothing left to correct
  if (missed.norm() > kTooMuch * moved.norm()) {
    ForgetResponse();
    return;
  }
  const Eigen::VectorXd weighted =
      response_.colwise().squaredNorm().transpose().cwiseProduct(change);
  response_ += missed * weighted.transpose() / weighted.dot(change);
}

fem::SolveSummary LoadedBody::Move(const Eigen::VectorXd& loads, const fem::Actuation& told,
                                   double tolerance, bool continued,
                                   std::optional<int> max_load_halvings) {
  // A small change starts from the linear answer; Newton's method does the rest. Over a large one
  // the linear answer stretches what should turn, and the old shape is the better start.
  Pose trial = pose_;
  const Eigen::VectorXd change = loads - pose_.loads;
  const bool told_alike = IsTold(told);
  const bool predicted = response_u_.cols() == trial.state.u.cols() && !change.isZero(0) &&
                         MoveBy(change) <= max_staleness_;
  if (predicted) trial.state.u += (response_ * change).reshaped(3, trial.state.u.cols());
  const fem::LoadCase load = LoadOf(loads, told);
  fem::SolveSummary summary =
      solver_->Approach(load, tolerance, continued, &trial.state, max_load_halvings);
  factorisations_ += summary.factorisations;
  if (!summary.ok() && predicted) {
    trial = pose_;
    summary = solver_->Approach(load, tolerance, false, &trial.state, max_load_halvings);
    factorisations_ += summary.factorisations;
  }
  if (!summary.ok()) return summary;
  trial.loads = loads;
  std::swap(pose_, trial);
  if (predicted && told_alike) LearnFrom(trial, change, tolerance);
  if (!RefreshResponse()) {
    std::swap(pose_, trial);
    summary.status = fem::SolveSummary::Status::kUnstable;
  }
  return summary;
}

bool LoadedBody::IsResponseFresh() const {
  const Eigen::Array<bool, Eigen::Dynamic, 1> taut = pose_.state.tension.array() > 0;
  return response_u_.cols() == pose_.state.u.cols() && (taut == response_taut_).all() &&
         (pose_.state.u - response_u_).colwise().squaredNorm().maxCoeff() <=
             max_staleness_ * max_staleness_;
}

bool LoadedBody::RefreshResponse() { return IsResponseFresh() || ComputeResponse(max_staleness_); }

bool LoadedBody::RenewResponse() { return ComputeResponse(0); }

bool LoadedBody::ComputeResponse(double max_staleness) {
  fem::Sensitivity to_forces = solver_->Solve(pose_.state, H_f_, max_staleness);
  if (!to_forces.ok) return false;
  tangent_response_.resize(H_f_.rows(), num_loads());
  tangent_response_.leftCols(num_components()) = to_forces.du;
  tension_response_.resize(to_forces.d_tension.rows(), num_loads());
  tension_response_.leftCols(num_components()) = to_forces.d_tension;
  if (!uncertain_.empty()) {
    const fem::Sensitivity to_commands = solver_->SolveActuation(pose_.state, max_staleness);
    if (!to_commands.ok) return false;
    const auto commands = static_cast<int>(uncertain_.size());
    tangent_response_.rightCols(commands) = to_commands.du(Eigen::all, uncertain_);
    tension_response_.rightCols(commands) = to_commands.d_tension(Eigen::all, uncertain_);
  }
  response_ = tangent_response_;
  response_u_ = pose_.state.u;
  response_taut_ = pose_.state.tension.array() > 0;
  return true;
}

bool LoadedBody::StepLinearly(const Eigen::VectorXd& loads, const fem::Actuation& told) {
  // The step factorises the tangent at the pose, from which the response there then follows.
  Pose trial = pose_;
  if (!solver_->LinearStep(LoadOf(loads, told), &trial.state)) return false;
  ++factorisations_;
  ForgetResponse();
  const bool fresh = RefreshResponse();
  trial.loads = loads;
  if (fresh) pose_ = trial;
  return fresh;
}

void LoadedBody::Shift(const Eigen::VectorXd& loads, const fem::Actuation& told) {
  const Eigen::VectorXd change = loads - pose_.loads;
  pose_.state.u += (tangent_response_ * change).reshaped(3, pose_.state.u.cols());
  pose_.state.tension += tension_response_ * change;
  pose_.loads = loads;
  pose_.state.load = LoadOf(loads, told);
}

Eigen::Vector3d LoadedBody::Position(const mesh::NodalWeights& at) const {
  return at.Apply(solver_->body().mesh.nodes) + at.Apply(pose_.state.u);
}

Eigen::Matrix3Xd LoadedBody::Response(const mesh::NodalWeights& at, Of of) const {
  const Eigen::MatrixXd& response = of == Of::kStep ? response_ : tangent_response_;
  Eigen::Matrix3Xd W = Eigen::Matrix3Xd::Zero(3, num_loads());
  for (size_t i = 0; i < at.nodes.size(); ++i) {
    W += at.weights[i] * response.middleRows<3>(3 * at.nodes[i]);
  }
  return W;
}

double LoadedBody::MoveBy(const Eigen::VectorXd& change) const {
  const Eigen::Matrix3Xd du = (response_ * change).reshaped(3, response_.rows() / 3);
  return du.colwise().norm().maxCoeff();
}

}  // namespace softforce::estimation
