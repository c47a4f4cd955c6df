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

// What the data say of which groups act.
struct WeighedSubset {
  std::vector<int> groups;  // ascending
  double probability;       // that it is just these
};
struct SubsetOdds {
  Subset best;
  std::vector<WeighedSubset> likely;  // likeliest first, down to a millionth

  // Of that group of which it is least certain, that it is rightly in the best subset or out of it.
  double least_certain(int num_groups) const;
};

// Normal equations of all groups, from which those of any subset are taken.
class SubsetSearch {
 public:
  explicit SubsetSearch(const GroupedProblem& problem);

  // Least squares over given groups; χ² infinite if they cannot be told apart or would pull.
  Subset Fit(const std::vector<int>& groups) const;

  // Bayes' rule over the subsets of at most `most` groups. Beforehand every number of groups is
  // held to be as likely as another, and so is every subset of that number; the unknowns of a
  // subset are normal with one standard deviation, of which only its order of magnitude is known:
  // between what the noise hides and what the whole of b would ask for. Every subset is tried if
  // they are few, else those around the likeliest one that growing, exchanging and dropping of
  // groups finds.
  SubsetOdds Weigh(int most) const;

  // All groups, less those whose intensity is below a share of the largest, until none is.
  Subset Threshold(double share) const;

 private:
  std::vector<int> Unknowns(const std::vector<int>& groups) const;
  std::vector<double> Scales() const;
  double MinusTwiceLogEvidence(const Subset& fit, const std::vector<double>& scales) const;
  int num_groups() const { return static_cast<int>(push_.size()); }
  int size(int group) const { return first_[group + 1] - first_[group]; }

  std::vector<int> first_;  // unknown of each group
  std::vector<char> push_;
  Eigen::MatrixXd G_;  // AᵀA
  Eigen::VectorXd g_;  // Aᵀb
  double bb_;          // bᵀb
};

}  // namespace softforce::estimation
