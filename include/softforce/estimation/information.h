#pragma once

#include <Eigen/Core>
#include <vector>

namespace softforce::estimation {

// What one marker is expected to tell: its whitened rows, d(whitening · position) by the forces and
// by the rigid offset that all markers share.
struct MarkerRows {
  Eigen::MatrixXd forces;               // k×n, 1/N
  Eigen::Matrix<double, -1, 6> offset;  // k×6, 1/m and 1/rad
};

// The expected (Fisher) information about n force components from markers that are measured all
// together, the rigid offset being unknown up to its prior covariance P:
//
//   F = AᵀA − AᵀB (I + P BᵀB)⁻¹ P BᵀA,  A, B: the rows of all markers.
//
// It depends on where the markers are and how well they are measured, not on what was measured: a
// marker that the forces move far, and the offset does not, tells much.
class ForceInformation {
 public:
  // `offset_covariance`: P, 6×6; may be singular, or zero for a rig whose place is exact.
  ForceInformation(std::vector<MarkerRows> markers, const Eigen::MatrixXd& offset_covariance);

  // The share of every marker in it: its leverage tr(F⁻¹ D_iᵀD_i), D_i being its rows of A less
  // what the offset explains of them, over the sum of all. NaN where F is singular, that is, the
  // markers do not tell the forces.
  std::vector<double> Shares() const;

  // The numbers of `count` markers that together tell most: the one that raises log det F most,
  // then the one that does so beside it, and so on (greedy D-optimality); in that order. All of
  // them if there are no more than `count`.
  std::vector<int> MostTelling(int count) const;

 private:
  struct Sums;
  Eigen::MatrixXd InformationOf(const Sums& sums) const;

  std::vector<MarkerRows> markers_;
  Eigen::MatrixXd offset_covariance_;
};

}  // namespace softforce::estimation
