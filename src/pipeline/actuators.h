#pragma once

#include <vector>

#include "softforce/estimation/observation.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {

// The cables and chambers of a scene, each in the scene's order. Throw InputError for a cable off
// the body, or a chamber without walls.
std::vector<fem::Cable> Cables(const scene::Scene& scene, const mesh::TetMesh& mesh,
                               const mesh::Surface& surface);
std::vector<fem::Chamber> Chambers(const scene::Scene& scene, const mesh::TetMesh& mesh,
                                   const mesh::Surface& surface);

// How well each actuator's input is known, cables then chambers, as in fem::Body.
std::vector<estimation::ActuatorUncertainty> Uncertainties(const scene::Scene& scene);

// What they are told by one number each; N, m or Pa.
fem::Actuation ActuationOf(const std::vector<scene::Actuator>& actuators,
                           const Eigen::VectorXd& inputs);

}  // namespace softforce::pipeline
