#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace softforce::pipeline {

struct SimulateOptions {
  std::filesystem::path out;  // folder for the recording; made if it is not there
  bool show_progress = true;
  const std::atomic<bool>* stop = nullptr;  // set from outside: end after this frame, leave nothing
};

// What was made.
struct SimulateReport {
  int frames = 0;
  bool stopped = false;                 // from outside: no file was written
  int cells = 0, nodes = 0, order = 0;  // of the direct problem
  std::vector<std::string> warnings;
  double solve_seconds = 0, picture_seconds = 0;  // of all frames and cameras
  int pictures = 0;
  std::filesystem::path out;

  std::string FullReport() const;
};

// Makes a recording with truth of a scene, as its section "simulation" says: a direct FEM with its
// own mesh and material, pictures of what it gives, and noise. Writes into the folder all that
// `Run` needs (scene.yaml, rig.yaml, the mesh, actuation.csv, a video per camera), and truth.json
// and markers3d.csv. The same scene gives the same files. They show up under their names only when
// all are complete. Throws InputError for a scene that cannot be simulated, and for a frame in
// which the body has no equilibrium.
SimulateReport Simulate(const std::filesystem::path& scene_file, const SimulateOptions& options);

}  // namespace softforce::pipeline
