#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace softforce::scene {

// The files of a recording, by their names in its folder.
struct RecordedFiles {
  std::string mesh, rig;
  std::string actuation;                       // empty: no actuators
  std::map<std::string, std::string> sources;  // camera → video; empty: there are none
  std::string measured;                        // instead of cameras if there are no sources
};

// Writes a copy of a scene file that names these files and has no section "simulation". Comments
// are lost. The file shows up under its name only when it is complete; throws InputError if it
// cannot be written.
void SaveRecordedScene(const std::filesystem::path& original, const RecordedFiles& files,
                       const std::filesystem::path& copy);

}  // namespace softforce::scene
