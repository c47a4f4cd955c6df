#include "scene/sections.h"

namespace softforce::scene {
namespace {

using base::Dimension;

MarkerPoint ReadMarkerPoint(YamlMap& map) {
  MarkerPoint point;
  point.id = map.Required("id").Integer(0);
  point.position = map.Required("position").Vector(Dimension::kLength);
  const auto label = map.Optional("label");
  point.label = label ? label->Text() : std::to_string(point.id);
  return point;
}

void ReadDirection(const YamlValue& value, Candidate& candidate) {
  if (!value.IsList()) {
    candidate.direction = value.Choice<ForceDirection>(
        {{"free", ForceDirection::kFree}, {"normal", ForceDirection::kNormal}});
    return;
  }
  const Eigen::Vector3d direction(value.Numbers({3}).data());
  if (direction.isZero(0)) value.Fail("got [0, 0, 0], expected a direction, e.g. [0, 0, -1]");
  candidate.direction = ForceDirection::kFixed;
  candidate.fixed_direction = direction.stableNormalized();
}

Candidate ReadCandidate(YamlMap& map) {
  Candidate candidate;
  candidate.id = map.Required("id").Integer(0);
  candidate.position = map.Required("position").Vector(Dimension::kLength);
  ReadDirection(map.Required("direction", "Write free, normal, or for example [0, 0, -1]."),
                candidate);
  return candidate;
}

template <class T>
std::string IdLabel(const T& item) {
  return "id " + std::to_string(item.id);
}

}  // namespace

Markers ReadMarkers(YamlMap& map, bool measured) {
  Markers markers;
  const std::vector<std::pair<std::string, MarkerType>> types = {
      {"dot", MarkerType::kDot}, {"apriltag", MarkerType::kAprilTag}};
  const auto type = measured ? map.Optional("type") : map.Required("type");
  if (type) markers.type = type->Choice<MarkerType>(types);
  if (markers.type == MarkerType::kAprilTag) {
    if (measured) {
      type->Fail("got apriltag, but points of motion capture are no tags, expected dot",
                 "Leave out the keys \"type\", \"family\" and \"size\" of the markers.");
    }
    markers.family = map.Required("family").Text();
  }
  const auto size = measured ? map.Optional("size") : map.Required("size");
  if (size) markers.size = size->PositiveQuantity(Dimension::kLength);
  const YamlValue points = map.Required("points");
  points.RefuseEmptyList("Forces are read from the displacements of markers.");
  markers.points = points.ReadMaps(ReadMarkerPoint);
  RefuseRepeated(points, markers.points, IdLabel<MarkerPoint>);
  RefuseRepeated(points, markers.points,
                 [](const MarkerPoint& point) { return "label \"" + point.label + "\""; });
  return markers;
}

Forces ReadForces(YamlMap& map) {
  Forces forces;
  forces.known_locations =
      map.Required("known", "Write true if the forces act at the candidates, false if near them.")
          .Choice<bool>({{"true", true}, {"false", false}});
  if (const auto patch = map.Optional("patch")) {
    forces.patch = patch->PositiveQuantity(Dimension::kLength);
  }
  const YamlValue candidates = map.Required("candidates");
  candidates.RefuseEmptyList("List the places where a force may act.");
  forces.candidates = candidates.ReadMaps(ReadCandidate);
  RefuseRepeated(candidates, forces.candidates, IdLabel<Candidate>);
  return forces;
}

}  // namespace softforce::scene
