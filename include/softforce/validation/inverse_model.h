#pragma once

#include <limits>
#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "softforce/validation/model.h"

namespace softforce::validation {

// The scale (m) for plain least squares: so wide that nothing is an outlier and that the
// estimator's offset, whose place is exactly known, takes no part.
inline constexpr double kWideSd = 1e-2;

// Plain least squares on the markers' positions, nothing else unknown (paper eq. 9), for markers of
// kWideSd: converged until no marker would move by more than `tolerance` (m).
estimation::EstimatorOptions LeastSquares(double tolerance);

// Standard deviations that the remedies take for known: of the markers' coordinates, and of the
// place of the frame that they are measured in.
inline constexpr double kMarkerSd = 3e-5;        // m
inline constexpr double kRegistrationSd = 1e-3;  // m
inline constexpr double kOrientationSd = 1e-2;   // rad

// A candidate is given up if its force is below this share of the largest (paper, Remark 5).
inline constexpr double kSelectionThreshold = 0.25;

// How far the forces of a frame are from those applied, I_e in N; NaN if there is no answer.
struct ForceErrors {
  double all = NAN;  // every candidate may carry a force
  // The weakest candidates given up and the rest fitted anew, until none is left below the
  // threshold (the paper's strategy for unknown locations, V). A loaded candidate that was given up
  // counts with the force on it.
  double selected = NAN;
};

geometry::Matrix6d RegistrationCovariance();

// A layout's inverse model: finds the forces on its candidates from where its markers are.
class InverseModel {
 public:
  // `solver` holds the model's body and must outlive this. `sd` (m): of the markers' coordinates.
  InverseModel(const Model& model, fem::StaticSolver* solver, const Layout& layout,
               const estimation::EstimatorOptions& options, double sd);

  // From now on the place of the measuring frame is unknown, but for its prior.
  void FreeRegistration();

  // From now on markers are looked for so far (m) from where the model has them.
  void SetOffsets(const std::vector<Eigen::Vector3d>& offsets);

  // From now on no force component is looked for beyond this (N): an estimate that ends there is no
  // answer.
  void SetLargestForce(double largest);

  // The error with every candidate when the markers are at `seen`; NaN if there is no answer.
  double Error(const std::vector<Eigen::Vector3d>& seen, const fem::Actuation& actuation);

  // The same, and with the candidates that the threshold leaves.
  ForceErrors SelectedError(const std::vector<Eigen::Vector3d>& seen,
                            const fem::Actuation& actuation);

  // W_ef (m/N) of the body as it is.
  Eigen::MatrixXd Compliance() const;

  const std::vector<mesh::NodalWeights>& markers() const { return markers_; }
  estimation::ForceEstimator& estimator() { return estimator_; }

 private:
  std::vector<estimation::Observation> Observe(const std::vector<Eigen::Vector3d>& seen) const;
  double ErrorOf(const estimation::ForceEstimate& estimate) const;

  // Gives up candidates that are weak in the estimate; whether there were any.
  bool GiveUpWeak(const estimation::ForceEstimate& estimate, std::vector<char>* kept);
  void Bound(int site, double largest) { estimator_.SetBounds(site, -largest, largest); }

  std::vector<mesh::NodalWeights> markers_;
  std::vector<Eigen::Vector3d> offsets_;
  double sd_;
  double largest_ = std::numeric_limits<double>::infinity();  // N
  Eigen::VectorXd applied_;                                   // N, per component
  estimation::ForceEstimator estimator_;
};

}  // namespace softforce::validation
