#include "pipeline/register_markers.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>

#include "pipeline/registration.h"
#include "softforce/base/input_error.h"
#include "softforce/calibration/point_pairs.h"

namespace softforce::pipeline {
namespace {

using base::InputError;
using Status = calibration::MarkerMatch::Status;

std::vector<calibration::KnownDot> KnownDots(const scene::Scene& scene, const World& world,
                                             const Eigen::Matrix3Xd& x) {
  std::vector<calibration::KnownDot> dots;
  for (const BodyPoint& marker : world.markers) {
    dots.push_back({marker.weights.Apply(x) + marker.offset,
                    mesh::Normal(world.surface, x, marker.at), scene.markers.size});
  }
  return dots;
}

[[noreturn]] void Refuse(const calibration::MarkerMatch& match, const scene::Scene& scene,
                         const std::vector<CameraDetections>& seen) {
  const std::string where = scene.file.string() + ": markers";
  std::string dots;
  for (const CameraDetections& camera : seen) {
    dots += fmt::format("{}{}", dots.empty() ? "" : " and ", camera.dots.size());
  }
  const size_t markers = scene.markers.points.size();
  if (match.status == Status::kAmbiguous) {
    throw InputError(
        where,
        fmt::format("their layout is symmetric: {} of {} dots fit in one way, and {} in another, "
                    "so the rig's place cannot be told",
                    match.matched, markers, match.rival),
        "Put a rough T_rig_robot (right within 20 degrees) into the rig file, "
        "paint one more dot off the pattern, or use fiducials or --pairs.");
  }
  if (match.status == Status::kTooFewSeen) {
    throw InputError(where,
                     fmt::format("the cameras see {} dots, and agree on {} places; {} markers are "
                                 "listed",
                                 dots, match.points, markers),
                     "Half of the markers, and at least four, must be in view of two cameras.");
  }
  throw InputError(
      where,
      fmt::format("at most {} of {} markers fit what the cameras see ({} dots)", match.matched,
                  markers, dots),
      "Nothing but its actuators may act on the body in that frame (--frame); check the markers' "
      "places, and that the rig file belongs to these cameras.");
}

MarkerPlacement ByDots(const scene::Scene& scene, const camera::Rig& rig,
                       const std::vector<calibration::KnownDot>& dots,
                       const std::vector<CameraDetections>& seen,
                       const calibration::MatchOptions& options) {
  if (rig.cameras.size() < 2) {
    throw InputError(scene.cameras.rig.string(), "has one camera; dots without labels need two",
                     "Use fiducials, tags as markers, or --pairs.");
  }
  std::vector<std::vector<calibration::DetectedSpot>> spots(seen.size());
  for (size_t c = 0; c < seen.size(); ++c) {
    for (const vision::Dot& dot : seen[c].dots) {
      spots[c].push_back({dot.centroid, dot.covariance, dot.long_axis});
    }
  }
  const auto match = calibration::MatchMarkers(rig, dots, spots, rig.T_rig_robot, options);
  if (!match.ok()) Refuse(match, scene, seen);
  MarkerPlacement placement{
      match.pose, fmt::format("by {} of {} dots", match.matched, dots.size()), {}};
  if (match.by_guess) {
    placement.warnings.push_back(fmt::format(
        "the layout of the dots is symmetric ({} fit in another way): T_rig_robot in the rig file "
        "decided",
        match.rival));
  }
  return placement;
}

// Where the picture of a tag's centre is: its diagonals cross there.
std::optional<Eigen::Vector2d> CentreOf(const vision::Tag& tag, const camera::Camera& camera) {
  std::array<Eigen::Vector3d, 4> corner;
  for (int i = 0; i < 4; ++i) {
    const auto at = camera::Unproject(camera.lens, tag.corners[i]);
    if (!at) return std::nullopt;
    corner[i] = at->homogeneous();
  }
  const Eigen::Vector3d cross = corner[0].cross(corner[2]).cross(corner[1].cross(corner[3]));
  const camera::Projection centre = camera::Project(camera.lens, cross / cross.z());
  if (!centre.visible) return std::nullopt;
  return centre.pixel;
}

MarkerPlacement ByTags(const scene::Scene& scene, const camera::Rig& rig,
                       const std::vector<calibration::KnownDot>& places,
                       const std::vector<CameraDetections>& seen,
                       const calibration::MatchOptions& options) {
  constexpr double kPixelSd = 0.3;  // px; bent tags, places measured by hand
  std::vector<vision::PointSighting> pairs;
  std::vector<std::string> names;
  double nearest_px_per_m = 0;
  for (int c = 0; c < static_cast<int>(seen.size()); ++c) {
    for (const vision::Tag& tag : seen[c].tags) {
      for (size_t m = 0; m < places.size(); ++m) {
        if (scene.markers.points[m].id != tag.id || scene.markers.family != tag.family) continue;
        const auto centre = CentreOf(tag, rig.cameras[c]);
        if (!centre) continue;
        pairs.push_back({places[m].p_robot, c, *centre, Eigen::Matrix2d::Identity()});
        names.push_back(fmt::format("tag {} in camera \"{}\"", tag.id, rig.cameras[c].name));
        const double side = (tag.corners[0] - tag.corners[1]).norm();
        nearest_px_per_m = std::max(nearest_px_per_m, side / scene.markers.size);
      }
    }
  }
  calibration::PairOptions typed;
  typed.pixel_sd = kPixelSd;
  typed.max_misfit =
      (options.max_misfit_px + options.max_misplacement * nearest_px_per_m) / kPixelSd;
  const auto found = calibration::RegisterByPairs(rig, pairs, typed);
  if (!found.ok()) {
    throw InputError(
        scene.file.string() + ": markers",
        fmt::format("the {} sightings of its tags do not tell where the rig stands", pairs.size()),
        "Four tags or more, not in a row, must be in view of one camera; nothing but its actuators "
        "may act on the body in that frame (--frame); check family, ids and places.");
  }
  MarkerPlacement placement{
      found.pose, fmt::format("by {} sightings of tags on the body", found.pose.num_points), {}};
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!found.wrong[i]) continue;
    placement.warnings.push_back(
        fmt::format("{} is {:.1f} px from where the others put it, and was left out", names[i],
                    found.misfit_px[i]));
  }
  return placement;
}

}  // namespace

Eigen::Matrix3Xd UnloadedBody(const World& world, const scene::Scene& scene, double time_s) {
  fem::Equilibrium state = world.solver->AtRest();
  fem::LoadCase load = state.load;
  load.actuation = ActuationAt(scene, time_s);
  const fem::SolveSummary solved = world.solver->Solve(load, &state);
  if (!solved.ok()) {
    throw InputError(scene.file.string(),
                     "the body has no equilibrium under its actuators: " + solved.BriefReport(),
                     solved.Advice());
  }
  return world.mesh().nodes + state.u;
}

MarkerPlacement PlaceByMarkers(const scene::Scene& scene, const camera::Rig& rig,
                               const vision::FrameSet& frame,
                               const calibration::MatchOptions& options) {
  const World world = BuildWorld(scene);
  const Eigen::Matrix3Xd x = UnloadedBody(world, scene, frame.time_s);
  const std::vector<calibration::KnownDot> places = KnownDots(scene, world, x);
  const std::vector<CameraDetections> seen = Detector(scene, rig).Markers(frame);
  return scene.markers.type == scene::MarkerType::kDot ? ByDots(scene, rig, places, seen, options)
                                                       : ByTags(scene, rig, places, seen, options);
}

}  // namespace softforce::pipeline
