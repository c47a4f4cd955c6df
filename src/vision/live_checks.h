#pragma once

#include <vector>

#include "softforce/vision/live_cameras.h"

namespace softforce::vision {

// Throws InputError for names or sources that are missing, given twice, or of files.
void CheckCameras(const std::vector<LiveCamera>& cameras);

}  // namespace softforce::vision
