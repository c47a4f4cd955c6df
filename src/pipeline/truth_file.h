#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "pipeline/simulated_pictures.h"
#include "pipeline/simulated_world.h"
#include "softforce/camera/rig.h"

namespace softforce::pipeline {

// All of truth.json but its frames; `rig` is nothing if there are no pictures.
nlohmann::ordered_json TruthHeader(const scene::Scene& scene, const scene::Simulation& simulation,
                                   const SimulatedWorld& world, const camera::Rig* rig,
                                   const Eigen::Isometry3d& T_rig_robot);

// truth.json of a simulated recording: what is to be found. Places in mm in the robot frame, but in
// the frame of the mesh if they are those of the body at rest.
class TruthFile {
 public:
  // Without frames as yet. World, rig and simulation must outlive it.
  TruthFile(const scene::Scene& scene, const scene::Simulation& simulation,
            const SimulatedWorld& world, const camera::Rig* rig,
            const Eigen::Isometry3d& T_rig_robot);

  // `places`: m, robot frame, of the markers. `shares`: without pictures, nothing.
  void Add(int frame, double time_s, const fem::Equilibrium& shape,
           const std::vector<Eigen::Vector3d>& places, const VisibleShares& shares);

  void Write(const std::filesystem::path& file) const;  // shows up when it is complete

 private:
  nlohmann::ordered_json Forces(double time_s, const fem::Equilibrium& shape) const;
  nlohmann::ordered_json Cables(const fem::Equilibrium& shape) const;
  void AddPixels(const std::vector<Eigen::Vector3d>& places, const VisibleShares& shares,
                 nlohmann::ordered_json* frame) const;

  const scene::Simulation& simulation_;
  const SimulatedWorld& world_;
  const camera::Rig* rig_;
  Eigen::Isometry3d T_rig_robot_;
  nlohmann::ordered_json truth_;
};

}  // namespace softforce::pipeline
