// How many forces there are, and near which candidates.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "estimation/location_state.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::estimation {
namespace {

constexpr int kMaxChanges = 12;          // of the number of forces in one search
constexpr size_t kTriedStarts = 3;       // candidates from which a new force is tried
constexpr double kImprobable = 1e-3;     // a residual that large comes by chance this often
constexpr double kNeighbours = 1.5;      // candidate spacings
constexpr double kBeyondTheEdge = 0.15;  // diagonals: one further off moves other markers
constexpr double kWorthSaying = 1e-2;    // odds

// Of an answer that costs `cost` to one that costs `least`: by χ² and prices.
double Odds(double cost, double least) { return std::exp((least - cost) / 2); }

}  // namespace

double LocationEstimator::State::Price(const TrialForce& force) const {
  const int unknowns = static_cast<int>(force.intensity.size()) + (moves() ? 2 : 0);
  return geometry::ChiSquareQuantile(
      1 - options.false_alarm / static_cast<double>(candidates.size()), unknowns);
}

double LocationEstimator::State::Total(double chi2, const std::vector<TrialForce>& trials) const {
  for (const TrialForce& trial : trials) chi2 += Price(trial);
  return chi2;
}

GroupedProblem LocationEstimator::State::AtCandidates(const LinearisedPoints& points) const {
  GroupedProblem problem;
  problem.b = points.b;
  for (size_t c = 0; c < candidates.size(); ++c) {
    const PlacedPatch& placed = candidate_patches[c];
    problem.A.emplace_back(points.Of(placed.patch.weights) * placed.directions);
    problem.push.push_back(candidates[c].direction == ForceDirection::kPush);
  }
  return problem;
}

std::vector<TrialForce> LocationEstimator::State::ForcesOf(const Subset& subset) const {
  std::vector<TrialForce> trials;
  Eigen::Index i = 0;
  for (const int c : subset.groups) {
    TrialForce trial;
    trial.candidate = c;
    trial.at = candidates[c].at;
    trial.intensity = subset.x.segment(i, candidate_patches[c].directions.cols());
    i += trial.intensity.size();
    trials.push_back(trial);
  }
  return trials;
}

std::vector<TrialForce> LocationEstimator::State::Likeliest(const LinearisedPoints& points,
                                                            double* chi2) const {
  const Subset best = SubsetSearch(AtCandidates(points)).Weigh(options.max_forces).best;
  *chi2 = best.chi2;
  return ForcesOf(best);
}

bool LocationEstimator::State::IsPlausible(double chi2, Eigen::Index rows,
                                           const std::vector<TrialForce>& trials) const {
  int unknowns = 0;
  for (const TrialForce& trial : trials) {
    unknowns += static_cast<int>(trial.intensity.size()) + (moves() ? 2 : 0);
  }
  const int freedom = std::max(1, static_cast<int>(rows) - unknowns);
  return chi2 <= geometry::ChiSquareQuantile(1 - kImprobable, freedom);
}

double LocationEstimator::State::Refine(const LinearisedPoints& points,
                                        std::vector<TrialForce>* trials) const {
  return moves() ? FitLocations(points, faces, candidates, trials)
                 : FitIntensities(points, faces, candidates, trials);
}

bool LocationEstimator::State::Prune(const LinearisedPoints& points,
                                     std::vector<TrialForce>* trials, double* chi2,
                                     Rivals* rivals) const {
  // Of two that explain the same, the one that stays where it is keeps its identity.
  constexpr double kPriceOfMoving = 10;  // of χ², per diagonal
  const double before = Total(*chi2, *trials);
  double least = INFINITY;
  std::vector<TrialForce> best;
  for (size_t j = 0; j < trials->size(); ++j) {
    std::vector<TrialForce> without = *trials;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(j));
    std::vector<TrialForce> refined = without;
    const double chi2_without = Refine(points, &refined);
    const double total = Total(chi2_without, refined);
    if (!(total < before)) {
      rivals->odds += Odds(total, before);
      continue;
    }
    double moved = 0;
    for (size_t i = 0; i < refined.size(); ++i) {
      moved += (faces.walk().Position(refined[i].at) - faces.walk().Position(without[i].at)).norm();
    }
    const double score = total + kPriceOfMoving * moved / diagonal;
    if (score >= least) continue;
    least = score;
    best = refined;
    *chi2 = chi2_without;
  }
  if (least == INFINITY) return false;
  *trials = best;
  return true;
}

std::vector<std::pair<double, int>> LocationEstimator::State::Starts(
    const LinearisedPoints& points, const std::vector<TrialForce>& trials) const {
  const LocationResidual at = Evaluate(points, faces, candidates, trials);
  GroupedProblem problem = AtCandidates(points);
  problem.b = -at.residual;
  const int n = static_cast<int>(candidates.size());
  std::vector<int> present;
  for (const Eigen::MatrixXd& J : at.J) {
    present.push_back(static_cast<int>(problem.A.size()));
    problem.A.push_back(J);
    problem.push.push_back(false);
  }
  const SubsetSearch search(problem);
  std::vector<std::pair<double, int>> starts;
  for (int c = 0; c < n; ++c) {
    std::vector<int> groups{c};
    groups.insert(groups.end(), present.begin(), present.end());
    const double there = search.Fit(groups).chi2;
    if (std::isfinite(there)) starts.emplace_back(there, c);
  }
  std::sort(starts.begin(), starts.end());
  if (starts.size() > kTriedStarts) starts.resize(kTriedStarts);
  return starts;
}

std::vector<TrialForce> LocationEstimator::State::Another(const LinearisedPoints& points,
                                                          const std::vector<TrialForce>& trials,
                                                          double* chi2, double* nearest) const {
  *nearest = INFINITY;
  if (static_cast<int>(trials.size()) >= options.max_forces) return {};
  double least = Total(*chi2, trials);
  std::vector<TrialForce> best;
  for (const auto& [there, c] : Starts(points, trials)) {
    TrialForce added;
    added.candidate = c;
    added.at = candidates[c].at;
    added.intensity = Eigen::VectorXd::Zero(candidate_patches[c].directions.cols());
    std::vector<TrialForce> grown = trials;
    grown.push_back(added);
    *nearest = std::min(*nearest, Total(there, grown));
    // Moving may help, but hardly more than to halve what a fixed place leaves over the price.
    if (!(there + 0.5 * Price(added) < *chi2)) continue;
    if (!std::isfinite(FitIntensities(points, faces, candidates, &grown))) continue;
    const double chi2_grown = Refine(points, &grown);
    const double total = Total(chi2_grown, grown);
    *nearest = std::min(*nearest, total);
    if (!(total < least)) continue;
    least = total;
    best = grown;
    *chi2 = chi2_grown;
  }
  return best;
}

bool LocationEstimator::State::Grow(const LinearisedPoints& points, std::vector<TrialForce>* trials,
                                    double* chi2, Rivals* rivals) const {
  const double before = Total(*chi2, *trials);
  double nearest = INFINITY;
  std::vector<TrialForce> grown = Another(points, *trials, chi2, &nearest);
  if (grown.empty()) {
    rivals->odds += Odds(nearest, before);
    return false;
  }
  *trials = std::move(grown);
  return true;
}

bool LocationEstimator::State::ChangeFace(const LinearisedPoints& points,
                                          std::vector<TrialForce>* trials, double* chi2,
                                          Rivals* rivals) const {
  rivals->elsewhere.assign(trials->size(), {});
  const double before = Total(*chi2, *trials);
  double least = before;
  std::vector<TrialForce> best;
  for (size_t j = 0; j < trials->size(); ++j) {
    // The candidate nearest to it on each other face, if it is not far.
    const Eigen::Vector3d place = faces.walk().Position((*trials)[j].at);
    std::map<int, int> nearest;  // by face
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
      const int face = FaceOf(candidates[c].at);
      if (face == FaceOf((*trials)[j].at) ||
          (candidate_places[c] - place).norm() > kBeyondTheEdge * diagonal) {
        continue;
      }
      const auto at = nearest.emplace(face, c).first;
      if ((candidate_places[c] - place).norm() < (candidate_places[at->second] - place).norm()) {
        at->second = c;
      }
    }
    for (const auto& [face, c] : nearest) {
      std::vector<TrialForce> other = *trials;
      other[j].candidate = c;
      other[j].at = candidates[c].at;
      other[j].intensity = Eigen::VectorXd::Zero(candidate_patches[c].directions.cols());
      if (!std::isfinite(FitIntensities(points, faces, candidates, &other))) continue;
      const double chi2_other = Refine(points, &other);
      const double total = Total(chi2_other, other);
      const double odds = Odds(total, before);
      rivals->odds += odds;
      if (odds >= kWorthSaying) rivals->elsewhere[j].push_back(c);
      if (!(total < least)) continue;
      least = total;
      best = other;
      *chi2 = chi2_other;
    }
  }
  if (best.empty()) return false;
  *trials = best;
  return true;
}

std::vector<TrialForce> LocationEstimator::State::Survivors(const LinearisedPoints& points,
                                                            double* chi2) const {
  const Subset survivors = SubsetSearch(AtCandidates(points)).Threshold(options.threshold);
  *chi2 = survivors.chi2;
  if (!std::isfinite(survivors.chi2)) return {};
  std::vector<TrialForce> trials = ForcesOf(survivors);
  // Neighbours hang together over others; each cluster acts at its centre.
  double spacing = INFINITY;
  for (size_t a = 0; a < candidates.size(); ++a) {
    for (size_t b = a + 1; b < candidates.size(); ++b) {
      spacing = std::min(spacing, (candidate_places[a] - candidate_places[b]).norm());
    }
  }
  std::vector<TrialForce> merged;
  std::vector<char> taken(trials.size(), 0);
  for (size_t first = 0; first < trials.size(); ++first) {
    if (taken[first]) continue;
    std::vector<size_t> cluster{first};
    taken[first] = 1;
    for (size_t i = 0; i < cluster.size(); ++i) {
      for (size_t j = 0; j < trials.size(); ++j) {
        const double apart =
            (candidate_places[trials[cluster[i]].candidate] - candidate_places[trials[j].candidate])
                .norm();
        if (taken[j] || apart > kNeighbours * spacing) continue;
        taken[j] = 1;
        cluster.push_back(j);
      }
    }
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const size_t i : cluster) {
      centre += candidate_places[trials[i].candidate] / static_cast<double>(cluster.size());
    }
    TrialForce force = trials[first];
    if (cluster.size() > 1) {
      force.at = mesh::ClosestSurfacePoint(faces.surface(), solver->body().mesh.nodes, centre).at;
    }
    merged.push_back(force);
  }
  if (merged.size() < trials.size()) *chi2 = FitIntensities(points, faces, candidates, &merged);
  return merged;
}

std::vector<TrialForce> LocationEstimator::State::SearchFrom(const LinearisedPoints& points,
                                                             std::vector<TrialForce> trials,
                                                             double* chi2, Rivals* rivals) const {
  *chi2 = Refine(points, &trials);
  for (int change = 0; change < kMaxChanges; ++change) {
    *rivals = {};
    if (!Prune(points, &trials, chi2, rivals) && !Grow(points, &trials, chi2, rivals) &&
        !ChangeFace(points, &trials, chi2, rivals)) {
      break;
    }
  }
  return trials;
}

// Whether as many forces act near the same candidates.
bool LocationEstimator::State::SameAnswer(const std::vector<TrialForce>& a,
                                          const std::vector<TrialForce>& b) const {
  const auto near = [this](const std::vector<TrialForce>& trials) {
    std::multiset<int> nearest;
    for (const TrialForce& trial : trials) {
      nearest.insert(NearestCandidate(faces.walk().Position(trial.at)));
    }
    return nearest;
  };
  return near(a) == near(b);
}

std::vector<TrialForce> LocationEstimator::State::Search(const LinearisedPoints& points,
                                                         const std::vector<TrialForce>& from,
                                                         double* chi2, Rivals* rivals) const {
  if (options.method == LocationMethod::kThreshold) return Survivors(points, chi2);
  if (options.method == LocationMethod::kCandidates) return Likeliest(points, chi2);
  std::vector<TrialForce> best = SearchFrom(points, from, chi2, rivals);
  if (!from.empty() && IsPlausible(*chi2, points.b.size(), best)) return best;
  double chi2_anew = INFINITY;
  Rivals rivals_anew;
  std::vector<TrialForce> anew =
      SearchFrom(points, Likeliest(points, &chi2_anew), &chi2_anew, &rivals_anew);
  const double cost = Total(*chi2, best), cost_anew = Total(chi2_anew, anew);
  const bool same = SameAnswer(best, anew);
  if (!(cost_anew < cost)) {
    if (!same) rivals->odds += Odds(cost_anew, cost);
    return best;
  }
  *chi2 = chi2_anew;
  *rivals = rivals_anew;
  if (!same) rivals->odds += Odds(cost, cost_anew);
  return anew;
}

}  // namespace softforce::estimation
