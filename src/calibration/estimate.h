#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "softforce/calibration/calibrate.h"

namespace softforce::calibration {

// The board's bend: point `id` lies at `points[id]` + (0, 0, basis[id] · warp).
struct BoardShape {
  std::vector<Eigen::Vector3d> points;  // m, flat
  std::vector<Eigen::Vector2d> basis;   // 4 s (1 − s) along x and y
  bool can_bend = false;                // else no point tells of the bend

  Eigen::Vector3d Bent(int id, const Eigen::Vector2d& warp) const {
    return points[id] + Eigen::Vector3d(0, 0, basis[id].dot(warp));
  }
};

BoardShape MakeBoardShape(const std::vector<Eigen::Vector3d>& points);

// One point of the board in one picture.
struct Sighting {
  int view = -1, camera = -1, id = -1;
  Eigen::Vector2d pixel;       // px
  Eigen::Matrix2d covariance;  // px², as detected
  Eigen::Matrix2d whitening;   // W with WᵀW = (covariance + floor² I)⁻¹, 1/px
  bool used = true;
};

// What a detector says of a point's noise leaves out what the fit cannot follow either: the print,
// compression, the lens between the model's terms. It adds a floor (px, per axis) to the noise.
void SetFloor(double floor_px, std::vector<Sighting>* sightings);

// Everything that is estimated.
struct Estimate {
  std::vector<LensFit> fits;                    // per camera
  std::vector<camera::Lens> lenses;             // per camera
  std::vector<Eigen::Isometry3d> T_camera_rig;  // per camera; the first is the identity
  std::vector<Eigen::Isometry3d> T_rig_board;   // per view
  Eigen::Vector2d warp = Eigen::Vector2d::Zero();
  bool fit_warp = false;

  int num_lens(int camera) const { return 4 + NumDistortion(fits[camera]); }
};

// Lens parameters in the order of camera::ProjectionByLens.
Eigen::VectorXd LensVector(const camera::Lens& lens, LensFit fit);
camera::Lens LensFrom(const double* parameters, LensFit fit);

// A weak prior on a lens parameter: mean 0 and this standard deviation; infinite: none. In the
// model of 8 parameters the numerator and the denominator can cancel, so that no pictures, however
// good, determine both; real lenses have values of a few units at most.
double PriorSd(LensFit fit, int parameter);

// Where a sighting should be, and how that depends on everything. Poses are changed by a small turn
// about the target frame's axes and a shift: R ← exp(turn) R, t ← t + shift.
struct Linearised {
  bool visible = false;
  Eigen::Vector2d pixel;                  // px, projected
  camera::LensJacobian by_lens;           // the first 4 + NumDistortion columns count
  Eigen::Matrix<double, 2, 6> by_camera;  // of T_camera_rig
  Eigen::Matrix<double, 2, 6> by_board;   // of T_rig_board
  Eigen::Matrix2d by_warp;
};
Linearised Linearise(const camera::Lens& lens, const Eigen::Isometry3d& T_camera_rig,
                     const Eigen::Isometry3d& T_rig_board, const Eigen::Vector3d& p_board,
                     const Eigen::Vector2d& bend_basis);

// A pose after a change in those coordinates.
Eigen::Isometry3d Moved(const Eigen::Isometry3d& T, const geometry::Vector6d& change);

// The whitened error of a sighting, whose squared length is χ² of two degrees of freedom; infinite
// if the point is not visible.
double WhitenedError(const BoardShape& board, const Estimate& estimate, const Sighting& sighting);

// The standard deviation of the noise in units of what the covariances say, from the median of all
// sightings: half of them may be anything.
double RobustNoise(const BoardShape& board, const Estimate& estimate,
                   const std::vector<Sighting>& sightings);

// The floor with which the robust noise becomes what the covariances say; 0 if it is no more
// already.
double RobustFloor(const BoardShape& board, const Estimate& estimate,
                   std::vector<Sighting> sightings);

}  // namespace softforce::calibration
