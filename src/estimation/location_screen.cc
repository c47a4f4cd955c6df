// Observations that are wrong, told from forces that nobody has found yet.
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/location_state.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

// Seen so many times as far away as forces move it that explain all others, and so many of the
// linear answer's errors further: no force is looked for to explain it.
constexpr double kTooFar = 2;
constexpr double kBeyond = 5;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

// Where the linear answer is wrong by the square of the way, each observation is given the error of
// its own way: one that is far off explains nothing by itself.
LocationEstimator::State::Ways LocationEstimator::State::WaysLeft(
    const std::vector<Observation>& observations, const std::vector<char>& rejected) const {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  const size_t n = observations.size();
  const std::vector<double> none(n, 0);
  Ways ways{none, none, none, Distance(state.u, observations)};
  for (const WhitenedObservation& seen : WhitenAll(observations, rejected, none)) {
    const Observation& o = *seen.observation;
    const Eigen::Vector3d misfit = o.position - o.offset - o.at.Apply(X) - o.at.Apply(state.u);
    const double way = std::min((seen.whitening * misfit).norm() * seen.sd, diagonal);
    ways.way[seen.index] = way;
    ways.sd[seen.index] = seen.sd;
    ways.slack[seen.index] = std::hypot(way * way, ways.usual * ways.usual) / (2 * diagonal);
  }
  return ways;
}

// Two opposite forces beside a marker explain any place of it, so a search that trusts all markers
// finds them. Here each step is the cheaper one of two: another force, or an observation left out.
std::vector<int> LocationEstimator::State::Screen(const std::vector<Observation>& observations,
                                                  const std::vector<char>& rejected,
                                                  std::vector<TrialForce> trials) const {
  Ways ways = WaysLeft(observations, rejected);
  const auto most = static_cast<size_t>(
      std::max(0, static_cast<int>(options.estimator.max_rejected_share *
                                   static_cast<double>(observations.size())) -
                      static_cast<int>(std::count(rejected.begin(), rejected.end(), char{1}))));
  std::vector<int> out;
  std::vector<WhitenedObservation> used;
  Eigen::Index rows_out = 0;
  while (out.size() < most) {
    used = WhitenAll(observations, rejected, ways.slack);
    const LinearisedPoints points = Linearise(used, observations);
    const double chi2 = Refine(points, &trials);
    if (!std::isfinite(chi2) || IsPlausible(chi2, points.b.size() - rows_out, trials)) break;
    const std::vector<double> excesses =
        Excesses(used, points, Evaluate(points, faces, candidates, trials));
    int worst = -1;
    for (size_t i = 0; i < used.size(); ++i) {
      const bool in = std::isfinite(ways.slack[used[i].index]);
      if (in && excesses[i] > (worst < 0 ? 1 : excesses[worst])) worst = static_cast<int>(i);
    }
    double nearest = NAN, with_force = chi2;
    std::vector<TrialForce> grown = Another(points, trials, &with_force, &nearest);
    const double by_force = grown.empty() ? 0 : Total(chi2, trials) - Total(with_force, grown);
    const double by_leaving_out =
        worst < 0 ? 0
                  : (excesses[worst] - 1) *
                        geometry::ChiSquareQuantile(1 - options.estimator.rejection_probability,
                                                    static_cast<int>(used[worst].whitening.rows()));
    if (!(std::max(by_force, by_leaving_out) > 0)) break;
    if (by_force >= by_leaving_out) {
      trials = std::move(grown);
    } else {
      out.push_back(used[worst].index);
      rows_out += used[worst].whitening.rows();
      ways.slack[out.back()] = kInfinite;
    }
  }
  for (const int o : TooFar(ways, used, trials)) {
    if (out.size() < most) out.push_back(o);
  }
  return out;
}

std::vector<int> LocationEstimator::State::TooFar(const Ways& ways,
                                                  const std::vector<WhitenedObservation>& used,
                                                  const std::vector<TrialForce>& trials) const {
  std::vector<int> far;
  if (used.empty()) return far;
  const Eigen::VectorXd moved =
      response.transpose() * (NodalForces(trials) - state.load.forces).reshaped();
  for (size_t i = 0; i < used.size(); ++i) {
    const int o = used[i].index;
    if (!std::isfinite(ways.slack[o]) || ways.slack[o] < ways.sd[o]) continue;
    const double by_forces = moved.segment<3>(3 * static_cast<Eigen::Index>(i)).norm();
    const double error = std::pow(std::max(by_forces, ways.usual), 2) / (2 * diagonal);
    if (ways.way[o] > kTooFar * by_forces + kBeyond * std::hypot(error, ways.sd[o])) {
      far.push_back(o);
    }
  }
  return far;
}

// One by one: wrong ones are not to speak for each other.
std::vector<int> LocationEstimator::State::Explained(const std::vector<Observation>& observations,
                                                     const std::vector<char>& rejected,
                                                     double slack,
                                                     const std::vector<TrialForce>& trials) {
  std::vector<int> explained;
  const std::vector<char> none(observations.size(), 0);
  for (size_t o = 0; o < observations.size(); ++o) {
    if (!rejected[o]) continue;
    std::vector<double> slacks(observations.size(), slack);
    for (size_t other = 0; other < observations.size(); ++other) {
      if (rejected[other] && other != o) slacks[other] = kInfinite;
    }
    const std::vector<WhitenedObservation> used = WhitenAll(observations, none, slacks);
    if (!RefreshResponse(used)) return {};
    const LinearisedPoints points = Linearise(used, observations);
    const std::vector<double> excesses =
        Excesses(used, points, Evaluate(points, faces, candidates, trials));
    for (size_t i = 0; i < used.size(); ++i) {
      if (used[i].index == static_cast<int>(o) && !(excesses[i] > 1)) {
        explained.push_back(static_cast<int>(o));
      }
    }
  }
  return explained;
}

}  // namespace softforce::estimation
