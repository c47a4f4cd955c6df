#pragma once

#include <filesystem>

#include "softforce/camera/rig.h"

namespace softforce::scene {

// Reads a rig.yaml: cameras by name with lens, resolution and T_camera_rig (4×4, metres),
// optionally T_rig_robot. Throws InputError naming file, camera and key: a rotation that is none, a
// lens model it does not know, a resolution or focal length that is not positive, …
camera::Rig LoadRig(const std::filesystem::path& file);

// Writes it so that LoadRig reads back the same values.
void SaveRig(const camera::Rig& rig, const std::filesystem::path& file);

}  // namespace softforce::scene
