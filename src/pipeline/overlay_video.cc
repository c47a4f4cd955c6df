#include "pipeline/overlay_video.h"

#include <algorithm>
#include <cmath>

#include "pipeline/frame_file.h"
#include "pipeline/overlay_content.h"
#include "softforce/fem/stress.h"
#include "softforce/render/side_by_side.h"

namespace softforce::pipeline {
namespace {

constexpr double kOverlayRate = 30;  // frames/s at which overlay.mp4 plays
// Of the nodes, that the colours of stress tell apart: it peaks beyond all use at supports and at
// the rims of loads.
constexpr double kShownStress = 0.99;

render::PictureRow RowOf(const FrameInWork& frame, int width) {
  std::vector<cv::Size> sizes;
  for (const cv::Mat& picture : frame.set.pictures) sizes.push_back(picture.size());
  return render::SideBySide(sizes, width);
}

}  // namespace

// An easel of a thread that draws, which goes back when it is done.
class OverlayVideo::Borrowed {
 public:
  explicit Borrowed(const OverlayVideo& from) : from_(from) {
    const std::lock_guard<std::mutex> lock(from_.mutex_);
    if (from_.easels_.empty()) return;
    easel_ = std::move(from_.easels_.back());
    from_.easels_.pop_back();
  }
  ~Borrowed() {
    const std::lock_guard<std::mutex> lock(from_.mutex_);
    from_.easels_.push_back(std::move(easel_));
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;

  render::Easel* easel() { return &easel_; }

 private:
  const OverlayVideo& from_;
  render::Easel easel_;
};

OverlayVideo::OverlayVideo(const std::filesystem::path& file, const scene::Scene& scene,
                           const World& world, const camera::Rig& rig, int width,
                           const OverlayLayers& layers)
    : scene_(scene), world_(world), rig_(rig), width_(width), layers_(layers) {
  if (!file.empty()) writer_.emplace(file, kOverlayRate);
}

void OverlayVideo::AddStress(FrameInWork* frame) {
  frame->stress = fem::NodalVonMises(world_.solver->body(), AsKept(frame->u));
  // Of a cell that is inside out there is no stress; it is drawn as the least.
  frame->stress = frame->stress.array().isFinite().select(frame->stress, 0);
  std::vector<double> values(frame->stress.begin(), frame->stress.end());
  const auto shown = values.begin() +
                     static_cast<std::ptrdiff_t>(kShownStress * static_cast<double>(values.size()));
  std::nth_element(values.begin(), shown, values.end());
  largest_stress_ = std::max(largest_stress_, *shown);
  frame->largest_stress = largest_stress_;
}

cv::Mat OverlayVideo::Draw(const FrameInWork& frame, const std::string& note) const {
  const Eigen::Matrix3Xd u = AsKept(frame.u);
  const Eigen::Matrix3Xd x = world_.mesh().nodes + u;
  render::OverlayScene content = OverlayContent(scene_, world_, layers_, frame, u, x);
  if (!note.empty()) content.caption.push_back(note);
  render::OverlayOptions options;
  options.net = layers_.net;
  const render::PictureRow row = RowOf(frame, width_);
  const int strip = layers_.chart ? ForceHistory::StripHeight(row.size.height) : 0;
  cv::Mat page(row.size + cv::Size(0, strip), CV_8UC3);
  for (const cv::Rect& cell : row.cells) {  // below pictures that are lower than others
    page(cv::Rect(cell.x, cell.br().y, cell.width, page.rows - cell.br().y)).setTo(0);
  }
  Borrowed borrowed(*this);
  for (size_t c = 0; c < rig_.cameras.size(); ++c) {
    const cv::Mat& picture = frame.set.pictures[c];
    const cv::Mat3b cell = page(row.cells[c]);
    const camera::Camera camera = render::Scaled(rig_.cameras[c], picture.size(), cell.size());
    render::PutPicture(picture, cell);
    render::DrawOverlay(cell, camera, camera.T_camera_rig * frame.T_rig_robot, content, options,
                        borrowed.easel());
    render::DrawName(cell, camera.name, borrowed.easel());
  }
  return page;
}

void OverlayVideo::DrawHistory(const FrameInWork& frame, const ForceHistory& history,
                               cv::Mat drawn) const {
  if (!layers_.chart) return;
  Borrowed borrowed(*this);
  history.Draw(drawn.rowRange(RowOf(frame, width_).size.height, drawn.rows), borrowed.easel());
}

void OverlayVideo::Add(const FrameInWork& frame) {
  history_.Add(frame.result);
  DrawHistory(frame, history_, frame.overlay);
  writer_->Add(frame.overlay);
}

}  // namespace softforce::pipeline
