#include "pipeline/overlay_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "softforce/fem/stress.h"
#include "softforce/render/overlay.h"

namespace softforce::pipeline {
namespace {

constexpr double kOverlayRate = 30;   // frames/s at which overlay.mp4 plays
constexpr double kLeastScale = 0.1;   // mm, of displacements: below it there is but noise
constexpr double kLeastStress = 0.1;  // kPa, likewise
// Of the nodes, that the colours of stress tell apart: it peaks beyond all use at supports and at
// the rims of loads.
constexpr double kShownStress = 0.99;
constexpr double kAxes = 0.15;        // of the body's largest side
constexpr double kChartSpan = 10;     // s
constexpr double kLeastSpan = 1;      // s
constexpr double kChartShare = 0.22;  // of the pictures' height

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

std::string NameOf(const ForceResult& force) { return fmt::format("F{}", force.identity); }

void AddMarkers(const FrameResult& result, bool regions, render::OverlayScene* content) {
  for (const MarkerResult& marker : result.markers) {
    const bool measured = marker.measured.allFinite();
    render::OverlayMarker drawn{std::to_string(marker.id), MarkOf(marker.status),
                                measured ? marker.measured : marker.model, Eigen::Matrix3d::Zero()};
    if (regions && marker.status == MarkerStatus::kHidden) {
      drawn.covariance = marker.expected_covariance;
    }
    content->markers.push_back(drawn);
  }
}

void AddForces(const FrameResult& result, bool regions, render::OverlayScene* content) {
  for (const ForceResult& force : result.forces) {
    render::OverlayForce drawn{NameOf(force),  force.position,          force.force,
                               force.NormSd(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
    if (regions) {
      drawn.covariance = force.covariance;
      drawn.place_covariance = force.place_covariance;
    }
    content->forces.push_back(drawn);
  }
}

void AddBody(const scene::Scene& scene, const World& world, const OverlayLayers& layers,
             const FrameInWork& frame, const Eigen::Matrix3Xd& x, render::OverlayScene* content) {
  content->surface = &world.surface;
  content->x = &x;
  if (layers.stress) {
    content->field =
        render::SurfaceField{"von Mises stress", "kPa", 1e-3 * frame.stress,
                             render::RoundUp(std::max(1e-3 * frame.largest_stress, kLeastStress))};
  } else if (layers.displacement) {
    const double largest_mm = 1e3 * frame.largest_displacement;
    content->field =
        render::SurfaceField{"displacement", "mm", 1e3 * frame.u.colwise().norm().transpose(),
                             render::RoundUp(std::max(largest_mm, kLeastScale))};
  }
  if (layers.cables) {
    for (const fem::Cable& cable : world.solver->body().cables) {
      render::OverlayCable path;
      for (const mesh::NodalWeights& point : cable.points) path.path.push_back(point.Apply(x));
      path.path.push_back(cable.guide);
      content->cables.push_back(path);
    }
  }
  if (layers.candidates) {
    for (size_t c = 0; c < world.sites.size(); ++c) {
      content->candidates.push_back(
          {std::to_string(scene.forces.candidates[c].id), world.sites[c].at.Apply(x)});
    }
  }
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  if (layers.axes) {
    content->axes = kAxes * (X.rowwise().maxCoeff() - X.rowwise().minCoeff()).maxCoeff();
  }
}

std::vector<std::string> Caption(const scene::Scene& scene, const FrameResult& result) {
  int in_view = 0, absent = 0;
  for (const MarkerResult& marker : result.markers) {
    const bool hidden = marker.status == MarkerStatus::kHidden;
    in_view += !hidden;
    absent += hidden && marker.expected_absent;
  }
  std::vector<std::string> lines{
      fmt::format("{}   frame {}   {:.3f} s", scene.name, result.frame, result.time_s),
      fmt::format("{} of {} markers in view", in_view, result.markers.size())};
  if (absent > 0) lines.back() += fmt::format(", {} turned away or covered", absent);
  if (!result.ok()) {
    lines.push_back(fmt::format("no forces: {}", estimation::Name(result.status)));
  } else if (result.forces.empty()) {
    lines.push_back("no force");
  }
  return lines;
}

}  // namespace

OverlayVideo::OverlayVideo(const std::filesystem::path& file, const scene::Scene& scene,
                           const World& world, const camera::Rig& rig, int width,
                           const OverlayLayers& layers)
    : scene_(scene), world_(world), rig_(rig), width_(width), layers_(layers) {
  if (!file.empty()) writer_.emplace(file, kOverlayRate);
}

void OverlayVideo::AddStress(FrameInWork* frame) {
  frame->stress = fem::NodalVonMises(world_.solver->body(), frame->u);
  // Of a cell that is inside out there is no stress; it is drawn as the least.
  frame->stress = frame->stress.array().isFinite().select(frame->stress, 0);
  std::vector<double> values(frame->stress.begin(), frame->stress.end());
  const auto shown = values.begin() +
                     static_cast<std::ptrdiff_t>(kShownStress * static_cast<double>(values.size()));
  std::nth_element(values.begin(), shown, values.end());
  largest_stress_ = std::max(largest_stress_, *shown);
  frame->largest_stress = largest_stress_;
}

cv::Mat OverlayVideo::Draw(const FrameInWork& frame) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + frame.u;
  render::OverlayScene content;
  AddBody(scene_, world_, layers_, frame, x, &content);
  if (layers_.markers) AddMarkers(frame.result, layers_.regions, &content);
  if (layers_.forces) AddForces(frame.result, layers_.regions, &content);
  content.caption = Caption(scene_, frame.result);
  render::OverlayOptions options;
  options.net = layers_.net;
  std::vector<cv::Mat> pictures;
  std::vector<std::string> names;
  for (size_t c = 0; c < rig_.cameras.size(); ++c) {
    const camera::Camera& camera = rig_.cameras[c];
    pictures.push_back(render::DrawOverlay(
        frame.set.pictures[c], camera, camera.T_camera_rig * frame.T_rig_robot, content, options));
    names.push_back(camera.name);
  }
  return render::SideBySide(pictures, names, width_);
}

void OverlayVideo::Remember(const FrameResult& result) {
  for (const ForceResult& force : result.forces) {
    const std::string name = NameOf(force);
    const auto same = [&](const render::ChartSeries& one) { return one.label == name; };
    if (std::none_of(history_.begin(), history_.end(), same)) {
      history_.push_back({name, {}, {}, {}});
    }
  }
  for (render::ChartSeries& one : history_) {
    const auto force = std::find_if(result.forces.begin(), result.forces.end(),
                                    [&](const ForceResult& f) { return NameOf(f) == one.label; });
    const bool known = force != result.forces.end();
    one.time_s.push_back(result.time_s);
    one.value.push_back(known ? force->force.norm() : NAN);
    one.sd.push_back(known ? force->NormSd() : NAN);
    size_t old = 0;
    while (one.time_s[old] < result.time_s - kChartSpan) ++old;
    for (std::vector<double>* values : {&one.time_s, &one.value, &one.sd}) {
      values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(old));
    }
  }
}

void OverlayVideo::Add(const FrameResult& result, const cv::Mat& drawn) {
  if (!layers_.chart) {
    writer_->Add(drawn);
    return;
  }
  if (!std::isfinite(first_s_)) first_s_ = result.time_s;
  Remember(result);
  const int height = 2 * static_cast<int>(std::lround(0.5 * kChartShare * drawn.rows));
  const double span = std::clamp(result.time_s - first_s_, kLeastSpan, kChartSpan);
  cv::Mat with_chart;
  cv::vconcat(drawn,
              render::DrawForceChart({drawn.cols, height}, history_,
                                     std::max(result.time_s, first_s_ + kLeastSpan), span),
              with_chart);
  writer_->Add(with_chart);
}

}  // namespace softforce::pipeline
