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
    sources[camera.substr(0, equals)] = camera.substr(equals + 1);
  }
  return sources;
}

}  // namespace softforce::apps
