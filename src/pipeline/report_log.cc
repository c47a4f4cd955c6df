#include "pipeline/report_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace softforce::pipeline {
namespace {

constexpr double kSigmas = 1.959964;  // of a band that holds 95 %
constexpr int kPictureWidth = 1280;   // px
constexpr int kJpegQuality = 82;      // %

void Band(double value, double sd, report::Extent* extent) {
  extent->Add(value - kSigmas * sd);
  extent->Add(value + kSigmas * sd);
}

report::ForceExtent ExtentOf(const ForceResult& force) {
  report::ForceExtent extent;
  for (int i = 0; i < 3; ++i) {
    const auto part = static_cast<size_t>(i);
    extent.value[part].Add(force.force(i));
    Band(force.force(i), std::sqrt(force.covariance(i, i)), &extent.band[part]);
  }
  const double norm = force.force.norm();
  extent.value[3].Add(norm);
  extent.band[3].Add(std::max(0.0, norm - kSigmas * force.NormSd()));
  extent.band[3].Add(norm + kSigmas * force.NormSd());
  return extent;
}

std::string Jpeg(const cv::Mat& picture) {
  cv::Mat small = picture;
  if (picture.cols > kPictureWidth) {
    const double factor = static_cast<double>(kPictureWidth) / picture.cols;
    cv::resize(picture, small, {}, factor, factor, cv::INTER_AREA);
  }
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", small, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return {bytes.begin(), bytes.end()};
}

bool IsOk(const FrameResult& result) {
  return result.status == estimation::ForceEstimate::Status::kOk;
}

bool HasRejected(const FrameResult& result) {
  return std::any_of(result.markers.begin(), result.markers.end(), [](const MarkerResult& marker) {
    return marker.status == MarkerStatus::kRejected;
  });
}

double LargestNorm(const FrameResult& result) {
  double largest = 0;
  for (const ForceResult& force : result.forces) largest = std::max(largest, force.force.norm());
  return largest;
}

}  // namespace

ReportLog::ReportLog(const World& world) : world_(world), body_(world) {
  // Three coordinates of two bytes for each node, as the page has them.
  const double per_view = 6.0 * static_cast<double>(body_.shape().nodes.cols());
  max_views_ = static_cast<size_t>(
      std::clamp(static_cast<int>(kViewBytes / per_view), kMinViews, kMaxViews));
}

report::RunColumn ReportLog::ColumnOf(const FrameResult& result) {
  report::RunColumn column;
  column.first_frame = column.last_frame = result.frame;
  column.first_s = column.last_s = result.time_s;
  column.frames = 1;
  if (IsOk(result) && result.degrees_of_freedom > 0) {
    column.reduced_chi2.Add(result.chi2 / result.degrees_of_freedom);
  }
  for (const ForceResult& force : result.forces) {
    const std::string name = ForceName(force);
    auto known = std::find(forces_.begin(), forces_.end(), name);
    if (known == forces_.end()) {
      if (forces_.size() == kMaxForces) {
        // Counted by name, and no more names than there may be forces at a time.
        if (left_out_.size() < 1000) ++left_out_[name];
        continue;
      }
      known = forces_.insert(known, name);
    }
    const auto place = static_cast<size_t>(known - forces_.begin());
    column.forces.resize(std::max(column.forces.size(), place + 1));
    column.forces[place].Add(ExtentOf(force));
  }
  if (marker_ids_.empty()) {
    for (const MarkerResult& marker : result.markers) marker_ids_.push_back(marker.id);
    marker_frames_.resize(marker_ids_.size(), {});
  }
  for (size_t m = 0; m < std::min(result.markers.size(), marker_ids_.size()); ++m) {
    const auto status = static_cast<size_t>(result.markers[m].status);
    column.markers.push_back(static_cast<unsigned char>(status));
    ++marker_frames_[m][status];
  }
  return column;
}

void ReportLog::KeepKeyFrames(const FrameInWork& frame) {
  const FrameResult& result = frame.result;
  const auto key = [&](const char* label) {
    return KeyFrame{label, body_.ViewOf(frame), frame.overlay};
  };
  if (!first_) first_ = key("first frame");
  if (LargestNorm(result) > largest_norm_) {
    largest_norm_ = LargestNorm(result);
    largest_ = key("largest force");
  }
  if (!without_forces_ && !IsOk(result)) without_forces_ = key("first without forces");
  if (!rejected_ && HasRejected(result)) rejected_ = key("first with a rejected marker");
  last_ = key("last frame");
}

// Every stride_-th frame; when they are too many, every other one of them is given up.
void ReportLog::KeepView(const FrameInWork& frame) {
  if (frames_ % stride_ != 0) return;
  if (views_.size() == max_views_) {
    stride_ *= 2;
    size_t kept = 0;
    for (size_t i = 0; i < views_.size(); i += 2) {
      if (kept != i) views_[kept] = std::move(views_[i]);
      ++kept;
    }
    views_.resize(kept);
    if (frames_ % stride_ != 0) return;
  }
  views_.push_back(body_.ViewOf(frame));
}

void ReportLog::Add(const FrameInWork& frame) {
  columns_.Add(ColumnOf(frame.result));
  if (frame.u.cols() == world_.mesh().num_nodes() && frame.u.allFinite()) {
    KeepView(frame);
    KeepKeyFrames(frame);
  }
  ++frames_;
}

std::vector<ReportLog::KeyFrame> ReportLog::KeyFrames() const {
  std::vector<KeyFrame> frames;
  for (const auto* one : {&first_, &largest_, &without_forces_, &rejected_, &last_}) {
    if (!*one) continue;
    const KeyFrame& key = **one;
    const auto same = std::find_if(frames.begin(), frames.end(), [&](const KeyFrame& other) {
      return other.view.frame == key.view.frame;
    });
    if (same == frames.end()) {
      frames.push_back(key);
    } else {
      same->label += ", " + key.label;
    }
  }
  std::stable_sort(frames.begin(), frames.end(), [](const KeyFrame& a, const KeyFrame& b) {
    return a.view.frame < b.view.frame;
  });
  return frames;
}

void ReportLog::Fill(report::RunRecord* record) const {
  record->time = columns_;
  record->forces = forces_;
  record->forces_left_out = static_cast<int>(left_out_.size());
  record->markers = marker_ids_;
  record->marker_statuses = MarkerStatusNames();
  record->body = body_.shape();
  record->views = views_;
  for (const KeyFrame& key : KeyFrames()) {
    const auto same =
        std::find_if(record->views.begin(), record->views.end(),
                     [&](const report::BodyView& view) { return view.frame == key.view.frame; });
    report::BodyView& view =
        same != record->views.end() ? *same : record->views.emplace_back(key.view);
    view.label = key.label;
    if (!key.picture.empty()) {
      record->pictures.push_back(
          {fmt::format("Frame {}, {:.3f} s: {}", key.view.frame, key.view.time_s, key.label),
           Jpeg(key.picture)});
    }
  }
  std::sort(record->views.begin(), record->views.end(),
            [](const report::BodyView& a, const report::BodyView& b) { return a.frame < b.frame; });
  for (size_t i = 0; i < record->views.size(); ++i) {
    if (largest_ && record->views[i].frame == largest_->view.frame) {
      record->first_view = static_cast<int>(i);
    }
  }
}

}  // namespace softforce::pipeline
