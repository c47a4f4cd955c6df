#include "softforce/scene/scene.h"

#include "scene/sections.h"

namespace softforce::scene {
namespace {

void ReadActuation(YamlMap& root, SceneFiles files, Scene& scene) {
  if (const auto actuators = root.Optional("actuators")) {
    scene.actuators = ReadActuators(*actuators);
  }
  if (scene.actuators.empty()) {
    if (const auto table = root.Optional("actuation")) {
      table->Fail("got a table of inputs, but the scene has no actuators",
                  "List them under the key \"actuators\", or leave this key out.");
    }
    return;
  }
  scene.actuation_file = FileOf(
      root.Required("actuation", "The actuators need a table of their inputs over time."), files);
  if (files == SceneFiles::kNone) return;
  scene.actuation = ReadActuationTable(*scene.actuation_file, scene.actuators);
}

// Cameras or motion capture.
void ReadSight(YamlMap& root, const std::optional<YamlValue>& measured, SceneFiles files,
               Scene& scene) {
  if (!measured) {
    scene.cameras = root.Required("cameras", "Or give \"measured\", points of motion capture.")
                        .ReadMap([&](YamlMap& map) { return ReadCameras(map, files); });
    return;
  }
  if (const auto cameras = root.Optional("cameras")) {
    cameras->Fail("got both \"cameras\" and \"measured\", expected one of them");
  }
  if (files == SceneFiles::kToSimulate) {
    measured->Fail("got points of motion capture, expected the section \"cameras\" to simulate",
                   "With \"pictures: false\" nothing but points is simulated.");
  }
  scene.measured = ReadMeasured(*measured, files);
}

// A tag of the body with the id of a tag of the base could be taken for it.
void RefuseSharedTags(const Scene& scene, const YamlValue& root) {
  if (scene.markers.type != MarkerType::kAprilTag) return;
  for (const calibration::Fiducial& fiducial : scene.cameras.fiducials) {
    for (const MarkerPoint& point : scene.markers.points) {
      if (fiducial.family != scene.markers.family || fiducial.id != point.id) continue;
      root.Fail("tag " + fiducial.family + " " + std::to_string(point.id) +
                " is both a marker and a fiducial, expected different ids");
    }
  }
}

}  // namespace

Scene LoadScene(const std::filesystem::path& file, SceneFiles files) {
  return ReadYamlFile(file, [&](YamlMap& root) {
    Scene scene;
    scene.file = std::filesystem::absolute(file).lexically_normal();
    scene.name = root.Required("name").Text();
    ReadBody(root.Required("body"), files, scene);
    ReadActuation(root, files, scene);
    const auto measured = root.Optional("measured");
    scene.markers = root.Required("markers").ReadMap(
        [&](YamlMap& map) { return ReadMarkers(map, measured.has_value()); });
    scene.forces =
        root.Required("forces").ReadMap([&](YamlMap& map) { return ReadForces(map, scene); });
    ReadSight(root, measured, files, scene);
    RefuseSharedTags(scene, root.value());
    if (const auto simulation = root.Optional("simulation")) {
      scene.simulation =
          simulation->ReadMap([&](YamlMap& map) { return ReadSimulation(map, files, scene); });
    }
    return scene;
  });
}

}  // namespace softforce::scene
