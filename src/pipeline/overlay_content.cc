#include "pipeline/overlay_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/body_views.h"
#include "softforce/render/force_chart.h"

namespace softforce::pipeline {
namespace {

constexpr double kLeastScale = 0.1;      // mm, of displacements: below it there is but noise
constexpr double kLeastStress = 0.1;     // kPa, likewise
constexpr double kNearlyCertain = 0.99;  // beyond it the model's errors weigh more
constexpr double kAxes = 0.15;           // of the body's largest side

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
    render::OverlayForce drawn{ForceName(force), force.position,          force.force,
                               force.NormSd(),   Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
    if (regions) {
      drawn.covariance = force.covariance;
      drawn.place_covariance = force.place_covariance;
    }
    content->forces.push_back(drawn);
  }
}

void AddBody(const scene::Scene& scene, const World& world, const OverlayLayers& layers,
             const FrameInWork& frame, const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& x,
             render::OverlayScene* content) {
  content->surface = &world.surface;
  content->x = &x;
  if (layers.stress) {
    content->field =
        render::SurfaceField{"von Mises stress", "kPa", 1e-3 * frame.stress,
                             render::RoundUp(std::max(1e-3 * frame.largest_stress, kLeastStress))};
  } else if (layers.displacement) {
    const double largest_mm = 1e3 * frame.largest_displacement;
    content->field =
        render::SurfaceField{"displacement", "mm", 1e3 * u.colwise().norm().transpose(),
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
      scene.name, fmt::format("frame {}   {:.3f} s", result.frame, result.time_s),
      fmt::format("{} of {} markers in view", in_view, result.markers.size())};
  if (absent > 0) lines.back() += fmt::format(", {} turned away or covered", absent);
  if (!result.ok()) {
    lines.push_back(fmt::format("no forces: {}", estimation::Name(result.status)));
  } else if (result.forces.empty()) {
    lines.emplace_back("no force");
  }
  if (std::isfinite(result.probability) && !result.forces.empty()) {
    const bool near_1 = result.probability > kNearlyCertain;
    lines.push_back(near_1 ? fmt::format("places more than {:.0f} % certain", 100 * kNearlyCertain)
                           : fmt::format("places {:.0f} % certain", 100 * result.probability));
  }
  return lines;
}

}  // namespace

render::OverlayScene OverlayContent(const scene::Scene& scene, const World& world,
                                    const OverlayLayers& layers, const FrameInWork& frame,
                                    const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& x) {
  render::OverlayScene content;
  AddBody(scene, world, layers, frame, u, x, &content);
  if (layers.markers) AddMarkers(frame.result, layers.regions, &content);
  if (layers.forces) AddForces(frame.result, layers.regions, &content);
  content.caption = Caption(scene, frame.result);
  return content;
}

}  // namespace softforce::pipeline
