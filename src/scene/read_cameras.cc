#include <algorithm>

#include "scene/sections.h"

namespace softforce::scene {
namespace {

// Whether a source has the looks of a URL, a device (or its number) or a GStreamer pipeline.
bool LooksLive(const std::string& source) {
  const auto has = [&](const char* part) { return source.find(part) != std::string::npos; };
  const bool is_number = !source.empty() && source.find_first_not_of("0123456789") == source.npos;
  return has("://") || source.rfind("/dev/", 0) == 0 || (has(" ") && has("!")) || is_number;
}

std::string ReadSource(const YamlValue& value, SceneFiles files) {
  std::error_code ignored;  // a pipeline may be too long for a file's name
  const bool is_file = std::filesystem::is_regular_file(value.Path(), ignored);
  if (!is_file && LooksLive(value.Text())) return value.Text();
  // The folder of one camera in a recorded one.
  if (std::filesystem::is_directory(value.Path(), ignored)) return value.Path().string();
  const bool needed = files == SceneFiles::kAll || files == SceneFiles::kToRegister;
  return (needed ? value.ExistingFile() : value.Path()).string();
}

std::map<std::string, std::string> ReadSources(YamlMap& map, SceneFiles files) {
  std::map<std::string, std::string> sources;
  for (const std::string& camera : map.Keys()) {
    sources[camera] = ReadSource(map.Required(camera), files);
  }
  if (sources.empty()) map.value().Fail("got no cameras, expected at least one");
  return sources;
}

calibration::Fiducial ReadFiducial(YamlMap& map) {
  calibration::Fiducial fiducial;
  if (const auto family = map.Optional("family")) fiducial.family = family->Text();
  fiducial.id = map.Required("id").Integer(0);
  const std::vector<YamlValue> corners =
      map.Required("corners", "Top left, top right, bottom right, bottom left of the upright tag.")
          .Items({4});
  std::transform(corners.begin(), corners.end(), fiducial.corners.begin(),
                 [](const YamlValue& corner) { return corner.Vector(base::Dimension::kLength); });
  return fiducial;
}

}  // namespace

Cameras ReadCameras(YamlMap& map, SceneFiles files) {
  Cameras cameras;
  cameras.rig = FileOf(map.Required("rig"), files);
  cameras.sources = map.Required("sources", "Write for example: {left: left.mp4, right: right.mp4}")
                        .ReadMap([&](YamlMap& sources) { return ReadSources(sources, files); });
  if (const auto fiducials = map.Optional("fiducials")) {
    cameras.fiducials = fiducials->ReadMaps(ReadFiducial);
    RefuseRepeated(*fiducials, cameras.fiducials, [](const calibration::Fiducial& fiducial) {
      return "tag " + fiducial.family + " " + std::to_string(fiducial.id);
    });
  }
  return cameras;
}

}  // namespace softforce::scene
