#include "pipeline/viewer_painter.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

namespace softforce::pipeline {

std::shared_ptr<const FrameInWork> CopyForViewers(const FrameInWork& frame) {
  auto copy = std::make_shared<FrameInWork>();
  copy->set = frame.set;
  copy->result = frame.result;
  copy->T_rig_robot = frame.T_rig_robot;
  copy->u = frame.u;
  copy->largest_displacement = frame.largest_displacement;
  copy->overlay = frame.overlay;
  return copy;
}

ViewerPainter::ViewerPainter(const scene::Scene& scene, const World& world, const camera::Rig& rig,
                             int width, const OverlayLayers& layers)
    : width_(width), overlay_(std::filesystem::path(), scene, world, rig, width, layers) {}

void ViewerPainter::Note(const FrameResult& result) {
  const std::lock_guard<std::mutex> lock(mutex_);
  history_.Add(result);
  rate_.Add(FrameRate::Clock::now());
}

cv::Mat ViewerPainter::Draw(const FrameInWork& frame) {
  if (frame.overlay.empty()) {
    ForceHistory history;
    double rate = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      history = history_;
      rate = rate_.PerSecond(FrameRate::Clock::now());
    }
    FrameInWork with_stress = frame;
    if (overlay_.wants_stress()) overlay_.AddStress(&with_stress);
    cv::Mat drawn = overlay_.Draw(with_stress, fmt::format("{:.0f} frames/s", rate));
    overlay_.DrawHistory(frame, history, drawn);
    return drawn;
  }
  if (frame.overlay.cols <= width_) return frame.overlay;
  cv::Mat small;
  const double factor = static_cast<double>(width_) / frame.overlay.cols;
  cv::resize(frame.overlay, small, {}, factor, factor, cv::INTER_AREA);
  return small;
}

}  // namespace softforce::pipeline
