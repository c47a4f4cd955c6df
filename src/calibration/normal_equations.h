#pragma once

#include "calibration/estimate.h"

namespace softforce::calibration {

// How anything of interest depends on all the parameters: on those that are shared by the views,
// and on the pose of each board.
struct Dependence {
  Eigen::MatrixXd by_shared;              // rows × num_shared
  std::vector<Eigen::MatrixXd> by_board;  // per view, rows × 6; empty: not at all
};

// The normal equations of the least squares at an estimate, in the coordinates of Linearise():
// shared parameters first (of each camera its lens, and its pose but for the first; the warp), the
// boards' poses after, which are eliminated: no two boards are in one equation.
class NormalEquations {
 public:
  NormalEquations(const BoardShape& board, const std::vector<Sighting>& sightings,
                  const Estimate& estimate);

  int num_shared() const { return num_shared_; }
  int num_boards() const;  // that any sighting tells about
  bool has_board(int view) const { return boards_[view].seen; }

  int lens_start(int camera) const { return lens_start_[camera]; }
  int pose_start(int camera) const { return pose_start_[camera]; }  // −1 of the first camera
  int warp_start() const { return warp_start_; }                    // −1 if not fitted

  // False if some change of the parameters changes no sighting.
  bool determined() const { return determined_; }

  // Covariances for sightings whose covariances are right; only if determined().
  const Eigen::MatrixXd& SharedCovariance() const { return shared_covariance_; }
  Eigen::MatrixXd CovarianceOf(const Dependence& dependence) const;
  geometry::Matrix6d BoardCovariance(int view) const;

 private:
  struct Board {
    bool seen = false;
    geometry::Matrix6d information = geometry::Matrix6d::Zero();
    geometry::Matrix6d covariance;  // inverse of the information
    Eigen::MatrixXd with_shared;    // num_shared × 6
  };

  void Lay(const Estimate& estimate);
  void Add(const BoardShape& board, const Estimate& estimate, const Sighting& sighting,
           Eigen::MatrixXd* shared);

  int num_shared_ = 0;
  std::vector<int> lens_start_, pose_start_;
  int warp_start_ = -1;
  std::vector<Board> boards_;
  bool determined_ = true;
  Eigen::MatrixXd shared_covariance_;
};

}  // namespace softforce::calibration
