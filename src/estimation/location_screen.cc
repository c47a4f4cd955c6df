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

// Two opposite forces beside a marker explain any place of it, so a search that trusts all markers
// finds them. Here each step is the cheaper one of two: another force, or an observation left out.
// Where the linear answer is wrong by the square of the way, each observation is given the error of
// its own way: one that is far off explains nothing by itself.
std::vector<int> LocationEstimator::State::Screen(const std::vector<Observation>& observations,
                                                  const std::vector<char>& rejected,
                                                  std::vector<TrialForce> trials) const {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  const double usual = Distance(state.u, observations);
  std::vector<double> way(observations.size(), 0), slack(observations.size(), 0);  // m
  const std::vector<WhitenedObservation> near = WhitenAll(observations, rejected, slack);
  for (const WhitenedObservation& seen : near) {
    const Observation& o = *seen.observation;
    const Eigen::Vector3d misfit = o.position - o.offset - o.at.Apply(X) - o.at.Apply(state.u);
    way[seen.index] = std::min((seen.whitening * misfit).norm() * seen.sd, diagonal);
    slack[seen.index] = std::hypot(std::pow(way[seen.index], 2), usual * usual) / (2 * diagonal);
  }
  const int most = static_cast<int>(options.estimator.max_rejected_share *
                                    static_cast<double>(observations.size())) -
                   static_cast<int>(std::count(rejected.begin(), rejected.end(), char{1}));
  std::vector<int> out;
  LinearisedPoints points;
  std::vector<WhitenedObservation> used;
  while (static_cast<int>(out.size()) < most) {
    used = WhitenAll(observations, rejected, slack);
    points = Linearise(used, observations);
    double chi2 = Refine(points, &trials);
    const Eigen::Index weightless = 3 * static_cast<Eigen::Index>(out.size());
    if (!std::isfinite(chi2) || IsPlausible(chi2, points.b.size() - weightless, trials)) break;
    const std::vector<double> excesses =
        Excesses(used, points, Evaluate(points, faces, candidates, trials));
    int worst = -1;
    for (size_t i = 0; i < used.size(); ++i) {
      const bool in = std::isfinite(slack[used[i].index]);
      if (in && excesses[i] > (worst < 0 ? 1 : excesses[worst])) worst = static_cast<int>(i);
    }
    const double before = Total(chi2, trials);
    double nearest = NAN, with_force = chi2;
    std::vector<TrialForce> grown = Another(points, trials, &with_force, &nearest);
    const double by_force = grown.empty() ? 0 : before - Total(with_force, grown);
    const double price =
        geometry::ChiSquareQuantile(1 - options.estimator.rejection_probability, 3);
    const double by_leaving_out = worst < 0 ? 0 : (excesses[worst] - 1) * price;
    if (!(std::max(by_force, by_leaving_out) > 0)) break;
    if (by_force >= by_leaving_out) {
      trials = std::move(grown);
    } else {
      out.push_back(used[worst].index);
      slack[out.back()] = kInfinite;
    }
  }
  if (used.empty()) return out;
  const Eigen::VectorXd moved =
      response.transpose() * (NodalForces(trials) - state.load.forces).reshaped();
  for (size_t i = 0; i < used.size() && static_cast<int>(out.size()) < most; ++i) {
    const int o = used[i].index;
    if (!std::isfinite(slack[o]) || slack[o] < near[i].sd) continue;
    const double by_forces = moved.segment<3>(3 * static_cast<Eigen::Index>(i)).norm();
    const double error = std::pow(std::max(by_forces, usual), 2) / (2 * diagonal);
    if (way[o] > kTooFar * by_forces + kBeyond * std::hypot(error, near[i].sd)) out.push_back(o);
  }
  return out;
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
