#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace softforce::vision {

// Pictures or a video of one camera.
struct CameraInput {
  struct Picture {
    std::filesystem::path file;
    int number = -1;  // what pairs it with the other cameras' pictures
  };

  std::string camera;
  std::vector<Picture> pictures;  // by rising number; empty if there is a video
  std::filesystem::path video;
};

// Sorts what a user gives to calibrate into cameras. Each input is a picture, a pattern as
// "left*.jpg" (with * and ?, for the name of the file), a folder of pictures, or a video, each of
// these also as NAME=…, which names the camera. Without names, files whose names differ in one
// number only belong to one camera, which is called by what sets its files' names or folder apart
// from the others': left01.jpg, right01.jpg; rig_07_cam0.png; left/0001.png. Cameras come in the
// order of their first input.
//
// Throws InputError, naming the file or the camera, if there are no inputs, a pattern matches
// nothing, a file is neither picture nor video, pictures and videos are mixed, or a picture lacks
// its partner in another camera.
std::vector<CameraInput> SortInputs(const std::vector<std::string>& inputs);

// What all cameras saw at one moment.
struct PictureSet {
  int number = -1;                   // of the pictures, or of the videos' frame from 0
  std::vector<std::string> sources;  // one per camera: "left07.jpg", "left.mp4 frame 120"
  std::vector<cv::Mat> pictures;     // one per camera, 8-bit grey
};

// The pictures of all cameras, set by set: those of the same number, or of the same frame.
class BoardPictures {
 public:
  // Throws InputError if a video cannot be opened or is of another length than the first.
  explicit BoardPictures(std::vector<CameraInput> cameras);
  ~BoardPictures();
  BoardPictures(BoardPictures&&) noexcept;

  const std::vector<CameraInput>& cameras() const;
  bool is_video() const;
  int announced_sets() const;  // 0 if a video does not say

  // The next set, or nothing at the end. Throws InputError, naming the file, if a picture cannot be
  // read or is of another size than the camera's first one.
  std::optional<PictureSet> Next();

  // Passes over sets, of pictures without reading them; returns how many there were.
  int Skip(int sets);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::vision
