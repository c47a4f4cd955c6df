#include "pipeline/actuators.h"

#include <fmt/format.h>

#include <algorithm>

#include "softforce/base/input_error.h"
#include "softforce/mesh/interior_point.h"
#include "softforce/mesh/surface_groups.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {
namespace {

std::string Where(const scene::Scene& scene, const scene::Actuator& actuator) {
  return fmt::format("{}: actuators: \"{}\"", scene.file.string(), actuator.name);
}

// A place on the surface, where a pull is spread over a patch, or inside the body.
mesh::NodalWeights CablePoint(const mesh::TetMesh& mesh, const mesh::Surface& surface,
                              const Eigen::Vector3d& place, double patch,
                              const std::string& where) {
  if (mesh::ClosestSurfacePoint(surface, mesh.nodes, place).distance > kSurfaceTolerance) {
    if (const auto inside = mesh::InteriorPoint(mesh, place)) return *inside;
  }
  const BodyPoint point = PlaceOnSurface(surface, mesh.nodes, place, where);
  return mesh::PatchWeights(surface, mesh.nodes, point.at, patch);
}

}  // namespace

std::vector<fem::Cable> Cables(const scene::Scene& scene, const mesh::TetMesh& mesh,
                               const mesh::Surface& surface) {
  std::vector<fem::Cable> cables;
  for (const scene::Actuator& actuator : scene.actuators) {
    if (actuator.type != scene::ActuatorType::kCable) continue;
    fem::Cable cable{actuator.name, {}, actuator.guide};
    for (const Eigen::Vector3d& place : actuator.points) {
      cable.points.push_back(
          CablePoint(mesh, surface, place, actuator.patch, Where(scene, actuator) + ": points"));
    }
    cables.push_back(std::move(cable));
  }
  return cables;
}

std::vector<fem::Chamber> Chambers(const scene::Scene& scene, const mesh::TetMesh& mesh,
                                   const mesh::Surface& surface) {
  std::vector<fem::Chamber> chambers;
  for (const scene::Actuator& actuator : scene.actuators) {
    if (actuator.type != scene::ActuatorType::kPressure) continue;
    const std::string where = Where(scene, actuator) + ": group";
    const std::vector<int> triangles = mesh::GroupTriangles(actuator.group, mesh, surface, where);
    if (triangles.empty()) {
      throw base::InputError(
          where,
          fmt::format("surface group \"{}\" has no triangle on the surface of the body",
                      actuator.group),
          "A chamber is a hollow of the mesh, and its group the hollow's walls.");
    }
    chambers.push_back({actuator.name, surface.triangles(Eigen::all, triangles)});
  }
  return chambers;
}

std::vector<estimation::ActuatorUncertainty> Uncertainties(const scene::Scene& scene) {
  std::vector<estimation::ActuatorUncertainty> uncertainties;
  for (const scene::ActuatorType type :
       {scene::ActuatorType::kCable, scene::ActuatorType::kPressure}) {
    for (const scene::Actuator& actuator : scene.actuators) {
      if (actuator.type == type) uncertainties.push_back(actuator.uncertainty);
    }
  }
  return uncertainties;
}

fem::Actuation ActuationOf(const std::vector<scene::Actuator>& actuators,
                           const Eigen::VectorXd& inputs) {
  fem::Actuation actuation;
  for (size_t a = 0; a < actuators.size(); ++a) {
    const double value = inputs(static_cast<Eigen::Index>(a));
    switch (actuators[a].input) {
      case scene::ActuatorInput::kTension:
        actuation.cables.push_back({fem::CableInput::kTension, value});
        break;
      case scene::ActuatorInput::kDisplacement:
        actuation.cables.push_back({fem::CableInput::kDisplacement, value});
        break;
      case scene::ActuatorInput::kPressure:
        actuation.pressures.push_back(value);
        break;
    }
  }
  return actuation;
}

fem::Actuation ActuationAt(const scene::Scene& scene, double time_s) {
  if (scene.actuators.empty()) return {};
  Eigen::VectorXd inputs = scene.actuation.At(time_s);
  for (size_t a = 0; a < scene.actuators.size(); ++a) {
    double& input = inputs(static_cast<Eigen::Index>(a));
    input += scene.actuators[a].offset;
    if (scene.actuators[a].input == scene::ActuatorInput::kTension) input = std::max(input, 0.0);
  }
  return ActuationOf(scene.actuators, inputs);
}

}  // namespace softforce::pipeline
