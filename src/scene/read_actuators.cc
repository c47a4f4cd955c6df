#include <limits>

#include "scene/sections.h"

namespace softforce::scene {
namespace {

using base::Dimension;

void ReadCable(YamlMap& map, Actuator& cable) {
  cable.input = map.Required("input").Choice<ActuatorInput>(
      {{"displacement", ActuatorInput::kDisplacement}, {"tension", ActuatorInput::kTension}});
  const YamlValue points = map.Required("points");
  points.RefuseEmptyList("A cable pulls at one point of the body or more.");
  for (const YamlValue& point : points.Items()) {
    cable.points.push_back(point.Vector(Dimension::kLength));
  }
  cable.guide = map.Required("guide", "It is where the cable leaves towards its motor.")
                    .Vector(Dimension::kLength);
  if (const auto patch = map.Optional("patch")) {
    cable.patch = patch->PositiveQuantity(Dimension::kLength);
  }
  if (const auto offset = map.Optional("offset")) {
    cable.offset = offset->Quantity(cable.input == ActuatorInput::kTension ? Dimension::kForce
                                                                           : Dimension::kLength);
  }
}

void ReadChamber(YamlMap& map, Actuator& chamber) {
  chamber.input = ActuatorInput::kPressure;
  if (const auto input = map.Optional("input")) {
    input->Choice<ActuatorInput>({{"pressure", ActuatorInput::kPressure}});
  }
  chamber.group =
      map.Required("group", "It is the surface group of the mesh that is pressed on.").Text();
}

double ReadUncertainty(const YamlValue& value, ActuatorInput input) {
  if (value.Text() == "unknown") return std::numeric_limits<double>::infinity();
  switch (input) {
    case ActuatorInput::kTension:
      return value.PositiveQuantity(Dimension::kForce);
    case ActuatorInput::kDisplacement:
      return value.PositiveQuantity(Dimension::kLength);
    case ActuatorInput::kPressure:
      return value.PositiveQuantity(Dimension::kPressure);
  }
  return 0;
}

Actuator ReadActuator(YamlMap& map) {
  Actuator actuator;
  actuator.name = map.Required("name").Text();
  actuator.type = map.Required("type").Choice<ActuatorType>(
      {{"cable", ActuatorType::kCable}, {"pressure", ActuatorType::kPressure}});
  if (actuator.type == ActuatorType::kCable) {
    ReadCable(map, actuator);
  } else {
    ReadChamber(map, actuator);
  }
  if (const auto uncertainty = map.Optional("uncertainty")) {
    actuator.uncertainty = ReadUncertainty(*uncertainty, actuator.input);
  }
  return actuator;
}

}  // namespace

std::vector<Actuator> ReadActuators(const YamlValue& value) {
  std::vector<Actuator> actuators = value.ReadMaps(ReadActuator);
  RefuseRepeated(value, actuators,
                 [](const Actuator& actuator) { return "name \"" + actuator.name + "\""; });
  return actuators;
}

}  // namespace softforce::scene
