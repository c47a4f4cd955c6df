#include <fmt/format.h>

#include <algorithm>

#include "scene/simulation_section.h"
#include "scene/time_table.h"

namespace softforce::scene {
namespace {

using base::Dimension;

const Candidate& CandidateOf(const YamlValue& value, const Scene& scene) {
  const int id = value.Integer(0);
  for (const Candidate& candidate : scene.forces.candidates) {
    if (candidate.id == id) return candidate;
  }
  value.Fail(fmt::format("no candidate has the id {}", id),
             "Candidates are listed under \"forces\"; another place is given by \"position\".");
}

SimulatedForce ReadForce(YamlMap& map, const Scene& scene) {
  SimulatedForce force;
  const auto candidate = map.Optional("candidate");
  const auto position = map.Optional("position");
  if (candidate.has_value() == position.has_value()) {
    map.value().Fail(candidate ? "got both a candidate and a position, expected one of them"
                               : "got neither, expected a candidate or a position");
  }
  if (candidate) {
    const Candidate& at = CandidateOf(*candidate, scene);
    force.name = fmt::format("F{}", at.id);
    force.position = at.position;
  } else {
    force.position = position->Vector(Dimension::kLength);
  }
  const YamlValue history = map.Required(
      "history", "Write for example: [{time: 0 s, force: 0 0 0 N}, {time: 1 s, force: 0 0 -1 N}]");
  history.RefuseEmptyList("A force that is held all the time has one item.");
  const std::vector<YamlValue> items = history.Items();
  force.force.resize(static_cast<Eigen::Index>(items.size()), 3);
  for (size_t i = 0; i < items.size(); ++i) {
    items[i].ReadMap([&](YamlMap& moment) {
      const YamlValue time = moment.Required("time");
      const double time_s = time.Quantity(Dimension::kTime);
      if (i > 0 && time_s <= force.time_s.back()) {
        time.Fail(fmt::format("got {} s after {} s, expected ascending times", time_s,
                              force.time_s.back()));
      }
      force.time_s.push_back(time_s);
      force.force.row(static_cast<Eigen::Index>(i)) =
          moment.Required("force").Vector(Dimension::kForce);
      return true;
    });
  }
  return force;
}

// Columns ID_x_N, ID_y_N, ID_z_N for any of the candidates; a component without a column is 0.
std::vector<SimulatedForce> ReadForceTable(const std::filesystem::path& file, const Scene& scene) {
  std::vector<std::string> names;
  for (const Candidate& candidate : scene.forces.candidates) {
    for (const char* axis : {"x", "y", "z"}) {
      names.push_back(fmt::format("{}_{}_N", candidate.id, axis));
    }
  }
  const TimeTable table = ReadTimeTable(file, names, Columns::kSome);
  std::vector<SimulatedForce> forces;
  for (size_t c = 0; c < scene.forces.candidates.size(); ++c) {
    const Candidate& candidate = scene.forces.candidates[c];
    SimulatedForce force{fmt::format("F{}", candidate.id), candidate.position, table.time_s,
                         Eigen::MatrixXd::Zero(table.values.rows(), 3)};
    bool acts = false;
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = std::find(table.columns.begin(), table.columns.end(), names[3 * c + axis]);
      if (found == table.columns.end()) continue;
      force.force.col(axis) = table.values.col(found - table.columns.begin());
      acts = true;
    }
    if (acts) forces.push_back(force);
  }
  return forces;
}

}  // namespace

std::vector<SimulatedForce> ReadSimulatedForces(const YamlValue& value, SceneFiles files,
                                                const Scene& scene) {
  if (!value.IsList()) {
    const std::filesystem::path file = FileOfSimulation(value, files);
    return ReadsFilesOfSimulation(files) ? ReadForceTable(file, scene)
                                         : std::vector<SimulatedForce>{};
  }
  std::vector<SimulatedForce> forces =
      value.ReadMaps([&](YamlMap& map) { return ReadForce(map, scene); });
  for (size_t i = 0; i < forces.size(); ++i) {
    if (forces[i].name.empty()) forces[i].name = fmt::format("P{}", i);
  }
  RefuseRepeated(value, forces, [](const SimulatedForce& force) { return "force " + force.name; });
  return forces;
}

std::map<std::string, double> ReadActuatorOffsets(YamlMap& map, const Scene& scene) {
  std::map<std::string, double> offsets;
  for (const Actuator& actuator : scene.actuators) {
    const auto offset = map.Optional(actuator.name);
    if (!offset) continue;
    const Dimension dimension = actuator.input == ActuatorInput::kTension    ? Dimension::kForce
                                : actuator.input == ActuatorInput::kPressure ? Dimension::kPressure
                                                                             : Dimension::kLength;
    offsets[actuator.name] = offset->Quantity(dimension);
  }
  return offsets;
}

}  // namespace softforce::scene
