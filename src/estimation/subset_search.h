#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace softforce::estimation {

// Linear least squares over some of several groups of unknowns: residual = Σ A_g x_g − b, whitened.
struct GroupedProblem {
  std::vector<Eigen::MatrixXd> A;  // rows×k_g
  Eigen::VectorXd b;
  std::vector<char> push;  // per group: its unknowns are ≥ 0
};

struct Subset {
  std::vector<int> groups;  // ascending
  Eigen::VectorXd x;        // of these groups, one after another
  double chi2 = std::numeric_limits<double>::infinity();
};

// Normal equations of all groups, from which those of any subset are taken.
class SubsetSearch {
 public:
  explicit SubsetSearch(const GroupedProblem& problem);

  // Least squares over given groups; χ² infinite if they cannot be told apart or would pull.
  Subset Fit(const std::vector<int>& groups) const;

  // The subset of at most `most` groups that minimises χ² + Σ price_g: every one is tried if they
  // are few, else the best one is grown, and exchanged member by member.
  Subset Best(int most, const std::vector<double>& price) const;

  // All groups, less those whose intensity is below a share of the largest, until none is.
  Subset Threshold(double share) const;

 private:
  Subset Grown(int most, const std::vector<double>& price) const;
  void TryAll(int most, const std::vector<double>& price, std::vector<int>* chosen, Subset* best,
              double* least) const;
  int size(int group) const { return first_[group + 1] - first_[group]; }

  std::vector<int> first_;  // unknown of each group
  std::vector<char> push_;
  Eigen::MatrixXd G_;  // AᵀA
  Eigen::VectorXd g_;  // Aᵀb
  double bb_;          // bᵀb
};

}  // namespace softforce::estimation
