#include "softforce/pipeline/simulate.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <chrono>
#include <optional>

#include "pipeline/open_recording.h"
#include "pipeline/refusals.h"
#include "pipeline/result_tables.h"
#include "pipeline/simulated_pictures.h"
#include "pipeline/simulated_rig.h"
#include "pipeline/simulated_world.h"
#include "pipeline/truth_file.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"
#include "softforce/scene/recorded_scene.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {
namespace {

double Since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// A simulation in progress.
class SimulationJob {
 public:
  SimulationJob(const std::filesystem::path& scene_file, const SimulateOptions& options)
      : options_(options),
        scene_(scene::LoadScene(scene_file, scene::SceneFiles::kToSimulate)),
        simulation_(scene_.simulation.value_or(scene::Simulation{})),
        rig_(scene::LoadRig(scene_.cameras.rig)),
        T_rig_robot_(simulation_.pictures ? PlaceSimulatedRig(scene_, simulation_, rig_)
                                          : Eigen::Isometry3d::Identity()),
        world_(Prepare()),
        truth_(scene_, simulation_, world_, simulation_.pictures ? &rig_ : nullptr, T_rig_robot_) {
    if (simulation_.pictures) {
      pictures_.emplace(scene_, simulation_, world_, rig_, T_rig_robot_, options_.out);
    }
  }

  SimulateReport Finish();

 private:
  SimulatedWorld Prepare() const;
  std::string ActuationHeader() const;
  void ProcessFrame(int frame);
  void WriteMarkers(int frame, double time_s, const std::vector<Eigen::Vector3d>& places);
  void WriteActuation(double time_s);
  void Warn();
  void Commit();

  const SimulateOptions& options_;
  const scene::Scene scene_;
  const scene::Simulation simulation_;
  const camera::Rig rig_;
  const Eigen::Isometry3d T_rig_robot_;
  const SimulatedWorld world_;
  TruthFile truth_;
  std::optional<SimulatedPictures> pictures_;
  std::optional<PendingTable> markers_, actuation_;
  SimulateReport report_;
};

SimulatedWorld SimulationJob::Prepare() const {
  RefuseToOverwrite(FilesOf(scene_, SourcesOf(scene_, {})), options_.out);
  return BuildSimulatedWorld(scene_, simulation_);
}

std::string SimulationJob::ActuationHeader() const {
  std::string header = "time_s";
  for (const scene::Actuator& actuator : scene_.actuators) {
    header += fmt::format(",{}_{}", actuator.name,
                          actuator.input == scene::ActuatorInput::kTension    ? "N"
                          : actuator.input == scene::ActuatorInput::kPressure ? "kPa"
                                                                              : "mm");
  }
  return header;
}

void SimulationJob::WriteActuation(double time_s) {
  const Eigen::VectorXd told = ToldAt(scene_, simulation_, time_s);
  fmt::print(actuation_->stream(), "{:.6f}", time_s);
  for (size_t a = 0; a < scene_.actuators.size(); ++a) {
    const double unit = scene_.actuators[a].input == scene::ActuatorInput::kTension    ? 1
                        : scene_.actuators[a].input == scene::ActuatorInput::kPressure ? 1e-3
                                                                                       : 1e3;
    fmt::print(actuation_->stream(), ",{:.7f}", unit * told(static_cast<Eigen::Index>(a)));
  }
  fmt::print(actuation_->stream(), "\n");
}

void SimulationJob::WriteMarkers(int frame, double time_s,
                                 const std::vector<Eigen::Vector3d>& places) {
  const auto measured =
      simulation::MeasureMarkers(places, frame, time_s, simulation_.markers, simulation_.seed);
  for (size_t m = 0; m < places.size(); ++m) {
    if (!measured[m]) continue;
    const Eigen::Vector3d mm = 1e3 * *measured[m];
    fmt::print(markers_->stream(), "{},{:.6f},{},{:.5f},{:.5f},{:.5f},{:.5f}\n", frame, time_s,
               scene_.markers.points[m].id, mm.x(), mm.y(), mm.z(),
               1e3 * simulation_.markers.noise);
  }
}

void SimulationJob::ProcessFrame(int frame) {
  const double time_s = frame / simulation_.rate;
  const auto before_solve = std::chrono::steady_clock::now();
  const fem::Equilibrium& shape =
      world_.direct->Solve(frame, LoadingAt(world_, simulation_, time_s));
  report_.solve_seconds += Since(before_solve);

  const Eigen::Matrix3Xd x = world_.mesh().nodes + shape.u;
  std::vector<Eigen::Vector3d> places;
  for (const mesh::NodalWeights& marker : world_.markers) {
    places.push_back(simulation_.T_robot_mesh * marker.Apply(x));
  }
  WriteMarkers(frame, time_s, places);
  if (actuation_) WriteActuation(time_s);
  VisibleShares shares;
  if (pictures_) {
    const auto before_pictures = std::chrono::steady_clock::now();
    shares = pictures_->Add(frame, time_s, shape);
    report_.picture_seconds += Since(before_pictures);
    report_.pictures += static_cast<int>(shares.size());
  }
  truth_.Add(frame, time_s, shape, places, shares);
  ++report_.frames;
}

void SimulationJob::Warn() {
  if (simulation_.forces.empty()) {
    report_.warnings.push_back("no force acts: list some under 'simulation: forces'");
  }
  if (pictures_ && pictures_->num_decoys() < simulation_.strewn_decoys) {
    report_.warnings.push_back(fmt::format("there was room for {} of {} decoys only",
                                           pictures_->num_decoys(), simulation_.strewn_decoys));
  }
}

// The scene comes last: with it the recording is whole.
void SimulationJob::Commit() {
  scene::RecordedFiles files;
  files.mesh = scene_.mesh.file.filename().string();
  base::PendingFile mesh(options_.out / files.mesh);
  std::error_code error;
  std::filesystem::copy_file(scene_.mesh.file, mesh.temporary(),
                             std::filesystem::copy_options::overwrite_existing, error);
  if (error) {
    throw base::InputError(mesh.path().string(), "cannot be written: " + error.message(),
                           "Check the folder's permissions and the disk's space.");
  }
  mesh.Commit();
  truth_.Write(options_.out / "truth.json");
  markers_->Commit();
  files.measured = "markers3d.csv";
  if (actuation_) {
    actuation_->Commit();
    files.actuation = "actuation.csv";
  }
  if (pictures_) {
    pictures_->Commit();
    files.sources = pictures_->Files();
    // With fiducials, where the rig stands is left to be found.
    camera::Rig rig = rig_;
    rig.T_rig_robot.reset();
    rig.T_rig_robot_covariance.setZero();  // it is known
    if (scene_.cameras.fiducials.empty()) rig.T_rig_robot = T_rig_robot_;
    files.rig = "rig.yaml";
    scene::SaveRig(rig, options_.out / files.rig);
  }
  scene::SaveRecordedScene(scene_.file, files, options_.out / "scene.yaml");
}

SimulateReport SimulationJob::Finish() {
  std::vector<std::string> names{"scene.yaml",    "rig.yaml",
                                 "actuation.csv", "truth.json",
                                 "markers3d.csv", scene_.mesh.file.filename().string()};
  for (const camera::Camera& camera : rig_.cameras) names.push_back(camera.name + ".mp4");
  PrepareFolder(options_.out, names);
  markers_.emplace(options_.out / "markers3d.csv", "frame,time_s,marker,x_mm,y_mm,z_mm,sd_mm");
  if (!scene_.actuators.empty()) {
    actuation_.emplace(options_.out / "actuation.csv", ActuationHeader());
  }
  Warn();
  report_.cells = world_.mesh().num_elements();
  report_.nodes = world_.mesh().num_nodes();
  report_.order = world_.mesh().order();
  report_.out = options_.out;

  base::Progress progress("frames", simulation_.frames);
  for (int frame = 0; frame < simulation_.frames; ++frame) {
    report_.stopped = options_.stop != nullptr && *options_.stop;
    if (report_.stopped) return report_;
    ProcessFrame(frame);
    if (options_.show_progress) progress.Update(frame + 1);
  }
  report_.stopped = options_.stop != nullptr && *options_.stop;
  if (report_.stopped) return report_;
  if (options_.show_progress) progress.Finish();
  Commit();
  return report_;
}

}  // namespace

SimulateReport Simulate(const std::filesystem::path& scene_file, const SimulateOptions& options) {
  SimulationJob job(scene_file, options);
  return job.Finish();
}

}  // namespace softforce::pipeline
