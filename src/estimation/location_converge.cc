// Forces, their places and the body's equilibrium under them, together.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/location_state.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

constexpr int kMaxRounds = 25;
constexpr int kScreenedRounds = 2;  // afterwards the linear answer is right
constexpr int kFreeRounds = 12;     // after these the number of forces stays
// A step of the loads is followed to this share of the movement that it makes.
constexpr double kFollowing = 0.02;
constexpr double kFinestTolerance = 1e-13;  // of the diagonal: rounding
constexpr double kFarthest = 0.1;           // diagonals: beyond it the linear answer leads astray
constexpr int kMaxHalvings = 6;
constexpr int kLoadHalvings = 1;  // within a step, which is itself halved if it fails
// A response from where the body stood before may swing the forces to and fro: it is renewed if a
// step is not shorter than this share of the one before.
constexpr double kSlow = 0.5;
constexpr double kNearEquilibrium = 1e-5;  // of the diagonal, see ForceEstimator
constexpr double kDoubt = 0.01;            // probability of another candidate that is worth saying
// Squared cosine: unknowns of which one is the others' shadow to this share cannot be told apart.
constexpr double kLeastEigenvalue = 1e-9;

using Status = ForceEstimate::Status;

LocationEstimate Failed(LocationEstimate estimate, Status status, std::string reason) {
  estimate.status = status;
  estimate.reason = std::move(reason);
  estimate.forces.clear();
  return estimate;
}

bool Contains(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

bool SameStructure(const std::vector<TrialForce>& a, const std::vector<TrialForce>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const TrialForce& x, const TrialForce& y) {
                      return x.identity == y.identity && x.candidate == y.candidate;
                    });
}

}  // namespace

struct LocationEstimator::State::Round {
  std::vector<WhitenedObservation> used;
  LinearisedPoints points;
  std::vector<TrialForce> forces;
  double chi2 = NAN;
  double sd = INFINITY;  // m, the smallest of an observation's coordinates
  double slack = 0;      // m, that the linear answer may be wrong by
  bool renew = false;    // compute the response where the body stands
  bool screen = false;   // look for wrong observations before another force is believed
  Rivals rivals;
};

bool LocationEstimator::State::Explains(const Round& round,
                                        const std::vector<TrialForce>& from) const {
  return from.size() == round.forces.size() &&
         IsPlausible(round.chi2, round.points.b.size(), round.forces);
}

bool LocationEstimator::State::Explain(const std::vector<Observation>& observations, bool search,
                                       Round* round, LocationEstimate* estimate) {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  const std::vector<TrialForce> from = round->forces;
  int rejections =
      static_cast<int>(std::count(estimate->rejected.begin(), estimate->rejected.end(), char{1}));
  while (true) {
    // The linear answer stretches what should turn: see the square of the way that is left.
    double way = 0;
    for (size_t i = 0; i < observations.size(); ++i) {
      const Observation& seen = observations[i];
      const double left =
          (seen.position - seen.offset - seen.at.Apply(X) - seen.at.Apply(state.u)).norm();
      if (!estimate->rejected[i] && std::isfinite(left)) way = std::max(way, left);
    }
    way = std::min(way, diagonal);
    round->slack = way * way / (2 * diagonal);
    const std::vector<double> slack(observations.size(), round->slack);
    round->used = WhitenAll(observations, estimate->rejected, slack);
    if (round->used.empty()) {
      *estimate = Failed(*estimate, Status::kTooFewObservations, "no marker is seen");
      return false;
    }
    round->sd = INFINITY;
    for (const WhitenedObservation& seen : round->used) round->sd = std::min(round->sd, seen.sd);
    if (!RefreshResponse(round->used, round->renew)) {
      *estimate = Failed(*estimate, Status::kNotConverged, "the body is about to buckle");
      return false;
    }
    round->renew = false;
    round->points = Linearise(round->used, observations);
    round->forces = from;
    // Before what is hard to explain is taken for more forces, or for others.
    const auto screened = [&] {
      round->screen = false;
      const std::vector<int> wrong = Screen(observations, estimate->rejected, from);
      for (const int i : wrong) estimate->rejected[i] = 1;
      rejections += static_cast<int>(wrong.size());
      return !wrong.empty();
    };
    if (round->screen && from.empty() && screened()) continue;
    if (search) {
      round->forces = Search(round->points, from, &round->chi2, &round->rivals);
    } else {
      round->chi2 = Refine(round->points, &round->forces);
    }
    if (!std::isfinite(round->chi2)) {
      *estimate = Failed(*estimate, Status::kUnobservable,
                         "the candidates' forces cannot be told apart by what is seen; give fewer "
                         "candidates or more markers");
      return false;
    }
    if (round->screen && !Explains(*round, from) && screened()) continue;
    const int worst = WorstOf(round->used, round->points,
                              Evaluate(round->points, faces, candidates, round->forces));
    if (worst < 0) return true;
    if (++rejections >
        options.estimator.max_rejected_share * static_cast<double>(observations.size())) {
      *estimate = Failed(
          *estimate, Status::kInconsistent,
          fmt::format("after {} rejections there are still observations that no force explains",
                      rejections - 1));
      return false;
    }
    estimate->rejected[round->used[worst].index] = 1;
  }
}

LocationEstimate LocationEstimator::State::Converge(const std::vector<Observation>& observations,
                                                    const fem::Actuation& told,
                                                    const fem::Equilibrium* shape) {
  LocationEstimate estimate;
  for (const Observation& seen : observations) estimate.rejected.push_back(!IsPossible(seen));
  first_new_identity = next_identity;
  if (shape != nullptr) {
    state = *shape;
  } else {
    const fem::SolveSummary reached =
        MoveTo(NodalForces(forces), told, kNearEquilibrium * diagonal, false);
    if (!reached.ok()) {
      return Failed(estimate, Status::kNotConverged,
                    "the body has no equilibrium under the actuation: " + reached.BriefReport());
    }
  }
  if (options.method == LocationMethod::kThreshold) {
    Eigen::Index unknowns = 0;
    for (const PlacedPatch& placed : candidate_patches) unknowns += placed.directions.cols();
    if (3 * static_cast<Eigen::Index>(observations.size()) < unknowns) {
      return Failed(estimate, Status::kTooFewObservations,
                    fmt::format("{} markers cannot tell {} unknown forces apart (Theorem 4)",
                                observations.size(), unknowns));
    }
  }
  Round round;
  round.forces = forces;
  double followed_to = kNearEquilibrium * diagonal, last_move = INFINITY;
  bool reconsidered = false;  // what was rejected
  int factorisations = 0;
  for (int i = 0; i < kMaxRounds; ++i) {
    estimate.rounds = i + 1;
    const std::vector<TrialForce> before = round.forces;
    round.screen = i < kScreenedRounds && options.method != LocationMethod::kThreshold;
    if (!Explain(observations, i < kFreeRounds, &round, &estimate)) return estimate;
    Identify(before, {}, &round.forces);
    const Eigen::Matrix3Xd change = NodalForces(round.forces) - state.load.forces;
    const Eigen::VectorXd moves_by = response.transpose() * change.reshaped();
    const double move = moves_by.size() > 0
                            ? moves_by.reshaped(3, moves_by.size() / 3).colwise().norm().maxCoeff()
                            : 0;
    const double finest =
        std::max(options.estimator.tolerance * round.sd, kFinestTolerance * diagonal);
    // `finest` differs a little from round to round.
    const bool settled = move <= finest && followed_to <= 1.01 * finest;
    if (i > 0 && SameStructure(before, round.forces) && settled) {
      // What seemed impossible far from the answer may be possible here.
      const std::vector<int> explained =
          reconsidered ? std::vector<int>{}
                       : Explained(observations, estimate.rejected, round.slack, round.forces);
      if (explained.empty()) {
        RefreshResponse(round.used);
        Conclude(&round, &estimate);
        return estimate;
      }
      reconsidered = true;
      for (const int o : explained) estimate.rejected[o] = 0;
      continue;
    }
    round.renew = i > 1 && move > kSlow * last_move && move > finest;
    last_move = move;
    double share = move > 0 ? std::min(1.0, kFarthest * diagonal / move) : 1;
    const Eigen::Matrix3Xd start = state.load.forces;
    bool moved = false;
    for (int halving = 0; halving <= kMaxHalvings && !moved; ++halving, share /= 2) {
      followed_to = std::max(finest, kFollowing * share * move);
      const fem::SolveSummary summary =
          MoveTo(start + share * change, told, followed_to, i > 0, kLoadHalvings);
      moved = summary.ok();
      factorisations += summary.factorisations;
      if (factorisations > options.estimator.max_factorisations) break;
    }
    if (!moved) break;
  }
  return Failed(estimate, Status::kNotConverged,
                "the forces, their places and the body's equilibrium did not settle");
}

bool LocationEstimator::State::Describe(const LinearisedPoints& points,
                                        const std::vector<TrialForce>& trials,
                                        std::vector<LocatedForce>* located,
                                        std::string* culprit) const {
  located->clear();
  if (trials.empty()) return true;
  const LocationResidual at = Evaluate(points, faces, candidates, trials);
  const int places = moves() ? 2 : 0;
  std::vector<int> first;
  int unknowns = 0;
  for (const TrialForce& trial : trials) {
    first.push_back(unknowns);
    unknowns += static_cast<int>(trial.intensity.size()) + places;
  }
  Eigen::MatrixXd J(points.b.size(), unknowns);
  for (size_t j = 0; j < trials.size(); ++j) {
    const Eigen::Index k = trials[j].intensity.size() + places;
    J.middleCols(first[j], k) = at.J[j].leftCols(k);
  }
  const Eigen::VectorXd scale = J.colwise().norm().cwiseInverse();
  const Eigen::MatrixXd scaled = J * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(scaled.transpose() * scaled);
  if (!(axes.eigenvalues()(0) > kLeastEigenvalue)) {
    Eigen::Index most = 0;
    axes.eigenvectors().col(0).cwiseAbs().maxCoeff(&most);
    size_t j = 0;
    while (j + 1 < trials.size() && first[j + 1] <= most) ++j;
    *culprit = fmt::format("the force near candidate {}", candidates[trials[j].candidate].name);
    return false;
  }
  const Eigen::MatrixXd covariance = scale.asDiagonal() * axes.eigenvectors() *
                                     axes.eigenvalues().cwiseInverse().asDiagonal() *
                                     axes.eigenvectors().transpose() * scale.asDiagonal();
  for (size_t j = 0; j < trials.size(); ++j) {
    const TrialForce& trial = trials[j];
    const PlacedPatch placed = faces.Place(trial.at, candidates[trial.candidate]);
    const Eigen::Index k = trial.intensity.size();
    LocatedForce force;
    force.identity = trial.identity;
    force.at = trial.at;
    force.rest = faces.walk().Position(trial.at);
    force.candidate = NearestCandidate(force.rest);
    force.force = placed.directions * trial.intensity;
    force.covariance = placed.directions * covariance.block(first[j], first[j], k, k) *
                       placed.directions.transpose();
    force.tangents = placed.tangents;
    if (moves()) {
      force.location_covariance = covariance.block<2, 2>(first[j] + k, first[j] + k);
    }
    located->push_back(std::move(force));
  }
  return true;
}

int LocationEstimator::State::NearestCandidate(const Eigen::Vector3d& place) const {
  int nearest = 0;
  for (size_t c = 1; c < candidates.size(); ++c) {
    if ((candidate_places[c] - place).norm() < (candidate_places[nearest] - place).norm()) {
      nearest = static_cast<int>(c);
    }
  }
  return nearest;
}

void LocationEstimator::State::FindAlternatives(const Round& round,
                                                LocationEstimate* estimate) const {
  constexpr double kProbability = 0.95;
  if (moves()) {
    // Candidates within the region in which the place lies, and on other faces.
    for (size_t j = 0; j < estimate->forces.size(); ++j) {
      LocatedForce& force = estimate->forces[j];
      if (j < round.rivals.elsewhere.size()) force.alternatives = round.rivals.elsewhere[j];
      for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
        if (c == force.candidate || Contains(force.alternatives, c)) continue;
        if (FaceOf(candidates[c].at) != FaceOf(force.at)) continue;
        const Eigen::Vector2d apart =
            force.tangents.transpose() * (candidate_places[c] - force.rest);
        const double distance2 = apart.dot(force.location_covariance.ldlt().solve(apart));
        if (distance2 <= geometry::ChiSquareQuantile(kProbability, 2)) {
          force.alternatives.push_back(c);
        }
      }
    }
    estimate->probability = 1 / (1 + round.rivals.odds);
    return;
  }
  // Candidates that may be loaded instead.
  const SubsetOdds odds = SubsetSearch(AtCandidates(round.points)).Weigh(options.max_forces);
  for (LocatedForce& force : estimate->forces) {
    std::vector<double> instead(candidates.size(), 0);
    for (const WeighedSubset& subset : odds.likely) {
      if (Contains(subset.groups, force.candidate)) continue;
      for (const int c : subset.groups) instead[c] += subset.probability;
    }
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
      if (!Contains(odds.best.groups, c) && instead[c] >= kDoubt) force.alternatives.push_back(c);
    }
  }
  estimate->probability = odds.least_certain(static_cast<int>(candidates.size()));
}

void LocationEstimator::State::Conclude(Round* last, LocationEstimate* estimate) {
  Round& round = *last;
  next_identity = first_new_identity;  // those that came and went on the way leave no gap
  Identify(forces, gone, &round.forces);
  std::string culprit;
  if (!Describe(round.points, round.forces, &estimate->forces, &culprit)) {
    *estimate = Failed(*estimate, Status::kUnobservable,
                       culprit + " cannot be told apart from the others by what is seen");
    return;
  }
  if (options.method != LocationMethod::kThreshold) {
    FindAlternatives(round, estimate);
  }
  estimate->status = Status::kOk;
  estimate->chi2 = round.chi2;
  estimate->degrees_of_freedom = static_cast<int>(round.points.b.size());
  for (const TrialForce& trial : round.forces) {
    estimate->degrees_of_freedom -= static_cast<int>(trial.intensity.size()) + (moves() ? 2 : 0);
  }
  Remember(round.forces);
}

}  // namespace softforce::estimation
