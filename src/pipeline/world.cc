#include "softforce/pipeline/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"

namespace softforce::pipeline {
namespace {

mesh::TetMesh LoadMesh(const scene::MeshFile& file) {
  mesh::TetMesh mesh = mesh::ReadMesh(file.file, file.metres_per_unit);
  mesh::CheckMesh(mesh, file.file.string());
  return file.order == 2 ? mesh::RaiseOrder(mesh) : mesh::LowerOrder(mesh);
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

std::string GroupNames(const mesh::TetMesh& mesh) {
  std::vector<std::string> names;
  for (const auto& [name, triangles] : mesh.surface_groups) names.push_back(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// All nodes, with those between corners, of the surface triangles of a named group.
std::set<int> NodesOfGroup(const std::string& group, const mesh::TetMesh& mesh,
                           const mesh::Surface& surface, const std::string& where) {
  const auto found = mesh.surface_groups.find(group);
  if (found == mesh.surface_groups.end()) {
    throw base::InputError(where, fmt::format("the mesh has no surface group \"{}\"; it has: {}",
                                              group, GroupNames(mesh)));
  }
  std::set<std::array<int, 3>> wanted;
  for (std::array<int, 3> corners : found->second) {
    std::sort(corners.begin(), corners.end());
    wanted.insert(corners);
  }
  std::set<int> nodes;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    std::array<int, 3> corners{surface.triangles(0, t), surface.triangles(1, t),
                               surface.triangles(2, t)};
    std::sort(corners.begin(), corners.end());
    if (wanted.count(corners) == 0) continue;
    for (int i = 0; i < surface.triangles.rows(); ++i) nodes.insert(surface.triangles(i, t));
  }
  return nodes;
}

std::vector<int> FixedNodes(const scene::Scene& scene, const mesh::TetMesh& mesh,
                            const mesh::Surface& surface) {
  constexpr double kRounding = 1e-9;  // m; so that a box flush with a face includes it
  std::set<int> fixed;
  for (size_t i = 0; i < scene.fixed.size(); ++i) {
    const scene::FixedRegion& region = scene.fixed[i];
    const std::string where = fmt::format("{}: body: fixed: [{}]", scene.file.string(), i);
    std::set<int> nodes;
    if (!region.group.empty()) {
      nodes = NodesOfGroup(region.group, mesh, surface, where);
    } else {
      for (int node = 0; node < mesh.num_nodes(); ++node) {
        const Eigen::Vector3d X = mesh.nodes.col(node);
        if (((X - region.box_min).array() >= -kRounding).all() &&
            ((region.box_max - X).array() >= -kRounding).all()) {
          nodes.insert(node);
        }
      }
    }
    if (nodes.empty()) {
      const Eigen::Vector3d low = 1000 * mesh.nodes.rowwise().minCoeff();
      const Eigen::Vector3d high = 1000 * mesh.nodes.rowwise().maxCoeff();
      throw base::InputError(where,
                             fmt::format("holds no node of the mesh, which spans {:.4g} to {:.4g}, "
                                         "{:.4g} to {:.4g}, {:.4g} to "
                                         "{:.4g} mm",
                                         low.x(), high.x(), low.y(), high.y(), low.z(), high.z()),
                             "Check the box against the mesh, and the mesh's unit.");
    }
    fixed.insert(nodes.begin(), nodes.end());
  }
  return {fixed.begin(), fixed.end()};
}

std::vector<fem::Cable> Cables(const scene::Scene& scene, const mesh::TetMesh& mesh,
                               const mesh::Surface& surface) {
  std::vector<fem::Cable> cables;
  for (const scene::Actuator& actuator : scene.actuators) {
    const std::string where =
        fmt::format("{}: actuators: \"{}\"", scene.file.string(), actuator.name);
    if (actuator.type != scene::ActuatorType::kCable) {
      throw base::InputError(where, "pressure chambers are not available in this version",
                             "Leave the actuator out, or describe it by cables.");
    }
    fem::Cable cable{actuator.name, {}, actuator.guide};
    for (const Eigen::Vector3d& place : actuator.points) {
      const BodyPoint point = PlaceOnSurface(surface, mesh.nodes, place, where + ": points");
      cable.points.push_back(mesh::PatchWeights(surface, mesh.nodes, point.at, actuator.patch));
    }
    cables.push_back(std::move(cable));
  }
  return cables;
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

World BuildWorld(const scene::Scene& scene) {
  World world;
  const std::string file = scene.file.string();
  fem::Body body;
  body.mesh = LoadMesh(scene.mesh);
  world.surface = mesh::ExtractSurface(body.mesh);
  body.materials = MaterialsOf(scene, body.mesh);
  body.fixed_nodes = FixedNodes(scene, body.mesh, world.surface);
  body.cables = Cables(scene, body.mesh, world.surface);
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

std::vector<fem::CableCommand> CommandsAt(const scene::Scene& scene, double time_s) {
  std::vector<fem::CableCommand> commands;
  if (scene.actuators.empty()) return commands;
  const Eigen::VectorXd inputs = scene.actuation.At(time_s);
  for (size_t a = 0; a < scene.actuators.size(); ++a) {
    const bool tension = scene.actuators[a].input == scene::ActuatorInput::kTension;
    commands.push_back({tension ? fem::CableInput::kTension : fem::CableInput::kDisplacement,
                        inputs(static_cast<Eigen::Index>(a))});
  }
  return commands;
}

}  // namespace softforce::pipeline
