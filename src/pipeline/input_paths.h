#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace softforce::pipeline {

// A path as summary.json keeps it: from the folder of the results, so that both can be moved
// together, and from the root, so that the results can be moved alone.
nlohmann::ordered_json PathToKeep(const std::filesystem::path& file,
                                  const std::filesystem::path& results);

// Where that file is now. Throws InputError naming `what`, the places that were looked in, and
// `option`, by which another one is given.
std::filesystem::path FindKeptPath(const nlohmann::ordered_json& kept,
                                   const std::filesystem::path& results, const std::string& what,
                                   const std::string& option);

}  // namespace softforce::pipeline
