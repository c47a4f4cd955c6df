#include "pipeline/truth_file.h"

#include <cmath>

#include "pipeline/result_tables.h"
#include "pipeline/truth_numbers.h"

namespace softforce::pipeline {
namespace {

using Json = nlohmann::ordered_json;

// A marker of which less is seen is hardly to be measured.
constexpr double kVisible = 0.9;

}  // namespace

TruthFile::TruthFile(const scene::Scene& scene, const scene::Simulation& simulation,
                     const SimulatedWorld& world, const camera::Rig* rig,
                     const Eigen::Isometry3d& T_rig_robot)
    : simulation_(simulation),
      world_(world),
      rig_(rig),
      T_rig_robot_(T_rig_robot),
      truth_(TruthHeader(scene, simulation, world, rig, T_rig_robot)) {}

Json TruthFile::Forces(double time_s, const fem::Equilibrium& shape) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + shape.u;
  Json forces = Json::array();
  for (size_t f = 0; f < simulation_.forces.size(); ++f) {
    forces.push_back(
        {{"name", simulation_.forces[f].name},
         {"F", List(simulation_.forces[f].At(time_s))},
         {"at_rest", Millimetres(world_.force_places[f].Apply(world_.mesh().nodes))},
         {"at_deformed", Millimetres(simulation_.T_robot_mesh * world_.force_places[f].Apply(x))}});
  }
  return forces;
}

Json TruthFile::Cables(const fem::Equilibrium& shape) const {
  const Eigen::Matrix3Xd x = world_.mesh().nodes + shape.u;
  Json attachments = Json::array();
  for (const fem::Cable& cable : world_.direct->body().cables) {
    attachments.push_back(Millimetres(simulation_.T_robot_mesh * cable.points[0].Apply(x)));
  }
  return {{"displacement", List(shape.shortening, 1e3)},
          {"tension", List(shape.tension)},
          {"attachment_deformed", attachments}};
}

void TruthFile::AddPixels(const std::vector<Eigen::Vector3d>& places, const VisibleShares& shares,
                          Json* frame) const {
  for (size_t c = 0; c < rig_->cameras.size(); ++c) {
    const camera::Camera& camera = rig_->cameras[c];
    Json pixels = Json::array(), fractions = Json::array(), visible = Json::array();
    for (size_t m = 0; m < places.size(); ++m) {
      const camera::Projection at =
          camera::Project(camera.lens, camera.T_camera_rig * T_rig_robot_ * places[m]);
      pixels.push_back(at.visible ? List(at.pixel) : Json(nullptr));
      fractions.push_back(std::round(1e4 * shares[c][m]) / 1e4);
      visible.push_back(shares[c][m] >= kVisible);
    }
    (*frame)["pixels"][camera.name] = pixels;
    (*frame)["visible_fraction"][camera.name] = fractions;
    (*frame)["visible"][camera.name] = visible;
  }
}

void TruthFile::Add(int frame, double time_s, const fem::Equilibrium& shape,
                    const std::vector<Eigen::Vector3d>& places, const VisibleShares& shares) {
  Json entry{{"frame", frame}, {"time_s", Rounded(time_s)}, {"forces", Forces(time_s, shape)}};
  if (!world_.direct->body().cables.empty()) entry["cables"] = Cables(shape);
  if (!world_.direct->body().chambers.empty()) {
    Json pressures = Json::array();
    for (const double p : shape.load.actuation.pressures) pressures.push_back(Rounded(1e-3 * p));
    entry["chambers"] = {{"pressure_kPa", pressures}};
  }
  Json positions = Json::array();
  for (const Eigen::Vector3d& place : places) positions.push_back(Millimetres(place));
  entry["markers"] = {{"pos", positions}};
  if (rig_ != nullptr) AddPixels(places, shares, &entry);
  truth_["frames"].push_back(std::move(entry));
}

void TruthFile::Write(const std::filesystem::path& file) const {
  PendingTable pending(file, "");
  pending.stream() << truth_.dump() << '\n';
  pending.Commit();
}

}  // namespace softforce::pipeline
