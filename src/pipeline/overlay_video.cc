#include "pipeline/overlay_video.h"

#include <fmt/format.h>

#include "softforce/render/overlay.h"

namespace softforce::pipeline {
namespace {

constexpr double kOverlayRate = 30;  // frames/s at which overlay.mp4 plays

render::MarkerMark MarkOf(MarkerStatus status) {
  switch (status) {
    case MarkerStatus::kSeen:
      return render::MarkerMark::kSeen;
    case MarkerStatus::kOneCamera:
      return render::MarkerMark::kOneCamera;
    case MarkerStatus::kHidden:
      return render::MarkerMark::kHidden;
    case MarkerStatus::kRejected:
      return render::MarkerMark::kRejected;
  }
  return render::MarkerMark::kHidden;
}

render::OverlayScene Content(const scene::Scene& scene, const World& world,
                             const FrameResult& result, const Eigen::Matrix3Xd& x) {
  render::OverlayScene content;
  content.surface = &world.surface;
  content.x = &x;
  int in_view = 0;
  for (const MarkerResult& marker : result.markers) {
    const bool measured = marker.measured.allFinite();
    in_view += marker.status != MarkerStatus::kHidden;
    content.markers.push_back({std::to_string(marker.id), MarkOf(marker.status),
                               measured ? marker.measured : marker.model});
  }
  for (const ForceResult& force : result.forces) {
    content.forces.push_back(
        {fmt::format("F{}", force.candidate), force.position, force.force, force.NormSd()});
  }
  for (const fem::Cable& cable : world.solver->body().cables) {
    render::OverlayCable path;
    for (const mesh::NodalWeights& point : cable.points) path.path.push_back(point.Apply(x));
    path.path.push_back(cable.guide);
    content.cables.push_back(path);
  }
  content.caption = {
      fmt::format("{}   frame {}   {:.3f} s", scene.name, result.frame, result.time_s),
      fmt::format("{} of {} markers in view", in_view, result.markers.size())};
  if (result.forces.empty()) {
    content.caption.push_back(fmt::format("no forces: {}", estimation::Name(result.status)));
  }
  return content;
}

}  // namespace

OverlayVideo::OverlayVideo(const std::filesystem::path& file, const scene::Scene& scene,
                           const World& world, const camera::Rig& rig, int width)
    : scene_(scene), world_(world), rig_(rig), width_(width), writer_(file, kOverlayRate) {}

cv::Mat OverlayVideo::Draw(const vision::FrameSet& frame, const FrameResult& result,
                           const Eigen::Matrix3Xd& u, const Eigen::Isometry3d& T_rig_robot) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + u;
  const render::OverlayScene content = Content(scene_, world_, result, x);
  std::vector<cv::Mat> pictures;
  std::vector<std::string> names;
  for (size_t c = 0; c < rig_.cameras.size(); ++c) {
    const camera::Camera& camera = rig_.cameras[c];
    pictures.push_back(
        render::DrawOverlay(frame.pictures[c], camera, camera.T_camera_rig * T_rig_robot, content));
    names.push_back(camera.name);
  }
  return render::SideBySide(pictures, names, width_);
}

}  // namespace softforce::pipeline
