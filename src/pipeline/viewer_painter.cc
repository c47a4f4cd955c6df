#include "pipeline/viewer_painter.h"

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

cv::Mat ViewerPainter::Draw(const FrameInWork& frame) {
  cv::Mat picture = frame.overlay;
  if (picture.empty()) {
    FrameInWork with_stress = frame;
    if (overlay_.wants_stress()) overlay_.AddStress(&with_stress);
    picture = overlay_.Draw(with_stress);
  }
  if (picture.cols <= width_) return picture;
  cv::Mat small;
  const double factor = static_cast<double>(width_) / picture.cols;
  cv::resize(picture, small, {}, factor, factor, cv::INTER_AREA);
  return small;
}

}  // namespace softforce::pipeline
