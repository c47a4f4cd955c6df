#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace softforce::scene {

// Numbers of a scene that are to be replaced.
struct SceneChanges {
  // By region as in Scene::materials ("": the material of the whole body).
  std::map<std::string, double> youngs_modulus;  // Pa
  std::map<std::string, double> poissons_ratio;
  std::map<std::string, double> cable_offset;  // m or N, by the actuator's name; replaces the old
};

// Writes the scene `from` as `to` with these numbers in it. All other text, comments and order stay
// as they are, but for relative paths if `to` is in another folder: they still lead to the same
// files. Both may be the same file; a link stays one, and a file keeps its permissions. `to`
// appears only once it is complete and reads back as meant. Throws InputError if a number stands
// where it cannot be replaced, such as in a YAML anchor, or `to` cannot be written.
void WriteChangedScene(const std::filesystem::path& from, const SceneChanges& changes,
                       const std::filesystem::path& to);

}  // namespace softforce::scene
