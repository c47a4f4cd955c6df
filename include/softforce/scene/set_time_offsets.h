#pragma once

#include <filesystem>

#include "softforce/camera/rig.h"

namespace softforce::scene {

// Writes the rig file `from` as `to` with the time offsets of `rig`'s cameras in it, which are
// those of the file. All other text stays as it is. Both may be the same file. `to` appears only
// once it is complete and reads back as meant. Throws InputError if it cannot be written, or a
// value stands where it cannot be replaced.
void WriteTimeOffsets(const std::filesystem::path& from, const camera::Rig& rig,
                      const std::filesystem::path& to);

}  // namespace softforce::scene
