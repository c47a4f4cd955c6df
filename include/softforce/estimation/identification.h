#pragma once

#include <Eigen/Core>
#include <atomic>
#include <limits>
#include <string>
#include <vector>

#include "softforce/estimation/force_estimator.h"

namespace softforce::estimation {

// A state of the body in which all that acts on it is known, and where points of it were seen then.
struct KnownState {
  std::string name;          // for messages: "frames 20 to 29"
  Eigen::Matrix3Xd forces;   // 3×N, N; dead loads on the nodes
  fem::Actuation actuation;  // as told; the offsets of the cables come on top
  std::vector<Observation> observations;
  // Per observation: which point of the body it is of. The states of a group share what the model
  // gets wrong there. Empty: every observation has its own error.
  std::vector<int> points;
  // States on the way of one load, such as the frames of a ramp. The model's error grows on that
  // way: two states share what it was at the smaller displacement. Ten frames of one shape say no
  // more about it than one.
  int group = 0;
};

// A number of the body that is not known.
struct Unknown {
  enum class Kind {
    kYoungsModulus,  // one factor on Young's modulus of all the regions
    kPoissonsRatio,  // one amount added to Poisson's ratio of all the regions
    kCableOffset     // added to what the cable is told: m, or N if it is told its tension
  };

  Kind kind = Kind::kYoungsModulus;
  std::string name;          // for people
  std::vector<int> regions;  // of the mesh; empty: all
  int cable = -1;            // kCableOffset only
  // Standard deviation of what was known before, around the start: of the logarithm of Young's
  // modulus, of Poisson's ratio, or in m (N). Infinite: nothing was.
  double prior_sd = std::numeric_limits<double>::infinity();
};

struct IdentificationOptions {
  // How observations are weighed: model errors, loss and rejection have the values and the meaning
  // that they have when forces are estimated, so that the values found are those with which forces
  // come out right.
  EstimatorOptions estimator;
  double tolerance = 0.01;      // converged when a step would be of so many standard deviations
  double max_modulus_step = 4;  // factor by which an iteration may change Young's modulus
  double max_poissons_ratio = 0.499;  // beyond, the cells lock
  // An unknown is called unobservable if its standard deviation exceeds that of a guess.
  double guess_log_modulus = 0.5;
  double guess_poissons_ratio = 0.1;
  double guess_shortening = 5e-3;           // m
  double guess_tension = 1;                 // N
  const std::atomic<bool>* stop = nullptr;  // set from outside: end with kStopped

  void Check() const;  // throws InputError naming the option
};

struct IdentifiedValue {
  std::string name;
  const char* unit = "";  // "Pa", "" (Poisson's ratio), "m" or "N"
  double start = NAN;     // of a modulus or ratio: in the first region
  double value = NAN;
  double sd = NAN;
};

// What the model leaves unexplained in a state.
struct StateFit {
  std::string name;
  int observations = 0;       // used
  int rejected = 0;           // impossible after the fit, and not used
  double displacement = NAN;  // m, largest of an observed point
  double rms = NAN;           // m, model − measured, root mean square of the distance
  double rms_offset = NAN;    // m, the same with the rigid offset taken off
  RigidOffset offset;         // model's error and the rig's place together
};

struct Identification {
  enum class Status {
    kNotRun,
    kOk,
    kTooFewObservations,
    kUnobservable,
    kOutOfRange,  // Poisson's ratio at the end of its range
    kNotConverged,
    kInconsistent,  // too many observations are impossible
    kStopped        // from outside
  };

  Status status = Status::kNotRun;
  std::string reason;                    // for a person; empty if ok
  std::vector<IdentifiedValue> values;   // per unknown
  Eigen::VectorXd change;                // per unknown, from the start: of log E, of ν, in m (N)
  Eigen::MatrixXd covariance;            // of `change`
  std::vector<fem::Material> materials;  // per region of the mesh
  Eigen::VectorXd cable_offsets;         // m or N, per cable
  std::vector<StateFit> states;
  std::vector<std::vector<char>> rejected;  // per state and observation
  // Whitened squared misfit of the observations used, the offset's prior included.
  double chi2 = NAN;
  int degrees_of_freedom = 0;
  int iterations = 0;      // of the least-squares solver
  int factorisations = 0;  // of the tangent, for equilibria

  bool ok() const { return status == Status::kOk; }
  double Correlation(int a, int b) const;
  std::string BriefReport() const;  // one line
  std::string FullReport() const;   // tables of the values and the states
};

const char* Name(Identification::Status status);

// Finds numbers θ of a body (log E, ν, offsets of cables) from states in which its loads are known:
//
//   min over θ, η, ζ of Σ_m ρ(|R_m^(-1/2) (x(θ) + offset(η + ζ_s) − z)_m|²) + ηᵀP⁻¹η + Σ_g
//   ζ_gᵀQ⁻¹ζ_g
//
// with x(θ) the *converged* equilibria of all states, η the error of the rig's place, ζ_s the rigid
// part of the model's error in state s, which goes with the displacement and is shared in a group
// as far as the displacements are, and R_m the covariance of all that was seen of point m in a
// group: noise, and the local model error, shared likewise. For a single state these are the
// weights with which ForceEstimator finds forces. Ceres, with ∂x/∂θ = −K⁻¹ ∂f_int/∂θ from the
// tangent of each state. Impossible observations are rejected after the fit, and the rest is fitted
// again.
//
// `registration_covariance`: see ForceEstimator::SetRegistrationCovariance. Throws InputError for
// states that do not fit the body.
Identification Identify(const fem::Body& body, const std::vector<KnownState>& states,
                        const std::vector<Unknown>& unknowns,
                        const geometry::Matrix6d& registration_covariance,
                        const IdentificationOptions& options = {});

}  // namespace softforce::estimation
