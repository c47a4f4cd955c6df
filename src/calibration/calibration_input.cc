#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "softforce/base/input_error.h"
#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {
namespace {

using base::InputError;

void CheckPicture(const std::string& where, const CameraToCalibrate& camera,
                  const vision::BoardView& seen, size_t num_points) {
  if (seen.pixels.size() != seen.ids.size() || seen.covariances.size() != seen.ids.size()) {
    throw InputError(where,
                     fmt::format("got {} ids, {} pixels and {} covariances, expected as many "
                                 "of each",
                                 seen.ids.size(), seen.pixels.size(), seen.covariances.size()));
  }
  std::set<int> met;
  for (int i = 0; i < seen.size(); ++i) {
    const int id = seen.ids[i];
    if (id < 0 || id >= static_cast<int>(num_points)) {
      throw InputError(
          where, fmt::format("got a point with id {}, but the board has {} points", id, num_points),
          "Give the board that is in the pictures.");
    }
    if (!met.insert(id).second) {
      throw InputError(where, fmt::format("got point {} twice, expected once", id));
    }
    const Eigen::Vector2d& p = seen.pixels[i];
    const bool inside = p.x() >= -0.5 && p.y() >= -0.5 && p.x() <= camera.width - 0.5 &&
                        p.y() <= camera.height - 0.5;
    if (!inside) {
      throw InputError(
          where,
          fmt::format("got a point at ({:.1f}, {:.1f}) px, which is outside of {} x {} px", p.x(),
                      p.y(), camera.width, camera.height),
          "All pictures of a camera must have its resolution: calibrate each resolution apart.");
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spectrum(seen.covariances[i]);
    if (!seen.covariances[i].allFinite() || !(spectrum.eigenvalues()(0) > 0)) {
      throw InputError(where, fmt::format("point {}: its covariance is not positive definite", id));
    }
  }
}

}  // namespace

void CalibrationInput::Check() const {
  if (cameras.empty()) throw InputError("calibration", "got no cameras, expected at least one");
  for (const CameraToCalibrate& camera : cameras) {
    if (camera.width < 2 || camera.height < 2) {
      throw InputError("calibration: camera \"" + camera.name + "\"",
                       fmt::format("got a picture of {} x {} px, expected at least 2 x 2",
                                   camera.width, camera.height));
    }
  }
  if (board.size() < 4) {
    throw InputError("calibration: board",
                     fmt::format("got {} points, expected at least 4", board.size()));
  }
  for (const Eigen::Vector3d& p : board) {
    if (!p.allFinite() || p.z() != 0) {
      throw InputError("calibration: board",
                       fmt::format("got a point at ({}, {}, {}) m, expected all in the plane z = 0",
                                   p.x(), p.y(), p.z()));
    }
  }
  for (const CalibrationView& view : views) {
    if (view.seen.size() != cameras.size()) {
      throw InputError(
          "calibration: view \"" + view.name + "\"",
          fmt::format("got what {} cameras saw, expected {}", view.seen.size(), cameras.size()));
    }
    for (size_t c = 0; c < cameras.size(); ++c) {
      CheckPicture("calibration: view \"" + view.name + "\", camera \"" + cameras[c].name + "\"",
                   cameras[c], view.seen[c], board.size());
    }
  }
}

void CalibrationOptions::Check() const {
  const auto fail = [](const std::string& option, const std::string& problem) {
    throw InputError("calibration: " + option, problem);
  };
  if (min_views < 1) fail("min_views", "must be 1 or more");
  if (min_points < 4) fail("min_points", "must be 4 or more");
  if (!(outlier_probability > 0 && outlier_probability < 1)) {
    fail("outlier_probability", "must lie between 0 and 1");
  }
  if (!(working_distance >= 0)) fail("working_distance", "must be 0 m or more");
  if (uncertainty_columns < 2 || uncertainty_rows < 2) {
    fail("uncertainty_columns, uncertainty_rows", "must be 2 or more");
  }
  if (coverage_columns < 1 || coverage_rows < 1) {
    fail("coverage_columns, coverage_rows", "must be 1 or more");
  }
  if (max_folds < 0 || max_folds == 1) fail("max_folds", "must be 0, or 2 or more");
  if (!(max_relative_sd > 0)) fail("max_relative_sd", "must be more than 0");
}

const char* Name(Calibration::Status status) {
  switch (status) {
    case Calibration::Status::kNotRun:
      return "not run";
    case Calibration::Status::kOk:
      return "ok";
    case Calibration::Status::kTooFewViews:
      return "too few views";
    case Calibration::Status::kNotConnected:
      return "cameras not connected";
    case Calibration::Status::kNoStart:
      return "no start";
    case Calibration::Status::kNotConverged:
      return "not converged";
    case Calibration::Status::kUndetermined:
      return "undetermined";
    case Calibration::Status::kBoardMismatch:
      return "board mismatch";
    case Calibration::Status::kStopped:
      return "stopped";
  }
  return "";
}

}  // namespace softforce::calibration
