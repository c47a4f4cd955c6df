#include "estimation/subset_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

namespace softforce::estimation {
namespace {

constexpr double kMaxTried = 5000;  // subsets: beyond it a few milliseconds become many
// Of a pivot to the diagonal it began as: two candidates of which one is the other's shadow.
constexpr double kLeastPivot = 1e-9;

double CountSubsets(int n, int most) {
  double count = 0, choices = 1;
  for (int k = 1; k <= most; ++k) count += choices = choices * (n - k + 1) / k;
  return count;
}

double Total(const std::vector<int>& groups, const std::vector<double>& price) {
  return std::accumulate(groups.begin(), groups.end(), 0.0,
                         [&](double sum, int group) { return sum + price[group]; });
}

}  // namespace

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

Subset SubsetSearch::Fit(const std::vector<int>& groups) const {
  Subset subset;
  subset.groups = groups;
  if (groups.empty()) {
    subset.chi2 = bb_;
    return subset;
  }
  std::vector<int> index;
  for (const int group : groups) {
    for (int i = first_[group]; i < first_[group + 1]; ++i) index.push_back(i);
  }
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

void SubsetSearch::TryAll(int most, const std::vector<double>& price, std::vector<int>* chosen,
                          Subset* best, double* least) const {
  Subset subset = Fit(*chosen);
  const double total = subset.chi2 + Total(*chosen, price);
  if (total < *least) {
    *least = total;
    *best = std::move(subset);
  }
  if (static_cast<int>(chosen->size()) == most) return;
  const int n = static_cast<int>(push_.size());
  for (int group = chosen->empty() ? 0 : chosen->back() + 1; group < n; ++group) {
    chosen->push_back(group);
    TryAll(most, price, chosen, best, least);
    chosen->pop_back();
  }
}

Subset SubsetSearch::Best(int most, const std::vector<double>& price) const {
  const int n = static_cast<int>(push_.size());
  most = std::min(most, n);
  if (CountSubsets(n, most) > kMaxTried) return Grown(most, price);
  Subset best;
  double least = std::numeric_limits<double>::infinity();
  std::vector<int> chosen;
  TryAll(most, price, &chosen, &best, &least);
  return best;
}

Subset SubsetSearch::Grown(int most, const std::vector<double>& price) const {
  const int n = static_cast<int>(push_.size());
  Subset best = Fit({});
  double least = best.chi2;
  const auto consider = [&](std::vector<int> groups) {
    std::sort(groups.begin(), groups.end());
    if (std::adjacent_find(groups.begin(), groups.end()) != groups.end()) return false;
    Subset subset = Fit(groups);
    const double total = subset.chi2 + Total(groups, price);
    if (!(total < least)) return false;
    least = total;
    best = std::move(subset);
    return true;
  };
  for (bool better = true; better;) {
    better = false;
    const std::vector<int> from = best.groups;
    for (int group = 0; group < n && static_cast<int>(from.size()) < most; ++group) {
      std::vector<int> grown = from;
      grown.push_back(group);
      better |= consider(grown);
    }
    for (size_t i = 0; i < from.size() && !better; ++i) {
      for (int group = 0; group < n; ++group) {
        std::vector<int> exchanged = from;
        exchanged[i] = group;
        better |= consider(exchanged);
      }
    }
    for (size_t i = 0; i < from.size() && !better; ++i) {
      std::vector<int> fewer = from;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      better |= consider(fewer);
    }
  }
  return best;
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
