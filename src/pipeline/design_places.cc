// Where the markers of a design may sit, and where its forces may act.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "pipeline/design_task.h"
#include "softforce/base/input_error.h"
#include "softforce/design/candidate_spacing.h"
#include "softforce/estimation/location_estimator.h"
#include "softforce/mesh/spread_points.h"
#include "softforce/mesh/surface_groups.h"
#include "softforce/mesh/surface_walk.h"

namespace softforce::pipeline {
namespace {

constexpr double kPlaces = 300;      // about so many for markers, unless a spacing is asked for
constexpr double kClosest = 1.5;     // marker sizes between two of them at least
constexpr int kRim = 8;              // points of a marker's rim that must lie on the surface
constexpr double kRimLift = 0.1;     // marker sizes that they may be off it
constexpr double kRimFacing = 0.87;  // cosine: and turned against its middle

mesh::SurfacePoint MiddleOf(int triangle) { return {triangle, Eigen::Vector3d::Constant(1.0 / 3)}; }

bool IsSelector(const std::string& text) {
  for (const char* word : {"(", "-min", "-max", "cavity", "outer"}) {
    if (text.find(word) != std::string::npos) return true;
  }
  return false;
}

// Whether all nodes that carry a point are held.
class Held {
 public:
  explicit Held(const World& world)
      : world_(world),
        nodes_(world.solver->body().fixed_nodes.begin(), world.solver->body().fixed_nodes.end()) {}

  bool operator()(const mesh::SurfacePoint& at) const {
    const mesh::NodalWeights weights = mesh::ShapeFunctions(world_.surface, at);
    for (size_t n = 0; n < weights.nodes.size(); ++n) {
      if (std::abs(weights.weights[n]) > 1e-9 && nodes_.count(weights.nodes[n]) == 0) return false;
    }
    return true;
  }

 private:
  const World& world_;
  std::set<int> nodes_;
};

// Whether a marker of the given size lies flat on the body there, and does not hang over an edge.
bool HasRoom(const World& world, const mesh::SurfacePoint& at, double size) {
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  const Eigen::Vector3d middle = mesh::Position(world.surface, X, at);
  const Eigen::Vector3d normal = mesh::Normal(world.surface, X, at);
  const Eigen::Vector3d right = normal.unitOrthogonal(), up = normal.cross(right);
  for (int i = 0; i < kRim; ++i) {
    const double angle = 2 * M_PI * i / kRim;
    const mesh::SurfaceProjection rim = mesh::ClosestSurfacePoint(
        world.surface, X, middle + size / 2 * (std::cos(angle) * right + std::sin(angle) * up));
    if (rim.distance > kRimLift * size) return false;
    if (mesh::Normal(world.surface, X, rim.at).dot(normal) < kRimFacing) return false;
  }
  return true;
}

std::vector<int> AllTriangles(const World& world) {
  std::vector<int> all(world.surface.num_triangles());
  for (int t = 0; t < world.surface.num_triangles(); ++t) all[t] = t;
  return all;
}

}  // namespace

double AreaOf(const World& world, const std::vector<int>& triangles) {
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  double area = 0;
  for (const int t : triangles) {
    const Eigen::Vector3d a = X.col(world.surface.triangles(0, t));
    const Eigen::Vector3d ab = X.col(world.surface.triangles(1, t)) - a;
    const Eigen::Vector3d ac = X.col(world.surface.triangles(2, t)) - a;
    area += ab.cross(ac).norm() / 2;
  }
  return area;
}

std::vector<int> TrianglesOf(const World& world, const std::string& what,
                             const std::string& option) {
  const bool is_group = world.mesh().surface_groups.count(what) > 0;
  if (is_group || !IsSelector(what)) {
    return mesh::GroupTriangles(what, world.mesh(), world.surface, option);
  }
  mesh::TetMesh named = world.mesh();
  named.surface_groups.clear();
  named = mesh::WithSurfaceGroups(std::move(named), {"it=" + what}, option);
  std::set<int> triangles;
  for (const auto& [name, corners] : named.surface_groups) {
    for (const int t : mesh::GroupTriangles(name, named, world.surface, option))
      triangles.insert(t);
  }
  return {triangles.begin(), triangles.end()};
}

std::vector<int> MarkerTriangles(const World& world, const DesignOptions& options) {
  return options.on.empty() ? AllTriangles(world) : TrianglesOf(world, options.on, "--on");
}

std::vector<mesh::SurfacePoint> MarkerPlaces(const World& world, std::vector<int> triangles,
                                             const MarkerEyes& eyes, const DesignOptions& options,
                                             double* spacing) {
  const double marker_size = options.sight.marker_size;
  triangles.erase(
      std::remove_if(triangles.begin(), triangles.end(),
                     [&](int t) { return eyes.NumCameras(MiddleOf(t)) < eyes.needed(); }),
      triangles.end());
  if (triangles.empty()) {
    throw base::InputError(
        "--on " + (options.on.empty() ? "(all of the body)" : options.on),
        fmt::format("no part of it is seen by {} of the cameras", eyes.needed()),
        "Check where the cameras stand (softforce register), take another surface, or leave the "
        "cameras out: --noise \"0.1 mm\".");
  }
  *spacing = options.spacing > 0
                 ? options.spacing
                 : std::max(std::sqrt(design::kFilling * AreaOf(world, triangles) / kPlaces),
                            kClosest * marker_size);
  const Held held(world);
  std::vector<mesh::SurfacePoint> places = mesh::SpreadPoints(
      world.surface, world.mesh().nodes, triangles, *spacing, [&](const mesh::SurfacePoint& at) {
        return !held(at) && HasRoom(world, at, marker_size) && eyes.NumCameras(at) >= eyes.needed();
      });
  if (places.empty()) {
    throw base::InputError("--on " + (options.on.empty() ? "(all of the body)" : options.on),
                           fmt::format("it has no place for a marker of {:.3g} mm that is not "
                                       "held and wholly seen",
                                       1e3 * marker_size),
                           "Take smaller markers or another surface.");
  }
  return places;
}

LoadSurface LoadsOn(const World& world, const scene::Scene& scene, const DesignOptions& options) {
  LoadSurface loads;
  if (!options.loads.empty()) {
    loads.triangles = TrianglesOf(world, options.loads, "--loads");
  } else {
    const Eigen::Matrix3Xd& X = world.mesh().nodes;
    const std::vector<int> face =
        mesh::SmoothFaces(world.surface, X, estimation::LocationOptions().crease);
    std::set<int> wanted;
    for (const scene::Candidate& candidate : scene.forces.candidates) {
      wanted.insert(
          face[mesh::ClosestSurfacePoint(world.surface, X, candidate.position).at.triangle]);
    }
    for (int t = 0; t < world.surface.num_triangles(); ++t) {
      if (wanted.count(face[t]) > 0) loads.triangles.push_back(t);
    }
  }
  const Held held(world);
  loads.triangles.erase(std::remove_if(loads.triangles.begin(), loads.triangles.end(),
                                       [&](int t) { return held(MiddleOf(t)); }),
                        loads.triangles.end());
  if (loads.triangles.empty()) {
    throw base::InputError("--loads " + options.loads, "all of it is held",
                           "Name a surface on which forces move the body.");
  }
  loads.area = AreaOf(world, loads.triangles);
  return loads;
}

std::vector<mesh::SurfacePoint> LoadPlaces(const World& world, const LoadSurface& loads,
                                           double spacing) {
  const Held held(world);
  return mesh::SpreadPoints(world.surface, world.mesh().nodes, loads.triangles, spacing,
                            [&](const mesh::SurfacePoint& at) { return !held(at); });
}

std::vector<mesh::SurfacePoint> FreeTriangles(const World& world) {
  const Held held(world);
  std::vector<mesh::SurfacePoint> middles;
  for (int t = 0; t < world.surface.num_triangles(); ++t) {
    if (!held(MiddleOf(t))) middles.push_back(MiddleOf(t));
  }
  return middles;
}

design::SampledLoad LoadAt(const World& world, const scene::Scene& scene,
                           const mesh::SurfacePoint& at, double size) {
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  const Eigen::Vector3d place = mesh::Position(world.surface, X, at);
  const scene::Candidate* nearest = nullptr;
  double distance = std::numeric_limits<double>::infinity();
  for (const scene::Candidate& candidate : scene.forces.candidates) {
    const double d = (candidate.position - place).norm();
    if (d >= distance) continue;
    distance = d;
    nearest = &candidate;
  }
  design::SampledLoad load;
  load.at = at;
  const Eigen::Vector3d inward = -mesh::Normal(world.surface, X, at);
  load.force = size * inward;
  switch (nearest->direction) {
    case scene::ForceDirection::kFree:
      load.directions = Eigen::Matrix3d::Identity();
      break;
    case scene::ForceDirection::kNormal:
      load.directions = inward;
      break;
    case scene::ForceDirection::kFixed:
      load.directions = nearest->fixed_direction;
      load.force = size * nearest->fixed_direction;
      break;
  }
  return load;
}

}  // namespace softforce::pipeline
