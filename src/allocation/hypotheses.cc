#include "allocation/hypotheses.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "softforce/geometry/chi_square.h"

namespace softforce::allocation {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using RowsOf2 = Eigen::Matrix<double, 2, Eigen::Dynamic>;

constexpr double kLogTwoPi = 1.8378770664093453;

double LogNormal(double distance2, double determinant) {
  return -0.5 * (distance2 + std::log(determinant)) - kLogTwoPi;
}

}  // namespace

Hypotheses::Hypotheses(const std::vector<JointPrediction>& predictions, const Belief& prior,
                       const std::vector<std::vector<DetectedPixel>>& detections,
                       const JointOptions& options)
    : detections_(detections),
      options_(options),
      prior_(prior),
      gate_(geometry::ChiSquareQuantile(options.allocation.gate_probability, 2)),
      log_seen_(std::log(options.detection_probability)),
      log_hidden_(std::log(1 - options.detection_probability)) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(prior.covariance);
  root_ = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  for (const JointPrediction& p : predictions) {
    predictions_.push_back({p.camera, p.pixel + p.H * prior.mean, p.H * root_, p.covariance});
  }
  MeasureDensity();
}

// What a false detection is as likely as.
void Hypotheses::MeasureDensity() {
  constexpr double kMargin = 20;  // px
  density_.assign(detections_.size(), 0);
  for (size_t c = 0; c < detections_.size(); ++c) {
    Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
    Vector2d high = -low;
    for (const JointPrediction& p : predictions_) {
      if (p.camera != static_cast<int>(c) || !p.pixel.allFinite()) continue;
      low = low.cwiseMin(p.pixel);
      high = high.cwiseMax(p.pixel);
    }
    const Vector2d size = (high - low).cwiseMax(0) + Vector2d::Constant(2 * kMargin);
    density_[c] = std::max<double>(1, static_cast<double>(detections_[c].size())) /
                  std::max(1.0, size.x() * size.y());
  }
}

Hypothesis Hypotheses::Prior() const {
  const auto n = root_.cols();
  return {VectorXd::Zero(n), MatrixXd::Identity(n, n), 0,
          std::vector<int>(predictions_.size(), -1)};
}

Hypothesis Hypotheses::Near(const Belief& near) const {
  Hypothesis hypothesis = Prior();
  const MatrixXd to_white = root_.completeOrthogonalDecomposition().pseudoInverse();
  hypothesis.mean = to_white * (near.mean - prior_.mean);
  hypothesis.covariance = to_white * near.covariance * to_white.transpose();
  return hypothesis;
}

Belief Hypotheses::BeliefOf(const Hypothesis& hypothesis) const {
  return {prior_.mean + root_ * hypothesis.mean, root_ * hypothesis.covariance * root_.transpose()};
}

// The paper's threshold displacement.
bool Hypotheses::Within(const Vector2d& from_prediction) const {
  const double threshold = options_.allocation.threshold_displacement_px;
  return threshold <= 0 || from_prediction.squaredNorm() <= threshold * threshold;
}

// The prediction to decide on next: with the fewest detections in its gate, and of those the
// narrowest gate. −1 if none is left that would tell anything new.
int Hypotheses::Next(const Hypothesis& best, const std::vector<char>& decided) const {
  int next = -1, fewest = 0;
  double narrowest = 0;
  for (size_t i = 0; i < predictions_.size(); ++i) {
    if (decided[i]) continue;
    const JointPrediction& p = predictions_[i];
    const Matrix2d spread = p.H * best.covariance * p.H.transpose();
    if (spread.trace() <= p.covariance.trace()) continue;
    const Matrix2d S = spread + p.covariance;
    const Matrix2d inverse = S.inverse();
    const Vector2d pixel = p.pixel + p.H * best.mean;
    int inside = 0;
    for (const DetectedPixel& seen : detections_[p.camera]) {
      const Vector2d nu = seen.pixel - pixel;
      if (nu.dot(inverse * nu) <= gate_) ++inside;
    }
    if (inside == 0) continue;
    const double area = S.determinant();
    if (next >= 0 && (inside > fewest || (inside == fewest && area >= narrowest))) continue;
    next = static_cast<int>(i);
    fewest = inside;
    narrowest = area;
  }
  return next;
}

bool Hypotheses::Taken(const Hypothesis& hypothesis, int camera, int detection) const {
  for (size_t i = 0; i < predictions_.size(); ++i) {
    if (hypothesis.detection[i] == detection && predictions_[i].camera == camera) return true;
  }
  return false;
}

void Hypotheses::Branch(const Hypothesis& from, int i, std::vector<Hypothesis>* into) const {
  const JointPrediction& p = predictions_[i];
  into->push_back(from);
  into->back().score += log_hidden_;
  const RowsOf2 HP = p.H * from.covariance;
  const Matrix2d spread = HP * p.H.transpose();
  const Vector2d pixel = p.pixel + p.H * from.mean;
  const std::vector<DetectedPixel>& detections = detections_[p.camera];
  for (int d = 0; d < static_cast<int>(detections.size()); ++d) {
    const Matrix2d S = spread + p.covariance + detections[d].covariance;
    const Matrix2d inverse = S.inverse();
    const Vector2d nu = detections[d].pixel - pixel;
    const double distance2 = nu.dot(inverse * nu);
    if (!(distance2 <= gate_) || !Within(detections[d].pixel - p.pixel)) continue;
    if (Taken(from, p.camera, d)) continue;
    Hypothesis child = from;
    child.score += log_seen_ - std::log(density_[p.camera]) + LogNormal(distance2, S.determinant());
    child.detection[i] = d;
    const MatrixXd gain = HP.transpose() * inverse;
    child.mean += gain * nu;
    child.covariance.noalias() -= gain * HP;
    into->push_back(std::move(child));
  }
}

std::vector<Hypothesis> Hypotheses::Search() const {
  constexpr double kHopeless = 20;  // log probability behind the best
  std::vector<Hypothesis> hypotheses{Prior()};
  std::vector<char> decided(predictions_.size(), 0);
  for (int depth = 0; depth < static_cast<int>(predictions_.size()); ++depth) {
    const int i = Next(hypotheses.front(), decided);
    if (i < 0) break;
    decided[i] = 1;
    std::vector<Hypothesis> children;
    for (const Hypothesis& hypothesis : hypotheses) Branch(hypothesis, i, &children);
    std::stable_sort(children.begin(), children.end(),
                     [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
    const double best = children.front().score;
    while (static_cast<int>(children.size()) > options_.max_hypotheses ||
           children.back().score < best - kHopeless) {
      children.pop_back();
    }
    hypotheses = std::move(children);
  }
  return hypotheses;
}

void Hypotheses::Learn(Hypothesis* hypothesis) const {
  const auto n = root_.cols();
  MatrixXd information = MatrixXd::Identity(n, n);
  VectorXd weighted = VectorXd::Zero(n);
  double score = 0, squares = 0;
  for (size_t i = 0; i < predictions_.size(); ++i) {
    const int d = hypothesis->detection[i];
    if (d < 0) {
      score += log_hidden_;
      continue;
    }
    const JointPrediction& p = predictions_[i];
    const DetectedPixel& seen = detections_[p.camera][d];
    const Matrix2d R = p.covariance + seen.covariance;
    const Matrix2d inverse = R.inverse();
    const Vector2d nu = seen.pixel - p.pixel;
    const RowsOf2 weightedH = inverse * p.H;
    information.noalias() += p.H.transpose() * weightedH;
    weighted.noalias() += weightedH.transpose() * nu;
    squares += nu.dot(inverse * nu);
    score += log_seen_ - std::log(density_[p.camera]) + LogNormal(0, R.determinant());
  }
  const Eigen::LLT<MatrixXd> llt(information);
  hypothesis->covariance = llt.solve(MatrixXd::Identity(n, n));
  hypothesis->mean = llt.solve(weighted);
  const VectorXd diagonal = llt.matrixLLT().diagonal();
  hypothesis->score =
      score - 0.5 * (squares - weighted.dot(hypothesis->mean)) - diagonal.array().log().sum();
}

}  // namespace softforce::allocation
