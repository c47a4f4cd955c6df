#include "calibration/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/stages.h"
#include "calibration/start.h"

namespace softforce::calibration {
namespace {

using Status = Calibration::Status;

constexpr int kMostIterations = 200;
constexpr double kLittleTilt = 15 * M_PI / 180;  // rad

const char* const kTiltTheBoard =
    "Take views with the board tilted by 30 to 45 degrees, to the left, to the right, up and down, "
    "near and far, and in all parts of the picture.";

void Fail(Status status, const std::string& reason, const std::string& what_to_do,
          Calibration* calibration) {
  calibration->status = status;
  calibration->reason = reason;
  calibration->what_to_do = what_to_do;
}

// Whether the views suffice in number and link the cameras.
bool ViewsSuffice(const CalibrationInput& input, const CalibrationOptions& options,
                  const std::vector<std::vector<int>>& shared_views, const std::string& when,
                  Calibration* calibration) {
  std::string lacking;
  for (size_t c = 0; c < input.cameras.size(); ++c) {
    if (shared_views[c][c] >= options.min_views) continue;
    lacking +=
        fmt::format("{}camera \"{}\" has {} usable pictures of the board{}",
                    lacking.empty() ? "" : "; ", input.cameras[c].name, shared_views[c][c], when);
  }
  if (!lacking.empty()) {
    Fail(Status::kTooFewViews, fmt::format("{}, expected at least {}", lacking, options.min_views),
         fmt::format("Take more pictures; 15 to 30 give a good calibration. A picture counts if at "
                     "least {} points of the board are found in it.",
                     options.min_points),
         calibration);
    return false;
  }
  calibration->groups = ConnectedCameras(shared_views);
  if (calibration->groups.size() == 1) return true;
  std::string groups;
  for (const std::vector<int>& group : calibration->groups) {
    std::string names;
    for (int c : group) names += (names.empty() ? "" : ", ") + input.cameras[c].name;
    groups += (groups.empty() ? "{" : " and {") + names + "}";
  }
  Fail(Status::kNotConnected,
       "no view shows the board to cameras of different groups" + when + ": " + groups,
       "Hold the board where cameras of two groups see it at the same time, or calibrate the "
       "groups apart. Pictures of one moment must be paired as one view.",
       calibration);
  return false;
}

// From nothing to an estimate near the answer.
bool Start(const CalibrationInput& input, const BoardShape& board,
           const CalibrationOptions& options, const std::vector<Sighting>& sightings,
           const std::vector<std::vector<int>>& shared_views, Estimate* estimate,
           Calibration* calibration) {
  const int num_views = static_cast<int>(input.views.size());
  std::vector<CameraStart> starts;
  for (int c = 0; c < static_cast<int>(input.cameras.size()); ++c) {
    if (Stopped(options, calibration)) return false;
    Tell(options, "camera " + input.cameras[c].name);
    starts.push_back(
        StartCamera(board, sightings, input.cameras[c], *input.cameras[c].lens, c, num_views));
    if (starts.back().ok) continue;
    Fail(Status::kNoStart,
         fmt::format("camera \"{}\": no place of the board explains its pictures",
                     input.cameras[c].name),
         "Check that the board given is the one in the pictures, and that it is not mirrored.",
         calibration);
    return false;
  }
  PlaceCameras(board, sightings, starts, shared_views, estimate);
  return true;
}

// Beyond this the picture cannot be of this board through such a lens, px per axis.
double MaxNoise(const CalibrationInput& input) {
  int widest = 0;
  for (const CameraToCalibrate& camera : input.cameras) widest = std::max(widest, camera.width);
  return std::max(2.0, 2e-3 * widest);
}

// Median error of all points over what a median of noise of 1 px is.
double RobustNoisePx(const BoardShape& board, const Estimate& estimate,
                     std::vector<Sighting> sightings) {
  for (Sighting& sighting : sightings) sighting.whitening.setIdentity();
  return RobustNoise(board, estimate, sightings);
}

// What cannot be told from the views, for a person; empty if all can.
std::string WhatIsOpen(const CalibrationInput& input, const CalibrationOptions& options,
                       const Estimate& estimate, const NormalEquations& equations,
                       double noise_factor) {
  if (!equations.determined() || !std::isfinite(noise_factor)) {
    return "the views do not determine the cameras";
  }
  std::string text;
  for (int c = 0; c < static_cast<int>(input.cameras.size()); ++c) {
    const Eigen::VectorXd lens = LensVector(estimate.lenses[c], estimate.fits[c]);
    const std::vector<std::string> names = ParameterNames(estimate.fits[c]);
    for (int i = 0; i < 4; ++i) {
      const int at = equations.lens_start(c) + i;
      const double sd = noise_factor * std::sqrt(equations.SharedCovariance()(at, at));
      if (sd <= options.max_relative_sd * lens(0)) continue;
      text += fmt::format("{}camera \"{}\": {} = {:.0f} px with a standard deviation of {:.0f} px",
                          text.empty() ? "" : "; ", input.cameras[c].name, names[i], lens(i), sd);
    }
  }
  return text;
}

// How straight the board faced all cameras, if that is why; a similar picture in all views leaves
// focal length and distance to trade, whatever they are taken to be.
std::string TiltText(const std::vector<Sighting>& sightings, const Estimate& estimate) {
  double widest = 0;  // rad
  for (const Sighting& sighting : sightings) {
    const Eigen::Isometry3d T_camera_board =
        estimate.T_camera_rig[sighting.camera] * estimate.T_rig_board[sighting.view];
    const double cosine = std::min(1.0, std::abs(T_camera_board.linear()(2, 2)));
    widest = std::max(widest, std::acos(cosine));
  }
  if (widest > kLittleTilt) return "";
  return fmt::format(": the board was never tilted by more than {:.0f} degrees against a picture",
                     widest * 180 / M_PI);
}

// The adjustment of all at once, from the start to where outliers can be told, with the floor of
// the noise set. Whether the board is that in the pictures.
bool AdjustTogether(const CalibrationInput& input, const BoardShape& board,
                    const CalibrationOptions& options, Solved* solved) {
  auto& [calibration, sightings, estimate] = *solved;
  Tell(options, "all cameras together");
  AdjustOptions adjust;
  adjust.stop = options.stop;
  adjust.free_distortion = 2;
  adjust.free_warp = false;
  AdjustRobustly(board, sightings, adjust, &estimate);
  adjust.free_distortion = 8;
  adjust.free_warp = true;
  adjust.max_iterations = kMostIterations;
  AdjustRobustly(board, sightings, adjust, &estimate);
  if (Stopped(options, &calibration)) return false;
  const double noise_px = RobustNoisePx(board, estimate, sightings);
  if (!(noise_px < MaxNoise(input))) {
    Fail(Status::kBoardMismatch,
         fmt::format("half of the points are more than {:.1f} px from where the board has them",
                     1.18 * noise_px),
         "Check that the board given is the one in the pictures (kind, counts, proportions), that "
         "the pictures of a view belong to one moment, and that the lens model suits the lens.",
         &calibration);
    return false;
  }
  calibration.floor_px = RobustFloor(board, estimate, sightings);
  SetFloor(calibration.floor_px, &sightings);
  AdjustRobustly(board, sightings, adjust, &estimate);
  return true;
}

}  // namespace

bool Stopped(const CalibrationOptions& options, Calibration* calibration) {
  if (options.stop == nullptr || !*options.stop) return false;
  Fail(Status::kStopped, "stopped from outside", "", calibration);
  return true;
}

void Tell(const CalibrationOptions& options, const std::string& what) {
  if (options.on_progress) options.on_progress(what);
}

std::vector<Sighting> MakeSightings(const CalibrationInput& input, int min_points) {
  std::vector<Sighting> sightings;
  for (int v = 0; v < static_cast<int>(input.views.size()); ++v) {
    for (int c = 0; c < static_cast<int>(input.cameras.size()); ++c) {
      const vision::BoardView& seen = input.views[v].seen[c];
      if (seen.size() < min_points) continue;
      for (int i = 0; i < seen.size(); ++i) {
        sightings.push_back({v, c, seen.ids[i], seen.pixels[i], seen.covariances[i], {}});
      }
    }
  }
  SetFloor(0, &sightings);
  return sightings;
}

Solved Solve(const CalibrationInput& input, const BoardShape& board,
             const CalibrationOptions& options) {
  Solved solved;
  auto& [calibration, sightings, estimate] = solved;
  sightings = MakeSightings(input, options.min_points);
  const int num_cameras = static_cast<int>(input.cameras.size());
  const int num_views = static_cast<int>(input.views.size());
  auto shared_views = SharedViews(sightings, num_cameras, num_views);
  if (!ViewsSuffice(input, options, shared_views, "", &calibration)) return solved;

  for (const CameraToCalibrate& camera : input.cameras) estimate.fits.push_back(*camera.lens);
  estimate.lenses.resize(num_cameras);
  estimate.T_camera_rig.assign(num_cameras, Eigen::Isometry3d::Identity());
  estimate.T_rig_board.assign(num_views, Eigen::Isometry3d::Identity());
  estimate.fit_warp = options.fit_warp && board.can_bend;
  if (!Start(input, board, options, sightings, shared_views, &estimate, &calibration)) {
    return solved;
  }

  if (!AdjustTogether(input, board, options, &solved)) return solved;

  AdjustOptions adjust;
  adjust.stop = options.stop;
  adjust.max_iterations = kMostIterations;
  const Fit fit =
      FitWithoutOutliers(board, options.outlier_probability, adjust, &sightings, &estimate);
  if (Stopped(options, &calibration)) return solved;
  shared_views = SharedViews(sightings, num_cameras, num_views);
  if (!ViewsSuffice(input, options, shared_views, " without outliers", &calibration)) {
    return solved;
  }
  const NormalEquations equations(board, sightings, estimate);
  const std::string open = WhatIsOpen(input, options, estimate, equations, fit.noise_factor);
  if (!open.empty()) {
    Fail(Status::kUndetermined, open + TiltText(sightings, estimate), kTiltTheBoard, &calibration);
  } else if (!fit.adjustment.usable || !fit.adjustment.converged) {
    Fail(Status::kNotConverged, "the bundle adjustment did not come to an end", kTiltTheBoard,
         &calibration);
  } else {
    calibration.status = Status::kOk;
    Conclude(input, board, options, sightings, fit, equations, estimate, &calibration);
  }
  return solved;
}

}  // namespace softforce::calibration
