#include "pipeline/truth_file.h"

#include <fmt/format.h>

#include "pipeline/truth_numbers.h"

namespace softforce::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json CamerasOf(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot) {
  Json cameras;
  cameras["image_size"] = {rig.cameras[0].width, rig.cameras[0].height};
  cameras["model"] =
      "OpenCV Brown-Conrady, D = k1 k2 p1 p2 k3 k4 k5 k6, or OpenCV fisheye, D = k1 k2 k3 k4; "
      "integer pixel coordinates are pixel centres";
  for (const camera::Camera& camera : rig.cameras) {
    const camera::Lens& lens = camera.lens;
    Eigen::Matrix3d K;
    K << lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1;
    cameras[camera.name] = {
        {"K", Rows(K)},
        {"D", std::vector<double>(lens.distortion.begin(),
                                  lens.distortion.begin() + camera::NumDistortion(lens.model))},
        {"T_camera_robot", Rows(InMillimetres(camera.T_camera_rig * T_rig_robot))}};
  }
  cameras["T_camera_robot_convention"] =
      "X_camera = T_camera_robot * X_robot (homogeneous, mm); camera x right, y down, z forward";
  if (rig.cameras.size() == 2) {
    const Eigen::Isometry3d T_second_first =
        rig.cameras[1].T_camera_rig * rig.cameras[0].T_camera_rig.inverse();
    cameras["stereo"] = {{"R", Rows(T_second_first.linear())},
                         {"t_mm", Millimetres(T_second_first.translation())},
                         {"convention", fmt::format("X_{} = R * X_{} + t", rig.cameras[1].name,
                                                    rig.cameras[0].name)}};
  }
  return cameras;
}

Json MaterialOf(const fem::Material& material) {
  return {{"law", fem::Name(material.model)},
          {"E_MPa", 1e-6 * material.youngs_modulus},
          {"nu", material.poissons_ratio}};
}

Json MaterialsOf(const fem::Body& body) {
  if (body.materials.size() == 1) return MaterialOf(body.materials[0]);
  Json regions;
  for (size_t r = 0; r < body.materials.size(); ++r) {
    regions[body.mesh.region_names[r]] = MaterialOf(body.materials[r]);
  }
  return {{"regions", regions}};
}

Json FiducialsOf(const scene::Scene& scene) {
  Json fiducials = Json::array();
  for (const calibration::Fiducial& fiducial : scene.cameras.fiducials) {
    const auto& [tl, tr, br, bl] = fiducial.corners;
    fiducials.push_back({{"id", fiducial.id},
                         {"family", fiducial.family},
                         {"size_mm", Rounded(1e3 * (tr - tl).norm())},
                         {"centre", Millimetres(0.25 * (tl + tr + br + bl))},
                         {"corners_TL_TR_BR_BL",
                          {Millimetres(tl), Millimetres(tr), Millimetres(br), Millimetres(bl)}}});
  }
  return fiducials;
}

Json MarkersOf(const scene::Scene& scene, const SimulatedWorld& world) {
  const bool dots = scene.markers.type == scene::MarkerType::kDot;
  Json markers = Json::array();
  for (size_t m = 0; m < world.markers.size(); ++m) {
    markers.push_back({{"id", scene.markers.points[m].id},
                       {"kind", dots ? "dot" : "tag"},
                       {"size_mm", Rounded(1e3 * scene.markers.size)},
                       {"rest", Millimetres(world.markers[m].Apply(world.mesh().nodes))},
                       {"normal", List(world.rest_normals[m])}});
  }
  return markers;
}

// What sets the simulation apart from what the estimator is told.
Json SettingsOf(const scene::Scene& scene, const scene::Simulation& simulation,
                const SimulatedWorld& world) {
  Json offsets = Json::object();
  for (const scene::Actuator& actuator : scene.actuators) {
    const double value = OffsetOf(actuator, simulation);
    switch (actuator.input) {
      case scene::ActuatorInput::kTension:
        offsets[actuator.name + "_N"] = value;
        break;
      case scene::ActuatorInput::kDisplacement:
        offsets[actuator.name + "_mm"] = 1e3 * value;
        break;
      case scene::ActuatorInput::kPressure:
        offsets[actuator.name + "_kPa"] = 1e-3 * value;
        break;
    }
  }
  return {{"seed", simulation.seed},
          {"cells", world.mesh().num_elements()},
          {"nodes", world.mesh().num_nodes()},
          {"order", world.mesh().order()},
          {"refined", simulation.refine},
          {"own_mesh", simulation.mesh_file ? simulation.mesh_file->filename().string() : ""},
          {"tolerance", simulation::kTruthTolerance},
          {"actuator_offsets", offsets},
          {"T_robot_mesh", Rows(InMillimetres(simulation.T_robot_mesh))}};
}

}  // namespace

nlohmann::ordered_json TruthHeader(const scene::Scene& scene, const scene::Simulation& simulation,
                                   const SimulatedWorld& world, const camera::Rig* rig,
                                   const Eigen::Isometry3d& T_rig_robot) {
  Json truth;
  truth["case"] = scene.name;
  truth["texture"] = scene.markers.type == scene::MarkerType::kDot ? "dot" : "tag";
  truth["scene"] = scene.name;
  truth["units"] = {{"length", "mm"}, {"force", "N"}, {"stress", "MPa"}, {"pixel", "px"}};
  truth["fps"] = simulation.rate;
  if (rig != nullptr) truth["cameras"] = CamerasOf(*rig, T_rig_robot);
  truth["material"] = MaterialsOf(world.direct->body());
  truth["material"]["self_weight"] =
      scene.gravity.isZero(0)
          ? Json("none")
          : Json{{"gravity_m_per_s2", List(scene.gravity)}, {"density_kg_per_m3", scene.density}};
  truth["fixed_region"] = "as in scene.yaml";
  truth["simulation"] = SettingsOf(scene, simulation, world);
  truth["fiducials"] = FiducialsOf(scene);
  truth["markers"] = MarkersOf(scene, world);
  truth["load_patch"] =
      scene.forces.patch > 0
          ? fmt::format(
                "uniform dead load on a flat disc of {:g} mm diameter; at_deformed is its "
                "load-weighted mean position",
                1e3 * scene.forces.patch)
          : "dead load on a point of the surface";
  if (!world.direct->body().cables.empty()) {
    truth["cables"] = Json::array();
    for (const fem::Cable& cable : world.direct->body().cables) {
      truth["cables"].push_back(
          {{"name", cable.name}, {"guide", Millimetres(simulation.T_robot_mesh * cable.guide)}});
    }
  }
  truth["frames"] = Json::array();
  return truth;
}

}  // namespace softforce::pipeline
