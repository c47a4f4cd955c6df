#pragma once

#include <memory>

#include "softforce/pipeline/world.h"
#include "softforce/simulation/direct.h"

namespace softforce::pipeline {

// The body of a simulated recording, and what is seen of it.
struct SimulatedWorld {
  // The scene as the direct problem has it: its own material, and its forces as candidates, in the
  // frame of the mesh.
  scene::Scene scene;
  mesh::Surface surface;
  std::unique_ptr<simulation::DirectProblem> direct;
  std::vector<mesh::NodalWeights> force_places;
  std::vector<mesh::NodalWeights> markers;    // centres, on the surface
  std::vector<Eigen::Vector3d> rest_normals;  // of the surface at the markers

  const mesh::TetMesh& mesh() const { return direct->body().mesh; }
};

// Throws InputError for what the scene, or its section "simulation", asks of the body in vain.
SimulatedWorld BuildSimulatedWorld(const scene::Scene& scene, const scene::Simulation& simulation);

// What acts on the body at a time; forces and gravity are turned into the frame of the mesh.
simulation::Loading LoadingAt(const SimulatedWorld& world, const scene::Simulation& simulation,
                              double time_s);

// How much more an actuator really does than it is told, N, m or Pa: what the section "simulation"
// says, or else the offset with which the scene's own model reckons.
double OffsetOf(const scene::Actuator& actuator, const scene::Simulation& simulation);

// What the actuators are told, one number per actuator of the scene; N, m or Pa.
Eigen::VectorXd ToldAt(const scene::Scene& scene, const scene::Simulation& simulation,
                       double time_s);

}  // namespace softforce::pipeline
