#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "softforce/calibration/register.h"
#include "softforce/camera/rig.h"
#include "softforce/fem/material.h"
#include "softforce/render/picture.h"
#include "softforce/scene/measured.h"
#include "softforce/simulation/measure.h"
#include "softforce/simulation/scenery.h"

namespace softforce::scene {

// The contents of a scene.yaml, in SI units, with every path made absolute. Places are in the robot
// frame.

struct MeshFile {
  std::filesystem::path file;
  double metres_per_unit = NAN;
  int order = 2;  // 1 or 2
};

// Nodes that do not move: those in a box, or those of a named surface group.
struct FixedRegion {
  std::string group;                                                            // empty: the box
  Eigen::Vector3d box_min = Eigen::Vector3d::Constant(NAN), box_max = box_min;  // m
};

enum class ActuatorType { kCable, kPressure };
enum class ActuatorInput { kTension, kDisplacement, kPressure };

struct Actuator {
  std::string name;
  ActuatorType type = ActuatorType::kCable;
  ActuatorInput input = ActuatorInput::kDisplacement;
  std::vector<Eigen::Vector3d>
      points;  // m, on the body: attachment first, then via points to the guide
  Eigen::Vector3d guide = Eigen::Vector3d::Constant(NAN);  // m, fixed in space
  double patch = 0;  // m, diameter over which the attachment is spread
  // m or N, of a cable: added to every input of the table. How much more the cable is really
  // shortened or pulled than it is told.
  double offset = 0;
  std::string group;  // pressure: the surface group it acts on
  // Standard deviation of what it does about its input, N, m or Pa: 0 for an exact input, infinity
  // for one that is not known at all.
  double uncertainty = 0;
};

// Inputs of the actuators over time; held before the first row and after the last.
struct ActuationTable {
  std::vector<double> time_s;  // ascending
  Eigen::MatrixXd
      inputs;  // rows like time_s, a column per actuator in the scene's order; N, m or Pa

  Eigen::VectorXd At(double time) const;  // linear between rows
};

enum class MarkerType { kDot, kAprilTag };

struct MarkerPoint {
  int id = -1;
  Eigen::Vector3d position;  // m, body at rest
  std::string label = {};    // what motion capture calls it; the id if the scene does not say
};

struct Markers {
  MarkerType type = MarkerType::kDot;
  std::string family;  // of tags
  // m: diameter of a dot, side of a tag's black square; NaN if motion capture measures it, and the
  // scene does not say.
  double size = NAN;
  std::vector<MarkerPoint> points;
};

enum class ForceDirection { kFree, kNormal, kFixed };

struct Candidate {
  int id = -1;
  Eigen::Vector3d position;  // m, body at rest
  ForceDirection direction = ForceDirection::kFree;
  Eigen::Vector3d fixed_direction = Eigen::Vector3d::Zero();  // unit vector; kFixed only
};

struct Forces {
  bool known_locations = true;
  double patch = 0;  // m, diameter over which each force is spread
  std::vector<Candidate> candidates;
};

struct Cameras {
  std::filesystem::path rig;
  std::map<std::string, std::string> sources;  // camera name → absolute file path, device, URL …
  std::vector<calibration::Fiducial> fiducials;
};

// A force of a simulated recording over time.
struct SimulatedForce {
  std::string name;
  Eigen::Vector3d position;    // m, body at rest
  std::vector<double> time_s;  // ascending
  Eigen::MatrixXd force;       // N, a row of x y z per time; held before the first, after the last

  Eigen::Vector3d At(double time) const;  // linear between the times
};

// Where the rig of a simulated recording stands, if its file does not say so.
struct SimulatedStand {
  Eigen::Vector3d position;  // m, robot frame, of the first camera
  Eigen::Vector3d looks_at;  // what is in the middle of its picture
};

// How a recording with truth is made of a scene, apart from what the estimator assumes.
struct Simulation {
  std::uint32_t seed = 1;
  int frames = 30;
  double rate = 30;  // Hz
  // The body of the direct problem.
  std::optional<std::filesystem::path> mesh_file;  // nothing: the scene's mesh
  double metres_per_unit = NAN;                    // of mesh_file
  int order = 2;                                   // 1 or 2
  int refine = 1;                                  // times that every cell is cut into 8
  std::map<std::string, fem::Material> materials;  // as the scene's; empty: the scene's
  // What acts on it.
  std::vector<SimulatedForce> forces;
  std::optional<std::filesystem::path> forces_file;     // the table they come from, if any
  std::optional<std::filesystem::path> actuation_file;  // of `actuation`
  std::optional<ActuationTable> actuation;              // nothing: the scene's
  // N, m or Pa more than told, by name; an actuator without one has its offset of the scene.
  std::map<std::string, double> actuator_offsets;
  Eigen::Isometry3d T_robot_mesh = Eigen::Isometry3d::Identity();  // where the body really stands
  // What is seen of it.
  simulation::MeasureOptions markers;
  std::optional<Eigen::Isometry3d> T_rig_robot;
  std::optional<SimulatedStand> stand;
  bool pictures = true;
  render::PictureOptions picture;
  bool light_given = false;                           // else it comes from where the cameras stand
  Eigen::Vector3d tag_up = Eigen::Vector3d::UnitY();  // roughly; robot frame, body at rest
  int strewn_decoys = 0;
  std::vector<Eigen::Vector3d> decoys;  // m, on the body at rest
  std::vector<simulation::Occluder> occluders;
  double cable_diameter = 8e-4;  // m; 0: cables are not seen
};

struct Scene {
  std::filesystem::path file;
  std::string name;
  MeshFile mesh;
  std::map<std::string, fem::Material> materials;  // by region name; "" is the whole body
  std::vector<FixedRegion> fixed;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // m/s²
  double density = 0;                                 // kg/m³
  std::vector<Actuator> actuators;
  std::optional<std::filesystem::path> actuation_file;
  ActuationTable actuation;
  Markers markers;
  Forces forces;
  Cameras cameras;                   // none if `measured`
  std::optional<Measured> measured;  // instead of cameras
  std::optional<Simulation> simulation;
};

// Which of the files that a scene names must be there.
enum class SceneFiles {
  kAll,
  kNone,        // to judge a mesh before anything is recorded; the actuation table is left empty
  kToRegister,  // all but where motion capture's frame is, which is to be found
  kToSimulate,  // all but the recording, and those that the section "simulation" names
  kToDesign,    // all but the recording, which may not be made yet
};

// Reads and checks a scene and its actuation table. Throws InputError naming file, key and line on
// anything it does not understand: an unknown key, a missing one, a quantity without unit or of the
// wrong kind, an id given twice, an actuator without a column in the table, …
Scene LoadScene(const std::filesystem::path& file, SceneFiles files = SceneFiles::kAll);

}  // namespace softforce::scene
