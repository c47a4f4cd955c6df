#include "softforce/calibration/hold_out.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/stages.h"
#include "calibration/start.h"

namespace softforce::calibration {
namespace {

// Views with sightings that are used, dealt out to folds in turn.
std::vector<std::vector<int>> Folds(const std::vector<Sighting>& sightings, int max_folds) {
  std::set<int> views;
  for (const Sighting& sighting : sightings) {
    if (sighting.used) views.insert(sighting.view);
  }
  const int count = std::min(max_folds, static_cast<int>(views.size()));
  std::vector<std::vector<int>> folds(count);
  int next = 0;
  for (int view : views) folds[next++ % count].push_back(view);
  return folds;
}

// Whether a camera's lens and place can still be found without the held-out views.
bool EnoughLeft(const std::vector<Sighting>& kept, const CalibrationOptions& options,
                int num_cameras, int num_views) {
  const auto shared = SharedViews(kept, num_cameras, num_views);
  for (int c = 0; c < num_cameras; ++c) {
    if (shared[c][c] < options.min_views) return false;
  }
  return ConnectedCameras(shared).size() == 1;
}

std::vector<vision::BoardView> Measured(const CalibrationInput& input,
                                        const std::vector<Sighting>& sightings,
                                        const std::vector<char>& measured, int view) {
  std::vector<vision::BoardView> good(input.cameras.size());
  for (size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& sighting = sightings[i];
    if (sighting.view != view || !measured[i]) continue;
    vision::BoardView& seen = good[sighting.camera];
    seen.ids.push_back(sighting.id);
    seen.pixels.push_back(sighting.pixel);
    // The floor included, so that cameras are weighed as in the fit.
    seen.covariances.push_back((sighting.whitening.transpose() * sighting.whitening).inverse());
  }
  return good;
}

void Summarise(HoldOut* hold_out) {
  double px = 0, square = 0, board = 0;
  int points = 0, neighbours = 0, triangulated = 0;
  for (const HoldOutView& view : hold_out->views) {
    px += view.points * view.squared_px;
    points += view.points;
    if (view.neighbours > 0) {
      square += view.neighbours * view.squared_square;
      neighbours += view.neighbours;
    }
    if (std::isfinite(view.squared_board)) {
      board += view.triangulated * view.squared_board;
      triangulated += view.triangulated;
    }
  }
  if (points > 0) hold_out->rms_px = std::sqrt(px / points);
  if (neighbours > 0) hold_out->square_rms = std::sqrt(square / neighbours);
  if (triangulated > 0) hold_out->board_rms = std::sqrt(board / triangulated);
}

}  // namespace

HoldOut RunHoldOut(const CalibrationInput& input, const BoardShape& board,
                   const CalibrationOptions& options, const std::vector<Sighting>& sightings,
                   const std::vector<char>& measured, const Estimate& estimate) {
  HoldOut hold_out;
  for (const std::vector<int>& fold : Folds(sightings, options.max_folds)) {
    const std::set<int> held(fold.begin(), fold.end());
    std::vector<Sighting> kept;
    for (const Sighting& sighting : sightings) {
      if (sighting.used && held.count(sighting.view) == 0) kept.push_back(sighting);
    }
    if (!EnoughLeft(kept, options, static_cast<int>(input.cameras.size()),
                    static_cast<int>(input.views.size()))) {
      continue;
    }
    Estimate without = estimate;
    AdjustOptions adjust;
    adjust.stop = options.stop;
    adjust.tolerance = 1e-9;  // far below what the views left out change
    if (!Adjust(board, kept, adjust, &without).usable) continue;
    std::vector<Eigen::Vector3d> bent;
    for (size_t id = 0; id < board.points.size(); ++id) {
      bent.push_back(board.Bent(static_cast<int>(id), without.warp));
    }
    ++hold_out.folds;
    for (int view : fold) {
      hold_out.views.push_back(MeasureBoard(RigOf(input, without), bent,
                                            Measured(input, sightings, measured, view),
                                            estimate.T_rig_board[view]));
      hold_out.views.back().view = view;
    }
  }
  std::sort(hold_out.views.begin(), hold_out.views.end(),
            [](const HoldOutView& a, const HoldOutView& b) { return a.view < b.view; });
  Summarise(&hold_out);
  return hold_out;
}

}  // namespace softforce::calibration
