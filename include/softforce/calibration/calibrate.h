#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "softforce/calibration/hold_out.h"
#include "softforce/calibration/lens_fit.h"
#include "softforce/camera/rig.h"
#include "softforce/geometry/rigid.h"
#include "softforce/vision/board_detector.h"

namespace softforce::calibration {

struct CameraToCalibrate {
  std::string name;
  int width = 0, height = 0;    // px
  std::optional<LensFit> lens;  // nothing: the one that predicts held-out views best
};

// The board at one moment.
struct CalibrationView {
  std::string name;                     // for people: the picture's file, or its time
  std::vector<vision::BoardView> seen;  // one per camera; empty where it was not found
};

struct CalibrationInput {
  std::vector<CameraToCalibrate> cameras;
  std::vector<Eigen::Vector3d> board;  // m, by id; z = 0, as if the board were flat
  std::vector<CalibrationView> views;

  // Throws InputError, naming the camera or view: ids that the board has not, pixels outside the
  // picture (another resolution), covariances that are none, a board that is not flat.
  void Check() const;
};

struct CalibrationOptions {
  bool fit_warp = true;               // the board's bend; needs points away from its border
  int min_views = 3;                  // pictures with the board, of each camera
  int min_points = 6;                 // in a picture that is used
  double outlier_probability = 1e-5;  // that a right point is called an outlier
  double working_distance = 0;  // m, along the ray, for the uncertainty; 0: median of the board's
  int uncertainty_columns = 25, uncertainty_rows = 19;  // where over the picture it is evaluated
  int coverage_columns = 8, coverage_rows = 6;          // cells in which points are counted
  // The views are held out in so many groups in turn; if there are not more views, each on its own.
  // 0: not at all.
  int max_folds = 25;
  // A focal length or principal point is called undetermined if its standard deviation is more than
  // this, as a share of the focal length.
  double max_relative_sd = 0.05;
  const std::atomic<bool>* stop = nullptr;              // set from outside: end with kStopped
  std::function<void(const std::string&)> on_progress;  // is told what begins; may be empty

  void Check() const;  // throws InputError naming the option
};

// A number of the result with its standard deviation.
struct CalibratedValue {
  enum class Kind { kIntrinsics, kDistortion, kRotation, kTranslation, kWarp };

  Kind kind = Kind::kIntrinsics;
  int camera = -1;     // −1: of the board
  std::string name;    // "fx", "k1", "rotation x", "translation x", "warp x"
  std::string unit;    // "px", "", "rad", "m"
  double value = NAN;  // of rotations: the rotation vector of T_camera_rig
  // Of rotations: of a small turn about the camera's axes, after that of T_camera_rig.
  double sd = NAN;
};

// What is left at one point of the board in one picture.
struct PointResidual {
  int view = -1, camera = -1, id = -1;
  Eigen::Vector2d pixel;  // px, detected
  Eigen::Vector2d error;  // px, detected − projected; NaN if it projects nowhere
  double sigmas = NAN;    // length of the whitened error, in units of the estimated noise
  bool outlier = false;   // left out of the fit
};

// All RMS values of reprojection errors are the root of the mean square LENGTH of the error
// vectors, as OpenCV's (per axis: divided by √2), of the points that were not left out.
struct PictureFit {
  int camera = -1;
  int points = 0, outliers = 0;
  bool left_out = false;  // the whole picture: most of its points were outliers
  double rms_px = NAN;
  double distance = NAN;  // m, from the camera to the middle of the points seen
  double tilt = NAN;      // rad, between the board's normal and the ray to that middle
};

struct ViewFit {
  std::string name;
  bool used = false;  // false: no picture of it was good enough
  Eigen::Isometry3d T_rig_board = Eigen::Isometry3d::Identity();
  // Of (turn about the rig's axes, rad; translation, m), as for the rig's cameras.
  geometry::Matrix6d covariance = geometry::Matrix6d::Constant(NAN);
  std::vector<PictureFit> pictures;  // of the cameras that saw the board
};

struct CameraFit {
  int pictures = 0, points = 0, outliers = 0;
  double rms_px = NAN;
  Eigen::MatrixXi coverage;  // points not left out, by rows and columns of cells of the picture
};

// How far the projection of a fixed point may be off due to the calibration, over the picture.
// Of a point at `distance` from the camera, mrcal's definition (2.2, "mean-pcam"): the point is
// taken to rest in each board's frame in turn, the places where the boards put it are averaged, and
// projected; so extrinsics and lens may trade errors as long as no picture notices.
struct ProjectionUncertainty {
  double distance = NAN;     // m, along the ray
  std::vector<double> x, y;  // px; columns and rows of the grid, from corner to corner
  Eigen::MatrixXd sd_px;     // rows × columns, in the worst direction; NaN where nothing is seen
  std::vector<Eigen::Matrix2d> covariances;  // px², row by row
};

// Something about the input or the result that a person should know.
struct Advice {
  enum class Kind {
    kFewViews,        // fewer than give a good calibration
    kEdgeNotCovered,  // no points near an edge of the picture
    kLittleTilt,      // the board was always nearly square to the camera
    kOneDistance,     // and always as far away
    kUncertainFocal,  // focal length or principal point weakly determined
    kFewSharedViews,  // two cameras hardly see the board together
    kManyOutliers,
    kLargeError,  // points do not fit the board: wrong size or kind of board, or wrong lens model
    kLargeWarp,   // the board is bent
    kPictureLeftOut,
    kHoldOut,              // held-out views are predicted much worse than those used
    kEndedEarly,           // live: before all was seen that is wanted
    kUncertainProjection,  // live: more than wanted, at the working distance
  };

  Kind kind = Kind::kFewViews;
  int camera = -1;      // −1: of no camera in particular
  std::string finding;  // "left: no board within 160 px of the left edge"
  std::string what_to_do;
};

// One lens model that was tried.
struct LensTrial {
  LensFit lens = LensFit::kBrownConrady5;
  bool ok = false;
  double rms_px = NAN, hold_out_px = NAN;
};

struct Calibration {
  enum class Status {
    kNotRun,
    kOk,
    kTooFewViews,   // of at least one camera
    kNotConnected,  // cameras that never see the board together
    kNoStart,       // no pose of the board explains what a camera saw
    kNotConverged,
    kUndetermined,   // the views do not determine the lens, as when the board never tilts
    kBoardMismatch,  // most of what was seen does not fit the board
    kStopped,        // from outside
  };

  Status status = Status::kNotRun;
  std::string reason;      // for a person; empty if ok
  std::string what_to_do;  // empty if ok
  // The groups of cameras that are connected by shared views; more than one if kNotConnected.
  std::vector<std::vector<int>> groups;

  camera::Rig rig;              // the first camera is the rig's frame
  std::vector<LensFit> lenses;  // per camera
  // How far the board's middle bends along z (m, board frame): warp.x() · 4 s (1 − s) with s from 0
  // to 1 along x from its first to its last point, and so for y.
  Eigen::Vector2d warp = Eigen::Vector2d::Zero();
  bool warp_fitted = false;

  // All parameters but the boards' poses: intrinsics and distortion of each camera, rotation and
  // translation of each but the first, warp. `covariance` is joint, in the order of `values`.
  std::vector<CalibratedValue> values;
  Eigen::MatrixXd covariance;

  std::vector<CameraFit> cameras;
  std::vector<ViewFit> views;
  std::vector<PointResidual> residuals;
  double rms_px = NAN;
  // px per axis: added to the given covariances of all points, so that the median point misses the
  // board by as much as they say. What a detector knows of its noise leaves out compression, print
  // and the lens between the model's terms. 0 if the covariances are large enough.
  double floor_px = NAN;
  // Noise of the points in units of those covariances, estimated from what the fit leaves. All
  // standard deviations are scaled by it.
  double noise_factor = NAN;
  double noise_px = NAN;  // per axis, of the points not left out
  int points = 0, outliers = 0;

  std::vector<ProjectionUncertainty> uncertainty;  // per camera
  HoldOut hold_out;
  std::vector<LensTrial> trials;  // if a lens model had to be chosen
  std::vector<Advice> advice;

  bool ok() const { return status == Status::kOk; }
};

const char* Name(Calibration::Status status);

// Calibrates 1 … N cameras that stand fixed to each other from views of a flat board: the maximum-
// likelihood lenses, places of the cameras and of the boards, and the bend of the board,
//
//   min Σ ρ(|R^(-1/2) (detected − project(lens_c, T_camera_rig · T_rig_board · (p + bend(p))))|²)
//
// by bundle adjustment (Ceres). It starts from each camera on its own, and from a spanning tree
// over cameras that see the board together; finds outliers with a robust loss; and ends with plain
// least squares on the rest, whose normal equations give the covariances.
//
// Bad input throws InputError; views that do not determine the cameras are an answer: read
// `status`.
Calibration Calibrate(const CalibrationInput& input, const CalibrationOptions& options = {});

}  // namespace softforce::calibration
