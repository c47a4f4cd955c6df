#include "commands/camera_sources.h"

#include <fmt/format.h>

#include "softforce/base/input_error.h"

namespace softforce::apps {

std::map<std::string, std::string> ParseCameraSources(const std::vector<std::string>& cameras) {
  std::map<std::string, std::string> sources;
  for (const std::string& camera : cameras) {
    const size_t equals = camera.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw base::InputError("--camera", fmt::format("got \"{}\", expected NAME=SOURCE", camera),
                             "Example: --camera left=left.mp4");
    }
    const std::string name = camera.substr(0, equals);
    if (!sources.emplace(name, camera.substr(equals + 1)).second) {
      throw base::InputError("--camera", fmt::format("camera \"{}\" is given twice", name),
                             "Give each camera a name of its own.");
    }
  }
  return sources;
}

}  // namespace softforce::apps
