#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/vision/board_detector.h"

namespace softforce::calibration {

// How well a rig measures a board that it was not calibrated with.
struct HoldOutView {
  int view = -1;
  int points = 0;        // detected in this view, of all cameras
  int triangulated = 0;  // points of the board
  // px: reprojection error after only the board's pose was fitted; mean square length of the
  // errors.
  double squared_px = NAN;
  // "Square length": m², mean square of (distance between two triangulated neighbours − their
  // distance on the board). NaN unless triangulated.
  double squared_square = NAN;
  int neighbours = 0;  // pairs in that mean
  // "Board fit": m², mean square distance of the triangulated points from the board's after the
  // best rigid fit.
  double squared_board = NAN;
};

struct HoldOut {
  int folds = 0;                   // 0: not run
  std::vector<HoldOutView> views;  // those that could be held out
  double rms_px = NAN;             // over all points of all views held out
  double square_rms = NAN;         // m, over all pairs of neighbours
  double board_rms = NAN;          // m, over all triangulated points
};

// What a rig makes of one view of a board (points by id, m), `seen` by each camera. The board's
// pose is looked for from `start`, if it is known about where the board stands.
HoldOutView MeasureBoard(const camera::Rig& rig, const std::vector<Eigen::Vector3d>& board,
                         const std::vector<vision::BoardView>& seen,
                         const std::optional<Eigen::Isometry3d>& start = std::nullopt);

}  // namespace softforce::calibration
