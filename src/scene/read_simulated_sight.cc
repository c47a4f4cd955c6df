#include <fmt/format.h>

#include <algorithm>

#include "scene/simulation_section.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

using base::Dimension;

simulation::Dropout ReadDropout(YamlMap& map, const Scene& scene) {
  simulation::Dropout dropout;
  ReadSpan(map, &dropout);
  const auto ids = map.Optional("ids");
  if (!ids) return dropout;
  ids->RefuseEmptyList("Leave the key out for all markers.");
  for (const YamlValue& item : ids->Items()) {
    const int id = item.Integer(0);
    const std::vector<MarkerPoint>& points = scene.markers.points;
    const auto found = std::find_if(points.begin(), points.end(),
                                    [id](const MarkerPoint& point) { return point.id == id; });
    if (found == points.end()) item.Fail(fmt::format("no marker has the id {}", id));
    dropout.markers.push_back(static_cast<int>(found - points.begin()));
  }
  return dropout;
}

simulation::Occluder ReadOccluder(YamlMap& map) {
  simulation::Occluder occluder;
  ReadSpan(map, &occluder);
  occluder.begin = map.Required("position").Vector(Dimension::kLength);
  occluder.end = occluder.begin;
  if (const auto to = map.Optional("to")) {
    occluder.end = to->Vector(Dimension::kLength);
    map.Required("until", "It is when the occluder arrives at \"to\".");
  }
  if (const auto reach = map.Optional("reach")) {
    occluder.reach = reach->Vector(Dimension::kLength);
  }
  occluder.diameter = map.Required("diameter").PositiveQuantity(Dimension::kLength);
  if (const auto grey = map.Optional("grey")) {
    occluder.grey = grey->Number();
    if (!(occluder.grey >= 0 && occluder.grey <= 255)) {
      grey->Fail(fmt::format("got {}, expected a grey level from 0 to 255", occluder.grey));
    }
  }
  return occluder;
}

}  // namespace

simulation::MeasureOptions ReadMarkerNoise(YamlMap& map, const Scene& scene) {
  simulation::MeasureOptions options;
  if (const auto noise = map.Optional("noise")) {
    options.noise = noise->Quantity(Dimension::kLength);
  }
  if (const auto hidden = map.Optional("hidden")) options.hidden_share = hidden->Number();
  if (const auto dropouts = map.Optional("dropouts")) {
    options.dropouts = dropouts->ReadMaps([&](YamlMap& item) { return ReadDropout(item, scene); });
  }
  try {
    options.Check();
  } catch (const base::InputError& error) {
    map.value().Fail(error.what());
  }
  return options;
}

void ReadPictures(YamlMap& map, Simulation* simulation) {
  render::PictureOptions& picture = simulation->picture;
  const auto number = [&](const char* key, double* value) {
    if (const auto given = map.Optional(key)) *value = given->Number();
  };
  number("blur_px", &picture.blur);
  number("noise_grey", &picture.noise);
  number("contrast", &picture.contrast);
  number("brightness_grey", &picture.brightness);
  if (const auto gradient = map.Optional("light_gradient")) {
    picture.light_gradient = Eigen::Vector2d(gradient->Numbers({2}).data());
  }
  if (const auto light = map.Optional("light")) {
    picture.light = Eigen::Vector3d(light->Numbers({3}).data());
    simulation->light_given = true;
  }
  try {
    picture.Check();
  } catch (const base::InputError& error) {
    map.value().Fail(error.what());
  }
  if (const auto up = map.Optional("tag_up")) {
    simulation->tag_up = Eigen::Vector3d(up->Numbers({3}).data());
    if (simulation->tag_up.isZero(0)) up->Fail("got [0, 0, 0], expected a direction");
  }
  if (const auto count = map.Optional("strewn_decoys")) {
    simulation->strewn_decoys = count->Integer(0);
  }
  if (const auto decoys = map.Optional("decoys")) {
    for (const YamlValue& place : decoys->Items()) {
      simulation->decoys.push_back(place.Vector(Dimension::kLength));
    }
  }
  if (const auto occluders = map.Optional("occluders")) {
    simulation->occluders = occluders->ReadMaps(ReadOccluder);
  }
  if (const auto diameter = map.Optional("cable_diameter")) {
    simulation->cable_diameter = diameter->Quantity(Dimension::kLength);
    if (simulation->cable_diameter < 0) diameter->Fail("must be 0 or more");
  }
}

}  // namespace softforce::scene
