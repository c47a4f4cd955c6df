#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"

namespace softforce::estimation {

enum class ForceDirection {
  kFree,
  kPush,  // along the inward normal, ≥ 0
  kFixed
};

// A place near which a force may act.
struct LocationCandidate {
  std::string name;       // for messages
  mesh::SurfacePoint at;  // of the body at rest
  ForceDirection direction = ForceDirection::kFree;
  Eigen::Vector3d fixed = Eigen::Vector3d::UnitZ();  // unit vector, if kFixed
};

enum class LocationMethod {
  kContinuous,  // forces act anywhere on the faces of the candidates
  kCandidates,  // forces act at some of the candidates: the likeliest ones
  // The paper's strategy (V and Remark 5): all candidates at once, those with forces below a share
  // of the largest are given up, and neighbouring survivors act at their centre.
  kThreshold
};

// The name of a method in options and files: "continuous", "candidates", "threshold".
const char* Name(LocationMethod method);

struct LocationOptions {
  LocationMethod method = LocationMethod::kContinuous;
  // Model's errors, rejection and tolerance. Its method, loss and prior play no part.
  EstimatorOptions estimator;
  double patch = 0;  // m, diameter over which each force is spread
  int max_forces = 4;
  // A frame reports a force that is not there this often: by it a force is accepted if χ² falls by
  // more than the quantile of its unknowns, over all candidates.
  double false_alarm = 1e-3;
  double threshold = 0.25;  // of the largest force, by kThreshold
  double crease = 0.8;      // rad: forces do not move across an edge of the body sharper than this

  void Check() const;  // throws InputError naming the option
};

// A force, and where it was found.
struct LocatedForce {
  int identity = -1;   // kept from frame to frame
  int candidate = -1;  // the nearest one
  mesh::SurfacePoint at;
  Eigen::Vector3d rest = Eigen::Vector3d::Constant(NAN);  // m, of the body at rest
  Eigen::Vector3d force = Eigen::Vector3d::Zero();        // N
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();   // N²
  // Of the place over the surface of the body at rest: along the columns of `tangents`, m².
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d location_covariance = Eigen::Matrix2d::Zero();
  // Candidates that it may act at instead: those within its 95 % region or on another face, or by
  // kCandidates those in likely other sets.
  std::vector<int> alternatives;

  double location_sd() const;  // m, along the direction that is known least
};

struct LocationEstimate {
  ForceEstimate::Status status = ForceEstimate::Status::kNotRun;
  std::string reason;  // for a person; empty if ok
  std::vector<LocatedForce> forces;
  // That the forces are as many as found, and on these faces; by kCandidates, of the candidate of
  // which it is least certain that it is rightly held to be loaded or not. The model's errors are
  // part of what is weighed, as the observations' noise is. NaN by kThreshold.
  double probability = NAN;
  double chi2 = NAN;  // of the observations used
  int degrees_of_freedom = 0;
  std::vector<char> rejected;  // per observation
  int rounds = 0;              // equilibria of the body

  bool ok() const { return status == ForceEstimate::Status::kOk; }
};

// Finds forces whose places are not known (paper V): how many, where and how strong. The influence
// of a force anywhere on the surface upon the observed points is computed from their side, one
// solution per coordinate. With it the number of forces is the one at which another would lower χ²
// by no more than chance does, the places move over the surface together with the intensities
// (Gauss–Newton by Ceres), and the body follows until nothing moves. Model error and the place of
// the rig are part of the observations' covariance. Warm-started: a force that slides stays the
// same one.
class LocationEstimator {
 public:
  // `solver` must outlive the estimator; `surface` is that of its mesh.
  LocationEstimator(fem::StaticSolver* solver, const mesh::Surface& surface,
                    std::vector<LocationCandidate> candidates, const LocationOptions& options = {});
  ~LocationEstimator();
  LocationEstimator(LocationEstimator&&) noexcept;

  // Covariance of a twist, see ForceEstimator.
  void SetRegistrationCovariance(const geometry::Matrix6d& covariance);

  // Moves the body to a new actuation under the last forces.
  fem::SolveSummary Advance(const fem::Actuation& actuation);

  // Estimates under the given actuation. If the status is not kOk the state stays as it was.
  // `shape`: an equilibrium under that actuation and other forces, about where the points were
  // seen, if one is known: after a jump the search begins there instead of at the last shape.
  LocationEstimate Estimate(const std::vector<Observation>& observations,
                            const fem::Actuation& actuation,
                            const fem::Equilibrium* shape = nullptr);

  const fem::Equilibrium& state() const;
  const std::vector<LocationCandidate>& candidates() const;

  // The standard deviations that any unbiased estimate of given forces must have (Cramér–Rao) by
  // the noise and the place of the rig, were the model exact: the same forces with covariances
  // set, at the present state. Empty if they cannot be told.
  std::vector<LocatedForce> Floor(const std::vector<Observation>& observations,
                                  const std::vector<LocatedForce>& forces) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::estimation
