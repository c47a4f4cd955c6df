#include "calibration/normal_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace softforce::calibration {
namespace {

// Smallest eigenvalue of the equations, scaled to a diagonal of ones, from which on they can be
// inverted to some digits.
constexpr double kMinEigenvalue = 1e-13;

// The inverse of a positive definite matrix by its spectrum after scaling; false if it has none.
bool InvertScaled(const Eigen::MatrixXd& A, Eigen::MatrixXd* inverse) {
  if (!A.allFinite() || !(A.diagonal().minCoeff() > 0)) return false;
  const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(scale.asDiagonal() * A *
                                                                scale.asDiagonal());
  if (!(spectrum.eigenvalues()(0) > kMinEigenvalue)) return false;
  const Eigen::MatrixXd V = scale.asDiagonal() * spectrum.eigenvectors();
  *inverse = V * spectrum.eigenvalues().cwiseInverse().asDiagonal() * V.transpose();
  return true;
}

}  // namespace

NormalEquations::NormalEquations(const BoardShape& board, const std::vector<Sighting>& sightings,
                                 const Estimate& estimate) {
  Lay(estimate);
  boards_.resize(estimate.T_rig_board.size());
  for (Board& b : boards_) b.with_shared = Eigen::MatrixXd::Zero(num_shared_, 6);
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(num_shared_, num_shared_);
  for (const Sighting& sighting : sightings) {
    if (sighting.used) Add(board, estimate, sighting, &reduced);
  }
  for (size_t c = 0; c < estimate.lenses.size(); ++c) {
    for (int i = 0; i < estimate.num_lens(static_cast<int>(c)); ++i) {
      reduced(lens_start_[c] + i, lens_start_[c] + i) += std::pow(PriorSd(estimate.fits[c], i), -2);
    }
  }
  for (Board& b : boards_) {
    if (!b.seen) continue;
    Eigen::MatrixXd covariance;
    determined_ = determined_ && InvertScaled(b.information, &covariance);
    if (!determined_) return;
    b.covariance = covariance;
    reduced -= b.with_shared * b.covariance * b.with_shared.transpose();
  }
  determined_ = InvertScaled(reduced, &shared_covariance_);
}

int NormalEquations::num_boards() const {
  return static_cast<int>(
      std::count_if(boards_.begin(), boards_.end(), [](const Board& b) { return b.seen; }));
}

void NormalEquations::Lay(const Estimate& estimate) {
  for (int c = 0; c < static_cast<int>(estimate.lenses.size()); ++c) {
    lens_start_.push_back(num_shared_);
    num_shared_ += estimate.num_lens(c);
    pose_start_.push_back(c > 0 ? num_shared_ : -1);
    if (c > 0) num_shared_ += 6;
  }
  if (estimate.fit_warp) {
    warp_start_ = num_shared_;
    num_shared_ += 2;
  }
}

void NormalEquations::Add(const BoardShape& board, const Estimate& estimate,
                          const Sighting& sighting, Eigen::MatrixXd* shared) {
  const int c = sighting.camera;
  const Linearised at =
      Linearise(estimate.lenses[c], estimate.T_camera_rig[c], estimate.T_rig_board[sighting.view],
                board.Bent(sighting.id, estimate.warp), board.basis[sighting.id]);
  if (!at.visible) return;
  struct Part {
    int start;
    Eigen::MatrixXd jacobian;
  };
  std::vector<Part> parts = {
      {lens_start_[c], sighting.whitening * at.by_lens.leftCols(estimate.num_lens(c))}};
  if (pose_start_[c] >= 0) parts.push_back({pose_start_[c], sighting.whitening * at.by_camera});
  if (warp_start_ >= 0) parts.push_back({warp_start_, sighting.whitening * at.by_warp});

  Board& b = boards_[sighting.view];
  const Eigen::Matrix<double, 2, 6> by_board = sighting.whitening * at.by_board;
  b.seen = true;
  b.information += by_board.transpose() * by_board;
  for (const Part& row : parts) {
    b.with_shared.middleRows(row.start, row.jacobian.cols()) += row.jacobian.transpose() * by_board;
    for (const Part& column : parts) {
      shared->block(row.start, column.start, row.jacobian.cols(), column.jacobian.cols()) +=
          row.jacobian.transpose() * column.jacobian;
    }
  }
}

Eigen::MatrixXd NormalEquations::CovarianceOf(const Dependence& dependence) const {
  Eigen::MatrixXd by_shared = dependence.by_shared;
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(by_shared.rows(), by_shared.rows());
  for (size_t v = 0; v < dependence.by_board.size(); ++v) {
    const Eigen::MatrixXd& by_board = dependence.by_board[v];
    if (by_board.size() == 0) continue;
    own += by_board * boards_[v].covariance * by_board.transpose();
    by_shared -= by_board * boards_[v].covariance * boards_[v].with_shared.transpose();
  }
  return own + by_shared * shared_covariance_ * by_shared.transpose();
}

geometry::Matrix6d NormalEquations::BoardCovariance(int view) const {
  Dependence pose;
  pose.by_shared = Eigen::MatrixXd::Zero(6, num_shared_);
  pose.by_board.resize(boards_.size());
  pose.by_board[view] = Eigen::MatrixXd::Identity(6, 6);
  return CovarianceOf(pose);
}

}  // namespace softforce::calibration
