#include "pipeline/input_paths.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {

namespace fs = std::filesystem;

nlohmann::ordered_json PathToKeep(const fs::path& file, const fs::path& results) {
  std::error_code ignored;  // a path that cannot be resolved is kept as it is
  const fs::path full = fs::weakly_canonical(fs::absolute(file), ignored);
  const fs::path from = fs::weakly_canonical(fs::absolute(results), ignored);
  return {{"path", full.string()}, {"from_results", full.lexically_relative(from).string()}};
}

fs::path FindKeptPath(const nlohmann::ordered_json& kept, const fs::path& results,
                      const std::string& what, const std::string& option) {
  const fs::path near = fs::absolute(results / kept.value("from_results", std::string()));
  const fs::path full = kept.value("path", std::string());
  for (const fs::path& place : {near.lexically_normal(), full}) {
    std::error_code ignored;
    if (place.has_filename() && fs::exists(place, ignored)) return place;
  }
  throw base::InputError(results.string(),
                         fmt::format("the {} of the run is gone: neither {} nor {} is there", what,
                                     near.lexically_normal().string(), full.string()),
                         fmt::format("Put it back, or say where it is now: {}", option));
}

}  // namespace softforce::pipeline
