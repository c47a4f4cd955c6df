#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "softforce/estimation/identification.h"
#include "softforce/pipeline/mesh_convergence.h"
#include "softforce/pipeline/tracker.h"
#include "softforce/scene/change_scene.h"

namespace softforce::pipeline {

struct IdentifyOptions {
  std::vector<std::string> weights;  // see ParseWeights
  std::vector<estimation::Unknown::Kind> unknowns{estimation::Unknown::Kind::kYoungsModulus};
  bool per_region = false;  // a value for each material of the scene, instead of one for all
  std::map<std::string, std::string> sources;  // camera → file; instead of those in the scene
  int registration_frames = 10;                // as for a run
  bool show_progress = true;
  // As for the runs that the values are meant for.
  MeshAim mesh_aim = MeshAim::kGiven;
  TrackerOptions tracker;  // model errors: for the given mesh; less of them is left if corrected
  const std::atomic<bool>* stop = nullptr;  // set from outside: end, with nothing usable
  // Where the values will be written; must be none of the files of the job. Empty: nowhere, or into
  // the scene itself.
  std::filesystem::path out;

  void Check() const;  // throws InputError naming the option
};

// A known force, and what a run makes of the same observations with the values found.
struct KnownForce {
  std::string state;                                    // "frames 20 to 29"
  int candidate = -1;                                   // id in the scene
  Eigen::Vector3d known = Eigen::Vector3d::Zero();      // N
  Eigen::Vector3d estimated = Eigen::Vector3d::Zero();  // N; NaN if there was no estimate
};

struct IdentifyReport {
  estimation::Identification found;
  scene::SceneChanges changes;  // what to write into the scene; empty unless usable
  std::vector<KnownForce> forces;
  std::vector<std::string> warnings;
  MeshAim mesh_aim = MeshAim::kGiven;  // the values are for runs with this correction
  int frames_left_out = 0;             // of those with known forces: nothing was seen in them
  bool usable = false;

  std::string BriefReport() const;  // one line
  std::string FullReport() const;   // values, misfits in words, advice
};

// Finds numbers of a scene's body from frames of its recording in which the forces are known: plays
// the recording as a run does, and fits the body to what was seen in those frames. Frames of one
// spec under the same actuation are averaged, and the body must be at rest in them. Throws
// InputError for input that cannot be used.
IdentifyReport Identify(const std::filesystem::path& scene_file, const IdentifyOptions& options);

}  // namespace softforce::pipeline
