#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/vision/recording.h"

namespace softforce::testing {

// A folder of the running test's own, empty at first.
std::filesystem::path TempFolder();

// A grey picture that tells its frame's number: ground and bar both depend on it.
cv::Mat NumberedPicture(int frame, cv::Size size);
// Grey levels of the ground and the bar in it.
int GroundLevel(int frame);
int BarLevel(int frame);

struct VideoKind {
  std::string extension;  // ".mp4", ".mkv"
  std::string fourcc = "avc1";
  int frames = 30;
  cv::Size size{320, 240};
  double frames_per_second = 25;
};
std::filesystem::path WriteVideo(const std::filesystem::path& stem, const VideoKind& kind);

// The first `share` of a file, under a new name.
std::filesystem::path CutFile(const std::filesystem::path& file, double share,
                              const std::filesystem::path& to);

// Two cameras, left and right, of a size.
camera::Rig RigOf(cv::Size size);

std::vector<cv::Mat> AllPictures(vision::Recording* recording, int camera);

// What a recording of these files is refused with; fails the test if it is accepted.
std::string Refusal(const camera::Rig& rig, const std::vector<vision::Recording::Source>& sources);

}  // namespace softforce::testing
