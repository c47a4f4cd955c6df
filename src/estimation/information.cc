#include "softforce/estimation/information.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace softforce::estimation {
namespace {

// Of the whole information: what is taken to be known of the forces beforehand while the first few
// markers, which do not tell all of them, are compared.
constexpr double kBeforehand = 1e-8;

double LogDet(const Eigen::MatrixXd& F) {
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(F);
  return ldlt.vectorD().cwiseMax(std::numeric_limits<double>::min()).array().log().sum();
}

}  // namespace

struct ForceInformation::Sums {
  Eigen::MatrixXd AA, BA, BB;  // n×n, 6×n, 6×6

  explicit Sums(Eigen::Index n)
      : AA(Eigen::MatrixXd::Zero(n, n)),
        BA(Eigen::MatrixXd::Zero(6, n)),
        BB(Eigen::MatrixXd::Zero(6, 6)) {}

  void Add(const MarkerRows& marker) {
    AA += marker.forces.transpose() * marker.forces;
    BA += marker.offset.transpose() * marker.forces;
    BB += marker.offset.transpose() * marker.offset;
  }
};

ForceInformation::ForceInformation(std::vector<MarkerRows> markers,
                                   const Eigen::MatrixXd& offset_covariance)
    : markers_(std::move(markers)), offset_covariance_(offset_covariance) {}

Eigen::MatrixXd ForceInformation::InformationOf(const Sums& sums) const {
  const Eigen::MatrixXd& P = offset_covariance_;
  const Eigen::MatrixXd explained =
      (Eigen::MatrixXd::Identity(6, 6) + P * sums.BB).partialPivLu().solve(P * sums.BA);
  const Eigen::MatrixXd F = sums.AA - sums.BA.transpose() * explained;
  return 0.5 * (F + F.transpose());
}

std::vector<double> ForceInformation::Shares() const {
  std::vector<double> shares(markers_.size(), NAN);
  if (markers_.empty() || markers_.front().forces.cols() == 0) return shares;
  const Eigen::Index n = markers_.front().forces.cols();
  Sums all(n);
  for (const MarkerRows& marker : markers_) all.Add(marker);
  const Eigen::MatrixXd F = InformationOf(all);
  const Eigen::FullPivLU<Eigen::MatrixXd> inverse(F);
  if (!F.allFinite() || !inverse.isInvertible()) return shares;
  // Rows of the forces less what the offset, as all markers together find it, explains of them.
  const Eigen::MatrixXd explained = (Eigen::MatrixXd::Identity(6, 6) + offset_covariance_ * all.BB)
                                        .partialPivLu()
                                        .solve(offset_covariance_ * all.BA);
  double sum = 0;
  for (size_t i = 0; i < markers_.size(); ++i) {
    const Eigen::MatrixXd own = markers_[i].forces - markers_[i].offset * explained;
    shares[i] = inverse.solve(own.transpose() * own).trace();
    sum += shares[i];
  }
  for (double& share : shares) share /= sum;
  return shares;
}

std::vector<int> ForceInformation::MostTelling(int count) const {
  std::vector<int> left(markers_.size());
  std::iota(left.begin(), left.end(), 0);
  if (count >= static_cast<int>(markers_.size())) return left;
  const Eigen::Index n = markers_.front().forces.cols();
  Sums all(n);
  for (const MarkerRows& marker : markers_) all.Add(marker);
  Sums chosen(n);
  chosen.AA.diagonal() = kBeforehand * all.AA.diagonal();
  std::vector<int> telling;
  while (static_cast<int>(telling.size()) < count) {
    auto best = left.begin();
    double most = -std::numeric_limits<double>::infinity();
    for (auto i = left.begin(); i != left.end(); ++i) {
      Sums with = chosen;
      with.Add(markers_[*i]);
      const double told = LogDet(InformationOf(with));
      if (told <= most) continue;
      most = told;
      best = i;
    }
    chosen.Add(markers_[*best]);
    telling.push_back(*best);
    left.erase(best);
  }
  return telling;
}

}  // namespace softforce::estimation
