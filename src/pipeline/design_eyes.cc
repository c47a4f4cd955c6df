// Where the cameras of a design stand, and how they see markers.
#include <algorithm>

#include "pipeline/design_task.h"
#include "pipeline/open_recording.h"
#include "pipeline/registration.h"
#include "pipeline/simulated_rig.h"
#include "softforce/base/input_error.h"
#include "softforce/pipeline/tracker.h"
#include "softforce/scene/place_rig.h"
#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

// Whether the recording of a scene is there to be looked at.
bool HasRecording(const std::vector<vision::Recording::Source>& sources) {
  return !sources.empty() && std::all_of(sources.begin(), sources.end(), [](const auto& source) {
    return std::filesystem::exists(source.file);
  });
}

Standing StandingOf(const scene::Scene& scene, const camera::Rig& rig, int frames) {
  const std::vector<vision::Recording::Source> sources = SourcesOf(scene, {});
  if (!scene.cameras.fiducials.empty() && HasRecording(sources)) {
    vision::Recording recording(rig, sources);
    return FindRig(scene, rig, Detector(scene, rig), FirstFramesOf(&recording, frames));
  }
  if (rig.T_rig_robot) {
    return {*rig.T_rig_robot, rig.T_rig_robot_covariance, std::nullopt, {}, "rig_file"};
  }
  if (scene.simulation) {
    const Eigen::Isometry3d T_rig_robot = PlaceSimulatedRig(scene, *scene.simulation, rig);
    return {T_rig_robot, geometry::Matrix6d::Zero(), std::nullopt, {}, "simulation"};
  }
  throw base::InputError(
      scene.file.string() + ": cameras",
      "nothing says where the cameras stand: there is no recording with fiducials, no T_rig_robot "
      "in " +
          scene.cameras.rig.string() + ", and no section 'simulation'",
      "Find it with softforce register, or leave the cameras out: --noise \"0.1 mm\".");
}

}  // namespace

DesignEyes FindEyes(const scene::Scene& scene, const DesignOptions& options) {
  DesignEyes eyes;
  eyes.noise = options.noise;
  if (options.noise > 0) return eyes;
  if (scene.measured) {
    eyes.noise = scene.measured->noise;
    if (!scene.measured->rig.empty()) {
      const scene::RigPlace place = scene::LoadPlace(scene.measured->rig);
      eyes.registration = InRobotFrame(place.covariance, place.T_rig_robot);
    }
    return eyes;
  }
  eyes.rig = scene::LoadRig(scene.cameras.rig);
  const Standing standing = StandingOf(scene, eyes.rig, options.registration_frames);
  eyes.T_rig_robot = standing.T_rig_robot;
  eyes.registration = InRobotFrame(standing.covariance, standing.T_rig_robot);
  eyes.from = standing.from_fiducials ? "fiducials" : standing.from;
  return eyes;
}

MarkerEyes::MarkerEyes(const DesignEyes& eyes, const World& world, const Eigen::Matrix3Xd& x,
                       const design::SightOptions& options)
    : eyes_(eyes), world_(world), x_(x) {
  if (!eyes.any()) return;
  sight_.emplace(eyes.rig, eyes.T_rig_robot, world.surface, x, options);
  needed_ = std::min<int>(2, static_cast<int>(eyes.rig.cameras.size()));
}

design::MarkerSight MarkerEyes::Of(const mesh::SurfacePoint& at) const {
  if (sight_) return sight_->Of(at);
  return {mesh::Position(world_.surface, x_, at),
          Eigen::Matrix3d::Identity() / (eyes_.noise * eyes_.noise)};
}

int MarkerEyes::NumCameras(const mesh::SurfacePoint& at) const {
  return sight_ ? sight_->NumCameras(at) : 0;
}

}  // namespace softforce::pipeline
