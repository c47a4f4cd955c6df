#include "softforce/calibration/calibrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "calibration/solve.h"
#include "calibration/stages.h"
#include "softforce/base/input_error.h"

namespace softforce::calibration {
namespace {

using Status = Calibration::Status;

std::vector<char> UsedBy(const Solved& solved) {
  std::vector<char> used;
  for (const Sighting& sighting : solved.sightings) used.push_back(sighting.used ? 1 : 0);
  return used;
}

void HoldOutViews(const CalibrationInput& input, const BoardShape& board,
                  const CalibrationOptions& options, const std::vector<char>& measured,
                  Solved* solved) {
  if (!solved->calibration.ok() || options.max_folds == 0) return;
  Tell(options, "held-out views");
  solved->calibration.hold_out =
      RunHoldOut(input, board, options, solved->sightings, measured, solved->estimate);
  Stopped(options, &solved->calibration);
}

Calibration Advised(const CalibrationInput& input, Calibration calibration) {
  if (calibration.ok()) Advise(input, &calibration);
  return calibration;
}

Calibration CalibrateWithLenses(const CalibrationInput& input, const BoardShape& board,
                                const CalibrationOptions& options) {
  Solved solved = Solve(input, board, options);
  HoldOutViews(input, board, options, UsedBy(solved), &solved);
  return Advised(input, solved.calibration);
}

// Each lens model for the cameras that have none given; of those nearly as good as the best, the
// first, which has the fewest parameters. A model that calls what it cannot follow outliers must
// not gain by that: all are measured by the points that any of them uses.
Calibration CalibrateWithBestLens(const CalibrationInput& input, const BoardShape& board,
                                  const CalibrationOptions& options) {
  constexpr double kNearlyAsGood = 1.01;  // of the held-out error; less is chance
  const std::array<LensFit, 4> lenses = {LensFit::kBrownConrady4, LensFit::kBrownConrady5,
                                         LensFit::kBrownConrady8, LensFit::kKannalaBrandt};
  std::vector<Solved> tried;
  std::vector<char> measured;
  for (LensFit lens : lenses) {
    Tell(options, std::string("lens model ") + Name(lens));
    CalibrationInput with_lens = input;
    for (CameraToCalibrate& camera : with_lens.cameras) camera.lens = camera.lens.value_or(lens);
    tried.push_back(Solve(with_lens, board, options));
    if (tried.back().calibration.status == Status::kStopped) return tried.back().calibration;
    const std::vector<char> used = UsedBy(tried.back());
    measured.resize(used.size(), 0);
    for (size_t i = 0; tried.back().calibration.ok() && i < used.size(); ++i) {
      measured[i] = measured[i] || used[i] ? 1 : 0;
    }
  }
  std::vector<LensTrial> trials;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < lenses.size(); ++i) {
    HoldOutViews(input, board, options, measured, &tried[i]);
    const Calibration& calibration = tried[i].calibration;
    if (calibration.status == Status::kStopped) return calibration;
    trials.push_back(
        {lenses[i], calibration.ok(), calibration.rms_px, calibration.hold_out.rms_px});
    if (trials[i].ok && trials[i].hold_out_px < least) least = trials[i].hold_out_px;
  }
  size_t chosen = 0;  // if all failed, what the simplest says
  for (size_t i = trials.size(); i-- > 0;) {
    // With so few views that none can be held out, the simplest that could be fitted.
    const bool good = trials[i].hold_out_px <= kNearlyAsGood * least || std::isinf(least);
    if (trials[i].ok && good) chosen = i;
  }
  tried[chosen].calibration.trials = trials;
  return Advised(input, tried[chosen].calibration);
}

}  // namespace

Calibration Calibrate(const CalibrationInput& input, const CalibrationOptions& options) {
  input.Check();
  options.Check();
  const bool choose = std::any_of(input.cameras.begin(), input.cameras.end(),
                                  [](const CameraToCalibrate& camera) { return !camera.lens; });
  const BoardShape board = MakeBoardShape(input.board);
  if (!choose) return CalibrateWithLenses(input, board, options);
  if (options.max_folds == 0) {
    throw base::InputError("calibration: max_folds",
                           "got 0, but held-out views must choose the lens model",
                           "Name the lens model, or hold views out.");
  }
  return CalibrateWithBestLens(input, board, options);
}

}  // namespace softforce::calibration
