#include "softforce/pipeline/identify.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <algorithm>

#include "pipeline/known_states.h"
#include "pipeline/marker_source.h"
#include "pipeline/mesh_correction.h"
#include "pipeline/open_recording.h"
#include "pipeline/refusals.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"

namespace softforce::pipeline {
namespace {

using estimation::Unknown;
using Kind = Unknown::Kind;

constexpr int kMaxFrameWarnings = 5;  // about single frames

// The regions of the mesh that are made of a material of the scene ("": all that have none of
// their own).
std::vector<int> RegionsOf(const scene::Scene& scene, const mesh::TetMesh& mesh,
                           const std::string& material) {
  std::vector<int> regions;
  for (int r = 0; r < static_cast<int>(mesh.region_names.size()); ++r) {
    const std::string& name = mesh.region_names[r];
    const bool own = scene.materials.count(name) > 0;
    if (own ? name == material : material.empty()) regions.push_back(r);
  }
  return regions;
}

std::string NameOf(Kind kind) {
  switch (kind) {
    case Kind::kYoungsModulus:
      return "Young's modulus";
    case Kind::kPoissonsRatio:
      return "Poisson's ratio";
    case Kind::kCableOffset:
      return "offset";
  }
  return "";
}

std::vector<Unknown> MaterialUnknowns(const scene::Scene& scene, const mesh::TetMesh& mesh,
                                      Kind kind, bool per_region) {
  if (!per_region || scene.materials.size() == 1) return {{kind, NameOf(kind), {}, -1}};
  std::vector<Unknown> unknowns;
  for (const auto& [material, values] : scene.materials) {
    unknowns.push_back(
        {kind, NameOf(kind) + " of " + material, RegionsOf(scene, mesh, material), -1});
  }
  return unknowns;
}

std::vector<Unknown> CableUnknowns(const scene::Scene& scene) {
  std::vector<Unknown> unknowns;
  for (const scene::Actuator& actuator : scene.actuators) {
    if (actuator.type != scene::ActuatorType::kCable) continue;
    const int cable = static_cast<int>(unknowns.size());
    unknowns.push_back({Kind::kCableOffset, "offset of " + actuator.name, {}, cable});
  }
  if (unknowns.empty()) {
    throw base::InputError("--unknown cable_offset", "the scene has no cables");
  }
  return unknowns;
}

std::vector<Unknown> UnknownsOf(const scene::Scene& scene, const mesh::TetMesh& mesh,
                                const IdentifyOptions& options) {
  std::vector<Unknown> unknowns;
  for (const Kind kind : options.unknowns) {
    const std::vector<Unknown> more = kind == Kind::kCableOffset
                                          ? CableUnknowns(scene)
                                          : MaterialUnknowns(scene, mesh, kind, options.per_region);
    unknowns.insert(unknowns.end(), more.begin(), more.end());
  }
  return unknowns;
}

// While the recording is followed, cables whose offset is looked for may be off: markers that stand
// where a wrong offset does not have them would be rejected.
scene::Scene ToFollow(scene::Scene scene, const std::vector<Kind>& unknowns) {
  if (std::count(unknowns.begin(), unknowns.end(), Kind::kCableOffset) == 0) return scene;
  const estimation::IdentificationOptions guess;
  for (scene::Actuator& actuator : scene.actuators) {
    if (actuator.type != scene::ActuatorType::kCable) continue;
    const bool tension = actuator.input == scene::ActuatorInput::kTension;
    actuator.uncertainty =
        std::max(actuator.uncertainty, tension ? guess.guess_tension : guess.guess_shortening);
  }
  return scene;
}

int LastFrame(const std::vector<KnownWeights>& weights) {
  int last = 0;
  for (const KnownWeights& known : weights) last = std::max(last, known.end_frame - 1);
  return last;
}

// An identification in progress.
class Job {
 public:
  Job(const std::filesystem::path& scene_file, const IdentifyOptions& options)
      : options_(options),
        scene_(ToFollow(scene::LoadScene(scene_file), options.unknowns)),
        weights_(ParseWeights(options.weights, scene_)),
        source_options_(SourceOptions()),
        source_(OpenSource()),
        correction_(CorrectMesh(scene_, options.mesh_aim, options.show_progress)),
        tracker_options_(Corrected(options.tracker, correction_)),
        world_(BuildWorld(scene_, correction_)),
        unknowns_(UnknownsOf(scene_, world_.mesh(), options)),
        standing_(source_->Start([](const std::string&) {})),
        known_(scene_, world_, weights_) {}

  IdentifyReport Finish();

 private:
  void RefuseToReplaceInputs() const;
  RunOptions SourceOptions() const;
  std::unique_ptr<MarkerSource> OpenSource() const;
  bool Stopped();
  bool PlayRecording();  // false if there is nothing to go on with
  void Warn(const std::string& warning) { report_.warnings.push_back(warning); }
  void EstimateForcesAgain(const std::vector<estimation::KnownState>& states);
  scene::SceneChanges Changes() const;
  double ModulusFactor() const { return correction_ ? correction_->modulus_factor : 1; }
  void ShowAsInScene();

  const IdentifyOptions& options_;
  const scene::Scene scene_;
  const std::vector<KnownWeights> weights_;
  const RunOptions source_options_;
  const std::unique_ptr<MarkerSource> source_;
  const std::optional<MeshCorrection> correction_;
  const TrackerOptions tracker_options_;
  const World world_;
  const std::vector<Unknown> unknowns_;
  const Standing standing_;
  KnownStates known_;
  IdentifyReport report_;
};

void Job::RefuseToReplaceInputs() const {
  if (options_.out.empty()) return;
  std::vector<std::filesystem::path> inputs = FilesOf(scene_, SourcesOf(scene_, options_.sources));
  // Those of the scene, too, if other videos are used instead.
  for (const auto& [camera, source] : scene_.cameras.sources) inputs.emplace_back(source);
  for (const std::filesystem::path& file : WeightsFiles(options_.weights)) inputs.push_back(file);
  RefuseToReplace(inputs, options_.out, "-o");
}

RunOptions Job::SourceOptions() const {
  RunOptions run;
  run.out.clear();  // nothing is written
  run.sources = options_.sources;
  run.registration_frames = options_.registration_frames;
  run.watch_rig = 0;
  return run;
}

// All frames asked for must be there, so the last one is looked for.
std::unique_ptr<MarkerSource> Job::OpenSource() const {
  RefuseUnknownLocations(scene_);
  RefuseToReplaceInputs();
  RefuseLiveSources(scene_, SourcesOf(scene_, options_.sources));
  std::unique_ptr<MarkerSource> source = OpenMarkerSource(scene_, source_options_);
  const int last = source->last_frame(), asked = LastFrame(weights_);
  if (last < 0 || asked <= last) return source;
  const std::string has =
      scene_.measured ? fmt::format("the last in the file is {}", last)  // has numbers of its own
                      : fmt::format("the recording has {} frames, 0 to {}", last + 1, last);
  throw base::InputError("--weights", fmt::format("asks for frame {}, but {}", asked, has));
}

bool Job::Stopped() {
  const bool stopped = options_.stop != nullptr && *options_.stop;
  if (stopped) Warn("stopped: nothing is written");
  return stopped;
}

bool Job::PlayRecording() {
  Tracker tracker(scene_, world_, source_->rig(), standing_.T_rig_robot, standing_.covariance,
                  tracker_options_);
  base::Progress progress("frames", known_.end_frame());
  int& lost = report_.frames_left_out;
  int odd = 0, used = 0;
  while (true) {
    if (Stopped()) return false;
    FrameInWork work;
    if (!source_->Next(&work) || work.set.frame >= known_.end_frame()) break;
    source_->Detect(&work);
    const vision::FrameSet* frame = &work.set;
    // Also frames whose forces are not known: the markers are followed through them.
    const FrameResult result = tracker.Process(frame->frame, frame->time_s, work.detections);
    if (options_.show_progress) progress.Update(frame->frame + 1);
    if (!known_.Wants(frame->frame)) continue;
    if (tracker.observations().empty()) {
      if (++lost <= kMaxFrameWarnings) {
        Warn(fmt::format("frame {} is left out: {}: {}", frame->frame,
                         estimation::Name(result.status), result.reason));
      }
      continue;
    }
    ++used;
    known_.Add(frame->frame, ActuationAt(scene_, frame->time_s), tracker.observations());
    // The scene's values may be too wrong for a run: that is what is to be put right.
    if (!result.ok() && ++odd <= kMaxFrameWarnings) {
      Warn(
          fmt::format("frame {} is used, though a run with the scene as it is finds no forces: "
                      "{}: {}",
                      frame->frame, estimation::Name(result.status), result.reason));
    }
  }
  if (options_.show_progress) progress.Finish();
  if (lost > kMaxFrameWarnings) Warn(fmt::format("{} frames are left out in all", lost));
  if (odd > kMaxFrameWarnings) Warn(fmt::format("a run finds no forces in {} frames", odd));
  const std::vector<std::string> short_of = source_->ShortOf();
  for (const std::string& reason : short_of) Warn(reason);
  if (used == 0) Warn("no frame with known forces could be used");
  return used > 0 && short_of.empty();
}

// With the values found, what would a run say of these states?
void Job::EstimateForcesAgain(const std::vector<estimation::KnownState>& states) {
  fem::StaticSolver& solver = *world_.solver;
  solver.SetMaterials(report_.found.materials);
  for (size_t s = 0; s < states.size(); ++s) {
    const KnownWeights& weights = known_.WeightsOf(static_cast<int>(s));
    if (weights.forces.empty()) continue;
    if (options_.stop != nullptr && *options_.stop) return;
    fem::Actuation actuation = states[s].actuation;
    for (size_t c = 0; c < actuation.cables.size(); ++c) {
      actuation.cables[c].value += report_.found.cable_offsets(static_cast<Eigen::Index>(c));
    }
    estimation::ForceEstimator estimator(&solver, world_.sites, tracker_options_.estimator);
    estimator.SetRegistrationCovariance(InRobotFrame(standing_.covariance, standing_.T_rig_robot));
    const bool advanced = estimator.Advance(actuation).ok();
    const estimation::ForceEstimate estimate =
        estimator.Estimate(states[s].observations, actuation);
    for (const auto& [candidate, components] : weights.forces) {
      KnownForce force{states[s].name, scene_.forces.candidates[candidate].id,
                       world_.sites[candidate].directions * components,
                       Eigen::Vector3d::Constant(NAN)};
      if (advanced && estimate.ok()) {
        force.estimated = estimator.Force(estimate.intensity, candidate);
      }
      report_.forces.push_back(force);
    }
  }
}

scene::SceneChanges Job::Changes() const {
  scene::SceneChanges changes;
  for (const Kind kind : options_.unknowns) {
    for (const auto& [name, old] : scene_.materials) {
      const std::vector<int> regions = RegionsOf(scene_, world_.mesh(), name);
      if (kind == Kind::kCableOffset || regions.empty()) continue;
      const fem::Material& found = report_.found.materials[regions.front()];
      if (kind == Kind::kYoungsModulus) {
        changes.youngs_modulus[name] = found.youngs_modulus / ModulusFactor();
      } else {
        changes.poissons_ratio[name] = found.poissons_ratio;
      }
    }
    Eigen::Index cable = 0;
    for (const scene::Actuator& actuator : scene_.actuators) {
      if (actuator.type != scene::ActuatorType::kCable) continue;
      const double offset = actuator.offset + report_.found.cable_offsets(cable++);
      if (kind == Kind::kCableOffset) changes.cable_offset[actuator.name] = offset;
    }
  }
  return changes;
}

// Values as the scene has them: moduli without the mesh's correction; offsets of cables from what
// the cable is told, not from the old offset.
void Job::ShowAsInScene() {
  for (size_t i = 0; i < unknowns_.size(); ++i) {
    estimation::IdentifiedValue& shown = report_.found.values[i];
    if (unknowns_[i].kind == Kind::kYoungsModulus) {
      for (double* value : {&shown.start, &shown.value, &shown.sd}) *value /= ModulusFactor();
    }
    if (unknowns_[i].kind != Kind::kCableOffset) continue;
    int cable = 0;
    for (const scene::Actuator& actuator : scene_.actuators) {
      if (actuator.type != scene::ActuatorType::kCable || cable++ != unknowns_[i].cable) continue;
      shown.start += actuator.offset;
      shown.value += actuator.offset;
    }
  }
}

IdentifyReport Job::Finish() {
  report_.mesh_aim = options_.mesh_aim;
  if (!PlayRecording()) return report_;
  const std::vector<std::string> moving = known_.Moving(scene_);
  for (const std::string& states : moving) Warn(states);
  if (!moving.empty()) return report_;
  const std::vector<estimation::KnownState> states = known_.Collected();
  if (options_.show_progress) {
    spdlog::logger log("softforce", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    log.set_pattern("%n: %v");
    log.info("fitting {} nodes; unknown values: {}; states with known forces: {}",
             world_.mesh().num_nodes(), unknowns_.size(), states.size());
  }
  estimation::IdentificationOptions options;
  options.estimator = tracker_options_.estimator;
  options.stop = options_.stop;
  report_.found =
      estimation::Identify(world_.solver->body(), states, unknowns_,
                           InRobotFrame(standing_.covariance, standing_.T_rig_robot), options);
  if (!report_.found.ok()) return report_;
  report_.changes = Changes();
  EstimateForcesAgain(states);
  ShowAsInScene();
  report_.usable = !Stopped();
  return report_;
}

}  // namespace

void IdentifyOptions::Check() const {
  if (unknowns.empty())
    throw base::InputError("--unknown", "got none, expected what is to be found");
  for (size_t i = 0; i < unknowns.size(); ++i) {
    if (std::count(unknowns.begin(), unknowns.end(), unknowns[i]) > 1) {
      throw base::InputError("--unknown", "names " + NameOf(unknowns[i]) + " twice");
    }
  }
  if (registration_frames < 1) {
    throw base::InputError("--registration-frames", "must be 1 or more");
  }
  tracker.Check();
}

IdentifyReport Identify(const std::filesystem::path& scene_file, const IdentifyOptions& options) {
  options.Check();
  return Job(scene_file, options).Finish();
}

}  // namespace softforce::pipeline
