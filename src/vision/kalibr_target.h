#pragma once

#include <filesystem>

#include "softforce/vision/board.h"

namespace softforce::vision {

// A target file of Kalibr: target_type aprilgrid, or checkerboard with square cells. Throws
// InputError, naming the file and the entry.
Board ReadKalibrTarget(const std::filesystem::path& file);

}  // namespace softforce::vision
