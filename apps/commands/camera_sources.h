#pragma once

#include <map>
#include <string>
#include <vector>

namespace softforce::apps {

// Camera → source, from the values of --camera, each NAME=SOURCE. Throws InputError for another
// form.
std::map<std::string, std::string> ParseCameraSources(const std::vector<std::string>& cameras);

}  // namespace softforce::apps
