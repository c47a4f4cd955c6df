#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

namespace softforce::scene {

// Writes the rig file `from` as `to` with this T_rig_robot in it, and a comment beside it (one line
// or several). All other text stays as it is. Both may be the same file. `to` appears only once it
// is complete and reads back as meant. Throws InputError if it cannot be written, or T_rig_robot
// stands where it cannot be replaced.
void WritePlacedRig(const std::filesystem::path& from, const Eigen::Isometry3d& T_rig_robot,
                    const std::string& comment, const std::filesystem::path& to);

}  // namespace softforce::scene
