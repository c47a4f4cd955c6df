#include "pipeline/tare.h"

#include <fmt/format.h>

namespace softforce::pipeline {

void Tare::Gather(const FrameResult& result) {
  for (const ForceResult& force : result.forces) {
    Zero& sum = sums_[force.identity];
    sum.force += force.force;
    sum.covariance += force.covariance;
    ++sum.frames;
  }
}

void Tare::Settle(int frame) {
  zeros_.clear();
  std::string text;
  for (auto& [identity, sum] : sums_) {
    sum.force /= sum.frames;
    // Of the mean, if nothing were common to the frames it is taken over.
    sum.covariance /= static_cast<double>(sum.frames) * sum.frames;
    text += fmt::format("{}F{} ({:.4g}, {:.4g}, {:.4g}) N", text.empty() ? "" : ", ", identity,
                        sum.force.x(), sum.force.y(), sum.force.z());
    zeros_[identity] = sum;
  }
  sums_.clear();
  messages_.push_back(
      fmt::format("tared on request: after frame {} forces are counted from {}", frame, text));
  controls_->tared = asked_;
}

void Tare::Apply(FrameResult* result) {
  if (controls_ == nullptr) return;
  if (controls_->tares != asked_) {
    asked_ = controls_->tares;
    frames_ = kFrames;
    sums_.clear();
  }
  // A frame without forces says nothing; it is waited for one that has some.
  const bool gathers = frames_ > 0 && result->ok() && !result->forces.empty();
  if (gathers) Gather(*result);
  for (ForceResult& force : result->forces) {
    const auto zero = zeros_.find(force.identity);
    if (zero == zeros_.end()) continue;
    force.force -= zero->second.force;
    force.covariance += zero->second.covariance;
  }
  if (gathers && --frames_ == 0) Settle(result->frame);
}

}  // namespace softforce::pipeline
