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
  RefuseRepeated(points, markers.points,
                 [](const MarkerPoint& point) { return "id " + std::to_string(point.id); });
  RefuseRepeated(points, markers.points,
                 [](const MarkerPoint& point) { return "label \"" + point.label + "\""; });
  return markers;
}

}  // namespace softforce::scene
