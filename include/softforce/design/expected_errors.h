#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/design/influence.h"
#include "softforce/geometry/rigid.h"

namespace softforce::design {

// A place of a marker: where it is, and how well it is measured there.
struct MarkerSight {
  Eigen::Vector3d position = Eigen::Vector3d::Constant(NAN);  // m, robot frame
  // 1/m²: the inverse of its measurement's covariance. Singular where one camera alone sees it,
  // zero where none does.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

// What is known before anything is measured, and what the model gets wrong.
struct ErrorModel {
  double force_sd = 0.4;     // N, of each component: a load may be so large
  double location_sd = NAN;  // m, along each tangent: a load may act so far from anywhere
  // As of estimation::EstimatorOptions: shares of the largest displacement, that moves all markers
  // together and that of each by itself.
  double common_model_error = 0.005;
  double local_model_error = 0.002;
  // Of the rig's place: of a twist at the robot's origin, robot frame.
  geometry::Matrix6d registration = geometry::Matrix6d::Zero();

  void Check() const;  // throws InputError naming the option
};

// What is expected of the estimate of a load that acts alone.
struct ExpectedError {
  double location = NAN;        // m, root mean square distance from its place
  double location_major = NAN;  // m, standard deviation along the direction that is known least
  double force = NAN;           // N, root mean square of the error of its intensity
};

enum class Criterion {
  kLocation,  // mean over the loads of log(expected location error)
  kDOptimal   // mean of half the log det of the covariance of force (N) and place (m) together
};

// The expected errors of loads for any choice among given marker places (Cramér–Rao with a prior):
//
//   M_j = diag(I, P⁻¹) + Σ_i R_ijᵀ R_ij,
//
// R_ij being the whitened rows of marker i by the shared rigid offset (scaled to unit covariance),
// the intensities and the place of load j. With the offset in front, the end of the Cholesky factor
// of M_j is that of the information about force and place, the offset being unknown.
class ExpectedErrors {
 public:
  static constexpr int kUnknowns = 11;  // 6 of the offset, 3 of the force, 2 of the place
  using Rows = Eigen::Matrix<double, 3, kUnknowns>;
  using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  // One place per point of the influence. The model's errors go by the largest displacement among
  // the places that are seen. Throws InputError for a model out of range.
  ExpectedErrors(const Influence& influence, const std::vector<PlacedLoad>& loads,
                 const std::vector<MarkerSight>& places, const ErrorModel& model);

  int num_places() const { return num_places_; }
  int num_loads() const { return num_loads_; }

  // Per load: what the prior says, and what the markers at these places add to it.
  std::vector<Information> Start() const;
  void Add(int place, std::vector<Information>* sums) const;
  std::vector<Information> Of(const std::vector<int>& places) const;

  std::vector<ExpectedError> Expect(const std::vector<int>& places) const;

  // The criterion, less is better; with a marker at `added` on top unless that is negative.
  double Value(Criterion criterion, const std::vector<Information>& sums, int added = -1) const;

 private:
  const Rows& RowsOf(int place, int load) const { return rows_[place * num_loads_ + load]; }

  int num_places_, num_loads_;
  ErrorModel model_;
  std::vector<int> num_directions_;  // of each load
  std::vector<Rows, Eigen::aligned_allocator<Rows>> rows_;
};

// The middle one of the location errors, m.
double MedianLocation(const std::vector<ExpectedError>& errors);

}  // namespace softforce::design
