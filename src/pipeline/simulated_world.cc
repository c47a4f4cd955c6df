#include "pipeline/simulated_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/actuators.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"
#include "softforce/mesh/refine.h"

namespace softforce::pipeline {
namespace {

constexpr int kMaxCells = 1'000'000;  // far beyond what the direct problem can be solved for

mesh::TetMesh DirectMesh(const scene::Scene& scene, const scene::Simulation& simulation) {
  const std::filesystem::path file = simulation.mesh_file.value_or(scene.mesh.file);
  mesh::TetMesh mesh = mesh::ReadMesh(
      file, simulation.mesh_file ? simulation.metres_per_unit : scene.mesh.metres_per_unit);
  mesh::CheckMesh(mesh, file.string());
  const double cells = mesh.num_elements() * std::pow(8, simulation.refine);
  if (cells > kMaxCells) {
    throw base::InputError(scene.file.string() + ": simulation: mesh: refine",
                           fmt::format("would make {:.0f} cells of {}; at most {} can be simulated",
                                       cells, mesh.num_elements(), kMaxCells),
                           "Refine less often.");
  }
  for (int i = 0; i < simulation.refine; ++i) mesh = mesh::Refine(mesh).mesh;
  return mesh::WithOrder(mesh, simulation.order);
}

// Forces become candidates, so that they are placed on the mesh as those of a run are.
scene::Scene DirectScene(const scene::Scene& scene, const scene::Simulation& simulation) {
  scene::Scene direct = scene;
  if (!simulation.materials.empty()) direct.materials = simulation.materials;
  direct.gravity = simulation.T_robot_mesh.linear().transpose() * scene.gravity;
  direct.forces.candidates.clear();
  for (const scene::SimulatedForce& force : simulation.forces) {
    direct.forces.candidates.push_back({static_cast<int>(direct.forces.candidates.size()),
                                        force.position,
                                        scene::ForceDirection::kFree,
                                        {}});
  }
  return direct;
}

// Before they are taken for the scene's candidates, whose names they do not have.
void RefuseForcesOffTheBody(const scene::Scene& scene, const scene::Simulation& simulation,
                            const mesh::TetMesh& mesh) {
  if (simulation.forces.empty()) return;
  const mesh::Surface surface = mesh::ExtractSurface(mesh);
  for (const scene::SimulatedForce& force : simulation.forces) {
    PlaceOnSurface(surface, mesh.nodes, force.position,
                   fmt::format("{}: simulation: forces: {}", scene.file.string(), force.name));
  }
}

}  // namespace

SimulatedWorld BuildSimulatedWorld(const scene::Scene& scene, const scene::Simulation& simulation) {
  SimulatedWorld simulated;
  simulated.scene = DirectScene(scene, simulation);
  mesh::TetMesh mesh = DirectMesh(scene, simulation);
  RefuseForcesOffTheBody(scene, simulation, mesh);
  World world = BuildWorld(simulated.scene, std::move(mesh));
  for (const estimation::ForceSite& site : world.sites) simulated.force_places.push_back(site.at);
  for (const BodyPoint& marker : world.markers) {
    simulated.markers.push_back(marker.weights);
    simulated.rest_normals.push_back(mesh::Normal(world.surface, world.mesh().nodes, marker.at));
  }
  simulated.surface = std::move(world.surface);
  simulated.direct = std::make_unique<simulation::DirectProblem>(
      world.solver->body(), simulated.force_places, scene.file.string() + ": simulation");
  return simulated;
}

Eigen::VectorXd ToldAt(const scene::Scene& scene, const scene::Simulation& simulation,
                       double time_s) {
  if (scene.actuators.empty()) return {};
  return (simulation.actuation ? *simulation.actuation : scene.actuation).At(time_s);
}

double OffsetOf(const scene::Actuator& actuator, const scene::Simulation& simulation) {
  const auto own = simulation.actuator_offsets.find(actuator.name);
  return own == simulation.actuator_offsets.end() ? actuator.offset : own->second;
}

simulation::Loading LoadingAt(const SimulatedWorld& world, const scene::Simulation& simulation,
                              double time_s) {
  simulation::Loading loading;
  loading.forces.resize(3, static_cast<Eigen::Index>(simulation.forces.size()));
  for (size_t f = 0; f < simulation.forces.size(); ++f) {
    loading.forces.col(static_cast<Eigen::Index>(f)) =
        simulation.T_robot_mesh.linear().transpose() * simulation.forces[f].At(time_s);
  }
  const std::vector<scene::Actuator>& actuators = world.scene.actuators;
  Eigen::VectorXd inputs = ToldAt(world.scene, simulation, time_s);
  for (size_t a = 0; a < actuators.size(); ++a) {
    double& input = inputs(static_cast<Eigen::Index>(a));
    input += OffsetOf(actuators[a], simulation);
    if (actuators[a].input == scene::ActuatorInput::kTension) input = std::max(0.0, input);
  }
  loading.actuation = ActuationOf(actuators, inputs);
  return loading;
}

}  // namespace softforce::pipeline
