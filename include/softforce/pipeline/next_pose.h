#pragma once

#include <optional>
#include <string>

#include "softforce/calibration/calibrate.h"

namespace softforce::pipeline {

struct GuideOptions {
  int columns = 3, rows = 3;  // regions of each picture in which the board must have been
  double tilt = 0.35;         // rad, from which on a board counts as tilted
  int views_per_tilt = 2;     // to each of the four sides, of every camera
  int min_views = 12;         // of every camera; and that each shares with another one
  // px, standard deviation of the projection at the working distance; see Certainty. Collecting
  // goes on when all regions and tilts are there, until it is reached or so many views are there.
  double max_uncertainty_px = 0.2;
  int max_views = 60;

  void Check() const;  // throws InputError naming the option
};

// Which way the board's face is turned, as the camera sees it.
enum class Facing { kAny, kLeft, kRight, kUp, kDown };

// Where the board should be held next: in a region of a camera's picture, turned to a side.
struct WantedPose {
  int camera = -1;
  int column = 1, row = 1;
  Facing facing = Facing::kAny;
  bool shared = false;  // so that another camera sees it too
};

struct Guidance {
  double done = 0;                 // share of what is wanted that has been seen
  std::optional<WantedPose> next;  // nothing: all has been seen

  // "left: top right of the picture, face turned to the left by 30 to 45 degrees"
  std::string Text(const calibration::CalibrationInput& input, const GuideOptions& options) const;
};

std::string RegionText(const WantedPose& pose, const GuideOptions& options);  // "top right"

// Which way a board faces in one picture. No lens is known yet: a usual focal length (that of a
// field of view of 50°) is good enough to tell a board that is tilted by 20° from a straight one.
Facing FacingOf(const std::vector<Eigen::Vector3d>& board, const vision::BoardView& seen,
                const calibration::CameraToCalibrate& camera, double min_tilt);

// From the views so far, the one that helps most next: the corners and edges of each picture, tilts
// to all sides, and enough views that cameras share.
Guidance NextPose(const calibration::CalibrationInput& so_far, const GuideOptions& options = {});

}  // namespace softforce::pipeline
