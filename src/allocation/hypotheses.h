#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/allocation/allocate_jointly.h"

namespace softforce::allocation {

// What is believed after some decisions.
struct Hypothesis {
  Eigen::VectorXd mean;  // of delta, whitened by the prior
  Eigen::MatrixXd covariance;
  double score = 0;            // log probability, up to a constant
  std::vector<int> detection;  // per prediction; −1 if none, or not decided
};

// Makes hypotheses about which detection is which feature. `delta` is whitened by its prior, which
// may be singular: delta = mean + root · eta. Predictions, detections and options must outlive it.
class Hypotheses {
 public:
  Hypotheses(const std::vector<JointPrediction>& predictions, const Belief& prior,
             const std::vector<std::vector<DetectedPixel>>& detections,
             const JointOptions& options);

  // At the prior's mean, H whitened.
  const std::vector<JointPrediction>& predictions() const { return predictions_; }

  // One that knows nothing but where to look.
  Hypothesis Near(const Belief& near) const;
  // The likeliest, best first, with features decided on one after another.
  std::vector<Hypothesis> Search() const;
  // Belief and probability of the prior together with the hypothesis' detections.
  void Learn(Hypothesis* hypothesis) const;
  Belief BeliefOf(const Hypothesis& hypothesis) const;

 private:
  void MeasureDensity();
  Hypothesis Prior() const;
  bool Within(const Eigen::Vector2d& from_prediction) const;
  int Next(const Hypothesis& best, const std::vector<char>& decided) const;
  bool Taken(const Hypothesis& hypothesis, int camera, int detection) const;
  void Branch(const Hypothesis& from, int i, std::vector<Hypothesis>* into) const;

  std::vector<JointPrediction> predictions_;
  const std::vector<std::vector<DetectedPixel>>& detections_;
  const JointOptions& options_;
  const Belief prior_;
  const double gate_, log_seen_, log_hidden_;
  Eigen::MatrixXd root_;         // of the prior's covariance
  std::vector<double> density_;  // detections per px² about the features, per camera
};

}  // namespace softforce::allocation
