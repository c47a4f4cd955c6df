#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/simulated_world.h"
#include "softforce/camera/rig.h"
#include "softforce/render/picture.h"
#include "softforce/vision/video_writer.h"

namespace softforce::pipeline {

// How much of each marker every camera sees: [camera][marker], 0 to 1.
using VisibleShares = std::vector<std::vector<double>>;

// The videos of a simulated recording.
class SimulatedPictures {
 public:
  // World, rig, scene and simulation must outlive it. Throws InputError for tags that do not exist
  // and fiducials that are no squares.
  SimulatedPictures(const scene::Scene& scene, const scene::Simulation& simulation,
                    const SimulatedWorld& world, const camera::Rig& rig,
                    const Eigen::Isometry3d& T_rig_robot, const std::filesystem::path& folder);

  // The file of each camera, by its name in the folder.
  std::map<std::string, std::string> Files() const;

  int num_decoys() const { return num_decoys_; }  // strewn on the body

  VisibleShares Add(int frame, double time_s, const fem::Equilibrium& shape);
  void Commit();

 private:
  const scene::Simulation& simulation_;
  const SimulatedWorld& world_;
  const camera::Rig& rig_;
  int num_decoys_ = 0;
  std::vector<render::PictureMaker> makers_;  // one per camera
  std::vector<vision::VideoWriter> writers_;
};

}  // namespace softforce::pipeline
