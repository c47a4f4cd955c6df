#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "scene/rig_formats.h"
#include "scene/sections.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/scene/place_rig.h"

namespace softforce::scene {

RigPlace LoadPlace(const std::filesystem::path& file) {
  return ReadYamlFile(file, [&](YamlMap& root) {
    root.Optional("cameras");  // of a rig.yaml
    root.Optional("calibration");
    RigPlace place;
    place.T_rig_robot =
        ReadTransform(root.Required("T_rig_robot", "Find it with: softforce register --help"));
    if (const auto covariance = root.Optional("T_rig_robot_covariance")) {
      place.covariance = ReadPlaceCovariance(*covariance);
    }
    return place;
  });
}

void WritePlace(const RigPlace& place, const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    const std::vector<std::string> keys = YamlMap(YamlValue::FromFile(file)).Keys();
    if (std::count(keys.begin(), keys.end(), "cameras") > 0) {
      throw base::InputError(file.string(),
                             "is a rig with cameras, which a place of motion capture would replace",
                             "Give another name.");
    }
  }
  base::PendingFile pending(file);
  std::ofstream stream(pending.temporary(), std::ios::binary);
  stream << fmt::format("softforce: {}\n", kFormatVersion)
         << PlaceText(place.T_rig_robot, place.covariance, place.comment);
  stream.close();
  if (!stream) {
    throw base::InputError(file.string(), "cannot be written",
                           "Check that its folder exists, may be written to, and has room.");
  }
  pending.Commit();
}

}  // namespace softforce::scene
