#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softforce/scene/rig_file.h"

namespace softforce::scene::testing {

extern const char* const kCamchain;  // three cameras, as kalibr_calibrate_cameras writes them
extern const char* const kRosLeft;   // the left one of a pair, as ROS's camera_calibration has it

// Everything but the rig's own frame.
void ExpectSameRig(const camera::Rig& got, const camera::Rig& wanted);

// Why the files are refused, without the folder.
std::string RefusalOf(const std::vector<std::filesystem::path>& files,
                      const RigReadOptions& options = {});
std::string RefusalOfText(const std::string& text);  // of a file rig.yml

}  // namespace softforce::scene::testing
