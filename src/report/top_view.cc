#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/format.h"
#include "report/plots.h"
#include "report/svg.h"

namespace softforce::report {
namespace {

using Outline = std::vector<Eigen::Vector3d>;  // m, rig frame

// The rectangle around the board's points.
Outline BoardOutline(const std::vector<Eigen::Vector3d>& board, const Eigen::Isometry3d& T) {
  Eigen::Vector3d low = board[0], high = board[0];
  for (const Eigen::Vector3d& point : board) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return {T * low, T * Eigen::Vector3d(high.x(), low.y(), 0), T * high,
          T * Eigen::Vector3d(low.x(), high.y(), 0)};
}

// The horizontal field of view up to `depth` (m); at most 60° to each side are drawn.
Outline CameraOutline(const camera::Camera& camera, double depth) {
  const double half = std::min(camera.width / 2.0 / camera.lens.fx, std::tan(1.05));
  const Eigen::Isometry3d T = camera.T_camera_rig.inverse();
  return {T * Eigen::Vector3d::Zero(), T * Eigen::Vector3d(-half * depth, 0, depth),
          T * Eigen::Vector3d(half * depth, 0, depth)};
}

std::string Polygon(const Outline& outline, double scale, double x0, double z0) {
  std::string d;
  for (size_t i = 0; i < outline.size(); ++i) {
    d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", scale * (outline[i].x() - x0),
                     scale * (z0 - outline[i].z()));
  }
  return d + "Z";
}

}  // namespace

std::string TopView(const CalibrationRecord& record) {
  const calibration::Calibration& result = record.result;
  std::vector<Outline> boards, cameras;
  double nearest = INFINITY;
  for (const calibration::ViewFit& view : result.views) {
    if (!view.used) continue;
    boards.push_back(BoardOutline(record.input.board, view.T_rig_board));
    nearest = std::min(nearest, view.T_rig_board.translation().norm());
  }
  for (const camera::Camera& camera : result.rig.cameras) {
    cameras.push_back(CameraOutline(camera, 0.25 * nearest));
  }
  double x_min = INFINITY, x_max = -INFINITY, z_min = INFINITY, z_max = -INFINITY;
  for (const std::vector<Outline>* outlines : {&boards, &cameras}) {
    for (const Outline& outline : *outlines) {
      for (const Eigen::Vector3d& p : outline) {
        x_min = std::min(x_min, p.x()), x_max = std::max(x_max, p.x());
        z_min = std::min(z_min, p.z()), z_max = std::max(z_max, p.z());
      }
    }
  }
  const double width = 440, height = 250, margin = 14, key = 20;
  const double scale = std::min((width - 2 * margin) / (x_max - x_min),
                                (height - 2 * margin - key) / (z_max - z_min));
  const double x0 = (x_min + x_max) / 2 - width / 2 / scale;
  const double z0 = z_max + margin / scale;
  Svg svg(width, height, "Cameras and boards from above");
  for (const Outline& board : boards) svg.Path(Polygon(board, scale, x0, z0), "board");
  for (size_t c = 0; c < cameras.size(); ++c) {
    svg.Path(Polygon(cameras[c], scale, x0, z0), "camera " + HueClass(static_cast<int>(c)),
             result.rig.cameras[c].name);
  }
  const double bar = RoundStep(0.25 * width / scale, 1);  // m
  svg.Line(margin, height - 6, margin + scale * bar, height - 6, "scale");
  svg.Text(margin + scale * bar + 6, height - 2,
           bar < 1 ? fmt::format("{:.4g} mm", 1e3 * bar) : fmt::format("{:.4g} m", bar));
  return svg.str();
}

}  // namespace softforce::report
