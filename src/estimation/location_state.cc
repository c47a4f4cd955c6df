// The body and its observed points, for LocationEstimator.
#include "estimation/location_state.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/force_estimator_state.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {

LocationEstimator::State::State(fem::StaticSolver* solver_in, const mesh::Surface& surface,
                                std::vector<LocationCandidate> candidates_in,
                                const LocationOptions& options_in)
    : solver(solver_in),
      candidates(std::move(candidates_in)),
      options(options_in),
      faces(surface, solver_in->body().mesh.nodes, options_in.patch, options_in.crease),
      state(solver_in->AtRest()) {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  diagonal = (X.rowwise().maxCoeff() - X.rowwise().minCoeff()).norm();
  for (const LocationCandidate& candidate : candidates) {
    candidate_places.push_back(faces.walk().Position(candidate.at));
    candidate_patches.push_back(faces.Place(candidate.at, candidate));
  }
}

Eigen::Matrix3Xd LocationEstimator::State::NodalForces(
    const std::vector<TrialForce>& trials) const {
  Eigen::Matrix3Xd nodal = Eigen::Matrix3Xd::Zero(3, solver->body().mesh.num_nodes());
  for (const TrialForce& trial : trials) {
    const PlacedPatch placed = faces.Place(trial.at, candidates[trial.candidate]);
    const Eigen::Vector3d force = placed.directions * trial.intensity;
    const mesh::NodalWeights& weights = placed.patch.weights;
    for (size_t i = 0; i < weights.nodes.size(); ++i) {
      nodal.col(weights.nodes[i]) += weights.weights[i] * force;
    }
  }
  return nodal;
}

fem::SolveSummary LocationEstimator::State::MoveTo(const Eigen::Matrix3Xd& nodal,
                                                   const fem::Actuation& told, double tolerance,
                                                   bool continued,
                                                   std::optional<int> max_load_halvings) {
  fem::Equilibrium trial = state;
  const fem::LoadCase load{nodal, told};
  fem::SolveSummary summary =
      solver->Approach(load, tolerance, continued, &trial, max_load_halvings);
  if (summary.ok()) state = std::move(trial);
  return summary;
}

bool LocationEstimator::State::SelectResponse(const std::vector<WhitenedObservation>& used) {
  const auto same = [](const WhitenedObservation& seen, const mesh::NodalWeights& point) {
    return seen.observation->at.nodes == point.nodes &&
           seen.observation->at.weights == point.weights;
  };
  if (used.size() == response_points.size() &&
      std::equal(used.begin(), used.end(), response_points.begin(), same)) {
    return true;
  }
  Eigen::MatrixXd selected(all_response.rows(), 3 * static_cast<Eigen::Index>(used.size()));
  std::vector<mesh::NodalWeights> points;
  for (const WhitenedObservation& seen : used) {
    const auto at = std::find_if(all_response_points.begin(), all_response_points.end(),
                                 [&](const auto& point) { return same(seen, point); });
    if (at == all_response_points.end()) return false;
    selected.middleCols<3>(3 * static_cast<Eigen::Index>(points.size())) =
        all_response.middleCols<3>(3 * (at - all_response_points.begin()));
    points.push_back(*at);
  }
  response = std::move(selected);
  response_points = std::move(points);
  return true;
}

bool LocationEstimator::State::RefreshResponse(const std::vector<WhitenedObservation>& used,
                                               bool renew) {
  const double max_staleness = renew ? 0 : options.estimator.max_staleness;
  const bool near = response_u.cols() == state.u.cols() &&
                    (state.u - response_u).colwise().norm().maxCoeff() <= max_staleness;
  if (near && SelectResponse(used)) return true;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(state.u.size(), 3 * static_cast<int>(used.size()));
  response_points.clear();
  for (size_t i = 0; i < used.size(); ++i) {
    const mesh::NodalWeights& at = used[i].observation->at;
    response_points.push_back(at);
    for (size_t n = 0; n < at.nodes.size(); ++n) {
      unit.block<3, 3>(3 * at.nodes[n], 3 * static_cast<Eigen::Index>(i))
          .diagonal()
          .setConstant(at.weights[n]);
    }
  }
  fem::Sensitivity sensitivity = solver->Solve(state, unit, max_staleness);
  response_u.resize(3, 0);
  if (!sensitivity.ok) return false;
  response = all_response = std::move(sensitivity.du);
  all_response_points = response_points;
  response_u = state.u;
  return true;
}

double LocationEstimator::State::LargestDisplacement(
    const std::vector<Observation>& observations) const {
  double largest = 0;
  for (const Observation& seen : observations) {
    largest = std::max(largest, seen.at.Apply(state.u).norm());
  }
  return largest;
}

double LocationEstimator::State::Distance(const Eigen::Matrix3Xd& u,
                                          const std::vector<Observation>& observations) const {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  std::vector<double> ways;
  for (const Observation& seen : observations) {
    const double way = (seen.position - seen.offset - seen.at.Apply(X) - seen.at.Apply(u)).norm();
    ways.push_back(std::isfinite(way) ? way : INFINITY);
  }
  if (ways.empty()) return 0;
  const double share = 1 - options.estimator.max_rejected_share;
  const auto at =
      ways.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(ways.size() - 1));
  std::nth_element(ways.begin(), at, ways.end());
  return *at;
}

bool LocationEstimator::State::IsJumpTo(const fem::Equilibrium& shape,
                                        const std::vector<Observation>& observations) const {
  constexpr double kJump = 0.02;   // diagonals: further than from frame to frame
  constexpr double kNearer = 0.5;  // of the way
  const double way = Distance(state.u, observations);
  return way > kJump * diagonal && Distance(shape.u, observations) < kNearer * way;
}

bool LocationEstimator::State::IsPossible(const Observation& seen) const {
  return seen.position.allFinite() && seen.whitening.allFinite() && !seen.whitening.isZero(0) &&
         seen.offset.allFinite() &&
         (seen.position - seen.at.Apply(solver->body().mesh.nodes)).norm() <
             kAbsurdDistance * diagonal;
}

std::vector<WhitenedObservation> LocationEstimator::State::WhitenAll(
    const std::vector<Observation>& observations, const std::vector<char>& rejected,
    const std::vector<double>& slack) const {
  const std::vector<int> companions = CountCompanions(observations);
  const double local = options.estimator.local_model_error * LargestDisplacement(observations);
  std::vector<WhitenedObservation> used;
  for (int i = 0; i < static_cast<int>(observations.size()); ++i) {
    const Observation& seen = observations[i];
    if (rejected[i] || !IsPossible(seen)) continue;
    used.push_back(Whiten(seen, i, std::hypot(local, slack[i]), companions[i]));
  }
  return used;
}

LinearisedPoints LocationEstimator::State::Linearise(
    const std::vector<WhitenedObservation>& used,
    const std::vector<Observation>& observations) const {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  Eigen::Index rows = 0;
  for (const WhitenedObservation& seen : used) rows += seen.whitening.rows();
  LinearisedPoints points;
  points.response = &response;
  if (used.empty()) {
    points.whitening.resize(0, 0);
    points.b.resize(0);
    return points;
  }
  // The model's common error and the place of the rig shift and turn all points together: part of
  // their covariance.
  const double common = options.estimator.common_model_error * LargestDisplacement(observations);
  const PointCloud cloud = CloudOf(used, X);
  const geometry::Matrix6d P = OffsetCovariance(cloud, registration_covariance, common);
  const OffsetPrior about{cloud.centre, geometry::Matrix6d::Identity()};
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(rows, 3 * static_cast<Eigen::Index>(used.size()));
  Eigen::MatrixXd by_offset(rows, 6);
  Eigen::VectorXd misfit(rows);
  Eigen::Index row = 0;
  for (size_t i = 0; i < used.size(); ++i) {
    const WhitenedObservation& seen = used[i];
    const Eigen::Index k = seen.whitening.rows();
    const Eigen::Vector3d on_model =
        seen.observation->at.Apply(X) + seen.observation->at.Apply(state.u);
    own.block(row, 3 * static_cast<Eigen::Index>(i), k, 3) = seen.whitening;
    by_offset.middleRows(row, k) = seen.whitening * OffsetJacobian(on_model, about);
    misfit.segment(row, k) =
        seen.whitening * Misfit(*seen.observation, on_model, about, geometry::Vector6d::Zero());
    row += k;
  }
  const Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(rows, rows) + by_offset * P * by_offset.transpose();
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  points.whitening = factor.matrixL().solve(own);
  const Eigen::VectorXd by_forces = response.transpose() * state.load.forces.reshaped();
  points.b = points.whitening * by_forces - factor.matrixL().solve(misfit);
  return points;
}

// An observation is impossible if it is far from where all others and the forces have it: its
// misfit is compared with its variance when it is left out.
std::vector<double> LocationEstimator::State::Excesses(const std::vector<WhitenedObservation>& used,
                                                       const LinearisedPoints& points,
                                                       const LocationResidual& at) const {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& J : at.J) columns += J.cols();
  const Eigen::Index rows = points.b.size();
  Eigen::MatrixXd projected = Eigen::MatrixXd::Identity(rows, rows);
  if (columns > 0 && columns < rows) {
    Eigen::MatrixXd J(rows, columns);
    Eigen::Index column = 0;
    for (const Eigen::MatrixXd& block : at.J) {
      J.middleCols(column, block.cols()) = block;
      column += block.cols();
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J);
    const Eigen::MatrixXd Q =
        Eigen::MatrixXd(qr.householderQ()).leftCols(std::min(qr.rank(), columns));
    projected -= Q * Q.transpose();
  }
  std::vector<double> excesses;
  for (size_t i = 0; i < used.size(); ++i) {
    const Eigen::MatrixXd own = points.whitening.middleCols<3>(3 * static_cast<Eigen::Index>(i)) *
                                used[i].whitening.completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::MatrixXd information = own.transpose() * projected * own;
    const Eigen::VectorXd pull = own.transpose() * (projected * at.residual);
    const Eigen::LDLT<Eigen::MatrixXd> factor(information);
    const double chi2 = pull.dot(factor.solve(pull));
    excesses.push_back(chi2 /
                       geometry::ChiSquareQuantile(1 - options.estimator.rejection_probability,
                                                   static_cast<int>(own.cols())));
  }
  return excesses;
}

int LocationEstimator::State::WorstOf(const std::vector<WhitenedObservation>& used,
                                      const LinearisedPoints& points,
                                      const LocationResidual& at) const {
  const std::vector<double> excesses = Excesses(used, points, at);
  int worst = -1;
  double worst_excess = 1;
  for (size_t i = 0; i < excesses.size(); ++i) {
    if (!(excesses[i] > worst_excess)) continue;
    worst_excess = excesses[i];
    worst = static_cast<int>(i);
  }
  return worst;
}

}  // namespace softforce::estimation
