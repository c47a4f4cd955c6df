#include "softforce/pipeline/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pipeline/actuators.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"
#include "softforce/scene/fixed_nodes.h"

namespace softforce::pipeline {
namespace {

mesh::TetMesh LoadMesh(const scene::MeshFile& file) {
  mesh::TetMesh mesh = mesh::ReadMesh(file.file, file.metres_per_unit);
  mesh::CheckMesh(mesh, file.file.string());
  return mesh::WithOrder(mesh, file.order);
}

std::vector<fem::Material> MaterialsOf(const scene::Scene& scene, const mesh::TetMesh& mesh) {
  std::vector<fem::Material> materials;
  for (const std::string& region : mesh.region_names) {
    auto found = scene.materials.find(region);
    if (found == scene.materials.end()) found = scene.materials.find("");
    if (found == scene.materials.end()) {
      throw base::InputError(
          scene.file.string() + ": body: material",
          fmt::format("the mesh has a region \"{}\" for which no material is given", region));
    }
    materials.push_back(found->second);
  }
  for (const auto& [region, material] : scene.materials) {
    const auto& names = mesh.region_names;
    if (region.empty() || std::find(names.begin(), names.end(), region) != names.end()) continue;
    throw base::InputError(scene.file.string() + ": body: material",
                           fmt::format("region \"{}\" is not in the mesh; it has: \"{}\"", region,
                                       fmt::join(names, "\", \"")));
  }
  return materials;
}

Eigen::Matrix3Xd Directions(const scene::Candidate& candidate, const Eigen::Vector3d& normal) {
  switch (candidate.direction) {
    case scene::ForceDirection::kFree:
      return Eigen::Matrix3d::Identity();
    case scene::ForceDirection::kNormal:
      return -normal;  // a push
    case scene::ForceDirection::kFixed:
      return candidate.fixed_direction;
  }
  return {};
}

void RefuseMarkersAtOnePlace(const scene::Scene& scene) {
  constexpr double kSamePlace = 1e-4;  // m; no two markers can be painted that close
  const std::vector<scene::MarkerPoint>& points = scene.markers.points;
  for (size_t i = 0; i < points.size(); ++i) {
    for (size_t j = i + 1; j < points.size(); ++j) {
      if ((points[i].position - points[j].position).norm() > kSamePlace) continue;
      throw base::InputError(
          scene.file.string() + ": markers",
          fmt::format("ids {} and {} are at one place", points[i].id, points[j].id));
    }
  }
}

// A single marker is alone on the whole body.
double SmallestSpacing(const std::vector<scene::MarkerPoint>& points, const mesh::TetMesh& mesh) {
  double smallest = (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).norm();
  for (size_t i = 0; i < points.size(); ++i) {
    for (size_t j = i + 1; j < points.size(); ++j) {
      smallest = std::min(smallest, (points[i].position - points[j].position).norm());
    }
  }
  return smallest;
}

}  // namespace

BodyPoint PlaceOnSurface(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                         const Eigen::Vector3d& place, const std::string& where) {
  const mesh::SurfaceProjection found = mesh::ClosestSurfacePoint(surface, X, place);
  if (!(found.distance <= kSurfaceTolerance)) {
    throw base::InputError(
        where,
        fmt::format(
            "({:.4g} {:.4g} {:.4g}) mm lies {:.3g} mm off the body's surface, at most {:.3g} mm is "
            "allowed; the nearest point of the surface is ({:.4g} {:.4g} {:.4g}) mm",
            1e3 * place.x(), 1e3 * place.y(), 1e3 * place.z(), 1e3 * found.distance,
            1e3 * kSurfaceTolerance, 1e3 * found.position.x(), 1e3 * found.position.y(),
            1e3 * found.position.z()),
        "Check the place, its unit, and that it is given in the mesh's frame.");
  }
  return {found.at, mesh::ShapeFunctions(surface, found.at), place - found.position};
}

World BuildWorld(const scene::Scene& scene) { return BuildWorld(scene, LoadMesh(scene.mesh)); }

World BuildWorld(const scene::Scene& scene, mesh::TetMesh mesh) {
  World world;
  const std::string file = scene.file.string();
  fem::Body body;
  body.mesh = std::move(mesh);
  world.surface = mesh::ExtractSurface(body.mesh);
  body.materials = MaterialsOf(scene, body.mesh);
  body.fixed_nodes = scene::FixedNodes(scene, body.mesh, world.surface);
  body.cables = Cables(scene, body.mesh, world.surface);
  body.chambers = Chambers(scene, body.mesh, world.surface);
  body.gravity = scene.gravity;
  body.density = scene.density;

  for (const scene::Candidate& candidate : scene.forces.candidates) {
    const BodyPoint point =
        PlaceOnSurface(world.surface, body.mesh.nodes, candidate.position,
                       fmt::format("{}: forces: candidates: id {}", file, candidate.id));
    world.sites.push_back(
        {std::to_string(candidate.id),
         mesh::PatchWeights(world.surface, body.mesh.nodes, point.at, scene.forces.patch),
         Directions(candidate, mesh::Normal(world.surface, body.mesh.nodes, point.at))});
    if (candidate.direction == scene::ForceDirection::kNormal) world.sites.back().lowest = 0;
  }
  for (const scene::MarkerPoint& marker : scene.markers.points) {
    world.markers.push_back(PlaceOnSurface(world.surface, body.mesh.nodes, marker.position,
                                           fmt::format("{}: markers: id {}", file, marker.id)));
  }
  RefuseMarkersAtOnePlace(scene);
  world.marker_spacing = SmallestSpacing(scene.markers.points, body.mesh);
  world.solver = std::make_unique<fem::StaticSolver>(std::move(body), file + ": body");
  return world;
}

}  // namespace softforce::pipeline
