#include "estimation/subset_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

namespace softforce::estimation {
namespace {

constexpr double kMaxTried = 5000;  // subsets: beyond it a few milliseconds become many
// Of a pivot to the diagonal it began as: two candidates of which one is the other's shadow.
constexpr double kLeastPivot = 1e-9;
constexpr double kHopeless = 60;  // of −2 log evidence: e⁻³⁰ times as likely as the likeliest
constexpr double kUnlikely = 1e-6;

double LogBinomial(int n, int k) {
  return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
}

double CountSubsets(int n, int most) {
  double count = 0;
  for (int k = 0; k <= most; ++k) count += std::exp(LogBinomial(n, k));
  return count;
}

// All ascending subsets of at most `most` of n groups.
void ForEachSubset(int n, int most, std::vector<int>* chosen,
                   const std::function<void(const std::vector<int>&)>& visit) {
  visit(*chosen);
  if (static_cast<int>(chosen->size()) == most) return;
  for (int group = chosen->empty() ? 0 : chosen->back() + 1; group < n; ++group) {
    chosen->push_back(group);
    ForEachSubset(n, most, chosen, visit);
    chosen->pop_back();
  }
}

// Those that differ by one group more, less or other.
std::vector<std::vector<int>> Neighbours(const std::vector<int>& groups, int n, int most) {
  std::vector<std::vector<int>> neighbours;
  for (int group = 0; group < n; ++group) {
    if (std::find(groups.begin(), groups.end(), group) != groups.end()) continue;
    for (size_t i = 0; i <= groups.size(); ++i) {
      std::vector<int> other = groups;
      if (i < groups.size()) {
        other[i] = group;
      } else if (static_cast<int>(groups.size()) < most) {
        other.push_back(group);
      }
      std::sort(other.begin(), other.end());
      neighbours.push_back(std::move(other));
    }
  }
  for (size_t i = 0; i < groups.size(); ++i) {
    neighbours.push_back(groups);
    neighbours.back().erase(neighbours.back().begin() + static_cast<std::ptrdiff_t>(i));
  }
  return neighbours;
}

}  // namespace

double SubsetOdds::least_certain(int num_groups) const {
  std::vector<double> right(static_cast<size_t>(num_groups), 0);
  const auto has = [](const std::vector<int>& groups, int group) {
    return std::find(groups.begin(), groups.end(), group) != groups.end();
  };
  for (const WeighedSubset& subset : likely) {
    for (int g = 0; g < num_groups; ++g) {
      if (has(subset.groups, g) == has(best.groups, g)) {
        right[static_cast<size_t>(g)] += subset.probability;
      }
    }
  }
  return right.empty() ? 1 : *std::min_element(right.begin(), right.end());
}

SubsetSearch::SubsetSearch(const GroupedProblem& problem)
    : first_{0}, push_(problem.push), bb_(problem.b.squaredNorm()) {
  for (const Eigen::MatrixXd& A : problem.A) {
    first_.push_back(first_.back() + static_cast<int>(A.cols()));
  }
  Eigen::MatrixXd A(problem.b.size(), first_.back());
  for (size_t g = 0; g < problem.A.size(); ++g) {
    A.middleCols(first_[g], problem.A[g].cols()) = problem.A[g];
  }
  G_ = A.transpose() * A;
  g_ = A.transpose() * problem.b;
}

std::vector<int> SubsetSearch::Unknowns(const std::vector<int>& groups) const {
  std::vector<int> index;
  for (const int group : groups) {
    for (int i = first_[group]; i < first_[group + 1]; ++i) index.push_back(i);
  }
  return index;
}

Subset SubsetSearch::Fit(const std::vector<int>& groups) const {
  Subset subset;
  subset.groups = groups;
  if (groups.empty()) {
    subset.chi2 = bb_;
    return subset;
  }
  const std::vector<int> index = Unknowns(groups);
  const Eigen::MatrixXd G = G_(index, index);
  const Eigen::VectorXd scale = G.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return subset;
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * G * scale.asDiagonal());
  if (factor.info() != Eigen::Success ||
      factor.matrixLLT().diagonal().cwiseAbs2().minCoeff() < kLeastPivot) {
    return subset;
  }
  const Eigen::VectorXd g = g_(index);
  subset.x = scale.cwiseProduct(factor.solve(scale.cwiseProduct(g)));
  int i = 0;
  for (const int group : groups) {
    // One that would pull is better left out, which is another subset.
    if (push_[group] && subset.x.segment(i, size(group)).minCoeff() < 0) return subset;
    i += size(group);
  }
  subset.chi2 = std::max(0.0, bb_ - g.dot(subset.x));
  return subset;
}

// Standard deviations of an unknown, each three times the one before.
std::vector<double> SubsetSearch::Scales() const {
  constexpr double kStep = 3;
  constexpr double kClear = 10;  // of the noise: weaker ones are not expected, or noise finds them
  double hidden = INFINITY, whole = 0;
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    if (!(G_(i, i) > 0)) continue;
    hidden = std::min(hidden, 1 / std::sqrt(G_(i, i)));
    whole = std::max(whole, std::sqrt(bb_ / G_(i, i)));
  }
  std::vector<double> scales;
  for (double scale = kClear * hidden; scales.empty() || scale < whole; scale *= kStep) {
    scales.push_back(scale);
  }
  return scales;
}

double SubsetSearch::MinusTwiceLogEvidence(const Subset& fit,
                                           const std::vector<double>& scales) const {
  if (fit.groups.empty()) return bb_;
  const std::vector<int> index = Unknowns(fit.groups);
  const Eigen::MatrixXd G = G_(index, index);
  const Eigen::VectorXd g = g_(index);
  Eigen::ArrayXd cost(static_cast<Eigen::Index>(scales.size()));
  Eigen::LLT<Eigen::MatrixXd> factor(G.rows());
  Eigen::MatrixXd with_prior = G;
  for (size_t j = 0; j < scales.size(); ++j) {
    const double information = 1 / (scales[j] * scales[j]);
    with_prior.diagonal() = G.diagonal().array() + information;
    factor.compute(with_prior);
    const double determinant = factor.matrixLLT().diagonal().array().square().log().sum() -
                               static_cast<double>(G.rows()) * std::log(information);
    cost(static_cast<Eigen::Index>(j)) =
        bb_ - factor.matrixL().solve(g).squaredNorm() + determinant;
  }
  const double least = cost.minCoeff();
  double total = least - 2 * std::log(((least - cost) / 2).exp().mean());
  for (const int group : fit.groups) {
    if (push_[group]) total -= 2 * size(group) * std::log(2.0);  // half of a normal distribution
  }
  return total + 2 * LogBinomial(num_groups(), static_cast<int>(fit.groups.size()));
}

SubsetOdds SubsetSearch::Weigh(int most) const {
  const int n = num_groups();
  most = std::min(most, n);
  const std::vector<double> scales = Scales();
  std::map<std::vector<int>, double> costs;
  double least = INFINITY;
  std::vector<int> best;
  const auto weigh = [&](const Subset& fit) {
    // χ² is the least that the evidence can cost.
    const double cost = fit.chi2 < least + kHopeless ? MinusTwiceLogEvidence(fit, scales)
                                                     : std::numeric_limits<double>::infinity();
    costs[fit.groups] = cost;
    if (!(cost < least)) return false;
    least = cost;
    best = fit.groups;
    return true;
  };
  if (CountSubsets(n, most) <= kMaxTried) {
    std::vector<Subset> fits;
    std::vector<int> chosen;
    ForEachSubset(n, most, &chosen,
                  [&](const std::vector<int>& groups) { fits.push_back(Fit(groups)); });
    std::stable_sort(fits.begin(), fits.end(),
                     [](const Subset& a, const Subset& b) { return a.chi2 < b.chi2; });
    for (const Subset& fit : fits) weigh(fit);
  } else {
    weigh(Fit({}));
    for (bool better = true; better;) {
      better = false;
      for (const std::vector<int>& groups : Neighbours(best, n, most)) {
        if (costs.count(groups) == 0) better |= weigh(Fit(groups));
      }
    }
  }
  SubsetOdds odds;
  odds.best = Fit(best);
  double sum = 0;
  for (const auto& [groups, cost] : costs) sum += std::exp((least - cost) / 2);
  for (const auto& [groups, cost] : costs) {
    const double probability = std::exp((least - cost) / 2) / sum;
    if (probability >= kUnlikely) odds.likely.push_back({groups, probability});
  }
  std::stable_sort(
      odds.likely.begin(), odds.likely.end(),
      [](const WeighedSubset& a, const WeighedSubset& b) { return a.probability > b.probability; });
  return odds;
}

Subset SubsetSearch::Threshold(double share) const {
  std::vector<int> kept(push_.size());
  std::iota(kept.begin(), kept.end(), 0);
  // Pulls are left in, so that they can be given up.
  SubsetSearch free = *this;
  std::fill(free.push_.begin(), free.push_.end(), false);
  while (true) {
    Subset subset = free.Fit(kept);
    if (kept.empty() || !std::isfinite(subset.chi2)) return subset;
    std::vector<double> strength;
    int i = 0;
    for (const int group : kept) {
      const auto x = subset.x.segment(i, size(group));
      strength.push_back(push_[group] ? x.minCoeff() : x.norm());
      i += size(group);
    }
    const double least = share * *std::max_element(strength.begin(), strength.end());
    std::vector<int> survivors;
    for (size_t k = 0; k < kept.size(); ++k) {
      if (strength[k] >= least && strength[k] > 0) survivors.push_back(kept[k]);
    }
    if (survivors.size() == kept.size()) return subset;
    kept = survivors;
  }
}

}  // namespace softforce::estimation
