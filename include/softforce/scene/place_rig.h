#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include "softforce/geometry/rigid.h"

namespace softforce::scene {

// Where a rig stands, and how sure that is.
struct RigPlace {
  Eigen::Isometry3d T_rig_robot = Eigen::Isometry3d::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  // see camera::Rig
  std::string comment;                                         // for a person, one line or several
};

// Writes the rig file `from` as `to` with this place in it, and its comment. All other text, and
// so the calibration's statistics, stay as they are. Both may be the same file, unless it is of
// another program's format: that one is written as a rig.yaml. `to` appears only once it is
// complete and reads back as meant. Throws InputError if it cannot be written, or T_rig_robot
// stands where it cannot be replaced.
void WritePlacedRig(const std::filesystem::path& from, const RigPlace& place,
                    const std::filesystem::path& to);

// The place in a rig.yaml, or in a file with a place and no cameras, as motion capture has it.
// Throws InputError if there is none.
RigPlace LoadPlace(const std::filesystem::path& file);

// Writes a file with a place and no cameras, complete or not at all.
void WritePlace(const RigPlace& place, const std::filesystem::path& file);

// Throws InputError if `from` would be replaced by itself with a place that its format cannot hold.
void CheckCanHoldPlace(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace softforce::scene
