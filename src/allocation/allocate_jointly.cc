#include "softforce/allocation/allocate_jointly.h"

#include <algorithm>
#include <cmath>

#include "allocation/hypotheses.h"
#include "softforce/base/input_error.h"

namespace softforce::allocation {
namespace {

// A hypothesis with every camera assigned as a whole.
struct Worked {
  Hypothesis hypothesis;
  std::vector<AllocatedPixel> pixels;
};

// Whether a hypothesis says the same about the body as one that has been worked out.
bool Known(const std::vector<JointPrediction>& predictions, const Hypothesis& hypothesis,
           const std::vector<Worked>& worked) {
  for (const Worked& other : worked) {
    double furthest = 0;
    for (const JointPrediction& p : predictions) {
      const Eigen::Vector2d apart = p.H * (hypothesis.mean - other.hypothesis.mean);
      furthest = std::max(furthest, apart.squaredNorm() / p.covariance.trace());
    }
    if (furthest < 1) return true;
  }
  return false;
}

void Assign(const std::vector<JointPrediction>& all,
            const std::vector<std::vector<DetectedPixel>>& detections,
            const AllocationOptions& options, Worked* worked) {
  for (int c = 0; c < static_cast<int>(detections.size()); ++c) {
    std::vector<PredictedPixel> predictions;
    std::vector<int> number;
    for (size_t i = 0; i < all.size(); ++i) {
      const JointPrediction& p = all[i];
      if (p.camera != c) continue;
      predictions.push_back({p.pixel + p.H * worked->hypothesis.mean,
                             p.H * worked->hypothesis.covariance * p.H.transpose() + p.covariance});
      number.push_back(static_cast<int>(i));
    }
    const std::vector<AllocatedPixel> allocated = Allocate(predictions, detections[c], options);
    for (size_t k = 0; k < allocated.size(); ++k) {
      worked->pixels[number[k]] = allocated[k];
      worked->hypothesis.detection[number[k]] = allocated[k].detection;
    }
  }
}

// Assigns each camera as a whole about the hypothesis, and learns from that, until nothing
// changes.
Worked WorkOut(const Hypotheses& hypotheses, const Hypothesis& from,
               const std::vector<std::vector<DetectedPixel>>& detections,
               const AllocationOptions& options) {
  constexpr int kMaxRounds = 4;
  Worked worked{from, std::vector<AllocatedPixel>(hypotheses.predictions().size())};
  std::vector<int> before;
  for (int round = 0; round < kMaxRounds; ++round) {
    Assign(hypotheses.predictions(), detections, options, &worked);
    if (worked.hypothesis.detection == before) break;
    before = worked.hypothesis.detection;
    hypotheses.Learn(&worked.hypothesis);
  }
  return worked;
}

// A feature that has another detection in the other hypothesis, or whose detection is another's
// there, is ambiguous.
void LeaveOutDifferences(const std::vector<JointPrediction>& predictions, const Hypothesis& best,
                         const Hypothesis& other, std::vector<AllocatedPixel>* pixels) {
  for (size_t i = 0; i < predictions.size(); ++i) {
    const int mine = best.detection[i];
    if (mine < 0) continue;
    bool differs = other.detection[i] >= 0 && other.detection[i] != mine;
    for (size_t k = 0; k < predictions.size() && !differs; ++k) {
      differs =
          k != i && predictions[k].camera == predictions[i].camera && other.detection[k] == mine;
    }
    if (!differs) continue;
    (*pixels)[i].status = AllocatedPixel::Status::kAmbiguous;
    (*pixels)[i].detection = -1;
  }
}

std::vector<Worked> WorkOutAll(const Hypotheses& hypotheses, const std::vector<Hypothesis>& found,
                               const std::vector<std::vector<DetectedPixel>>& detections,
                               const JointOptions& options) {
  std::vector<Worked> worked;
  for (const Hypothesis& hypothesis : found) {
    if (static_cast<int>(worked.size()) >= options.refined_hypotheses) break;
    if (Known(hypotheses.predictions(), hypothesis, worked)) continue;
    worked.push_back(WorkOut(hypotheses, hypothesis, detections, options.allocation));
  }
  std::stable_sort(worked.begin(), worked.end(), [](const Worked& a, const Worked& b) {
    return a.hypothesis.score > b.hypothesis.score;
  });
  return worked;
}

}  // namespace

void JointOptions::Check() const {
  allocation.Check();
  if (!(detection_probability > 0 && detection_probability < 1)) {
    throw base::InputError("allocation: detection_probability", "must lie between 0 and 1");
  }
  if (max_hypotheses < 1) {
    throw base::InputError("allocation: max_hypotheses", "must be 1 or more");
  }
  if (refined_hypotheses < 1) {
    throw base::InputError("allocation: refined_hypotheses", "must be 1 or more");
  }
}

JointAllocation AllocateJointly(const std::vector<JointPrediction>& predictions,
                                const Belief& prior,
                                const std::vector<std::vector<DetectedPixel>>& detections,
                                const JointOptions& options, const Belief* near) {
  options.Check();
  const Hypotheses hypotheses(predictions, prior, detections, options);
  const std::vector<Hypothesis> found =
      near != nullptr ? std::vector<Hypothesis>{hypotheses.Near(*near)} : hypotheses.Search();
  const std::vector<Worked> worked = WorkOutAll(hypotheses, found, detections, options);
  const Worked& best = worked.front();
  JointAllocation answer{best.pixels, hypotheses.BeliefOf(best.hypothesis)};
  for (const Worked& other : worked) {
    if (other.hypothesis.score < best.hypothesis.score - options.allocation.min_margin) break;
    LeaveOutDifferences(hypotheses.predictions(), best.hypothesis, other.hypothesis,
                        &answer.pixels);
  }
  return answer;
}

std::vector<JointAllocation> ProposeJointly(
    const std::vector<JointPrediction>& predictions, const Belief& prior,
    const std::vector<std::vector<DetectedPixel>>& detections, const JointOptions& options) {
  options.Check();
  const Hypotheses hypotheses(predictions, prior, detections, options);
  std::vector<JointAllocation> proposals;
  for (Worked& worked : WorkOutAll(hypotheses, hypotheses.Search(), detections, options)) {
    proposals.push_back({std::move(worked.pixels), hypotheses.BeliefOf(worked.hypothesis)});
  }
  return proposals;
}

}  // namespace softforce::allocation
