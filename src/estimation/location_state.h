#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/location_fit.h"
#include "estimation/model_error.h"
#include "estimation/subset_search.h"
#include "softforce/estimation/location_estimator.h"

namespace softforce::estimation {

// What a LocationEstimator holds.
struct LocationEstimator::State {
  State(fem::StaticSolver* solver_in, const mesh::Surface& surface,
        std::vector<LocationCandidate> candidates_in, const LocationOptions& options_in);

  // --- The body.
  fem::SolveSummary MoveTo(const Eigen::Matrix3Xd& forces, const fem::Actuation& told,
                           double tolerance, bool continued,
                           std::optional<int> max_load_halvings = std::nullopt);
  Eigen::Matrix3Xd NodalForces(const std::vector<TrialForce>& forces) const;

  // --- The observations, linearised where the body stands.
  // Computes the response of the body to forces on the observed points, unless what it has is for
  // the same points and about the same shape; `renew`: exactly the same. False if the body is about
  // to buckle.
  bool RefreshResponse(const std::vector<WhitenedObservation>& used, bool renew = false);
  LinearisedPoints Linearise(const std::vector<WhitenedObservation>& used,
                             const std::vector<Observation>& observations) const;
  // `slack` (m): what the linear answer may be wrong by, in each coordinate.
  std::vector<WhitenedObservation> WhitenAll(const std::vector<Observation>& observations,
                                             const std::vector<char>& rejected, double slack) const;
  double LargestDisplacement(const std::vector<Observation>& observations) const;  // m
  // m, of the way from where the observed points of a shape are to where they were seen: one that
  // no more than all that may be rejected exceed.
  double Distance(const Eigen::Matrix3Xd& u, const std::vector<Observation>& observations) const;
  bool IsJumpTo(const fem::Equilibrium& shape, const std::vector<Observation>& observations) const;
  // The observation that fits worst and cannot be right; −1 if there is none.
  int WorstOf(const std::vector<WhitenedObservation>& used, const LinearisedPoints& points,
              const LocationResidual& at) const;

  // --- How many forces, and where.
  // What speaks for other answers than the one at hand.
  struct Rivals {
    double odds = 0;  // how much likelier than it they are, all together
    // Per force: candidates on other faces, at which it explains nearly the same.
    std::vector<std::vector<int>> elsewhere;
  };
  double Price(const TrialForce& force) const;  // by which χ² has to fall for it
  double Total(double chi2, const std::vector<TrialForce>& forces) const;
  GroupedProblem AtCandidates(const LinearisedPoints& points) const;
  std::vector<TrialForce> ForcesOf(const Subset& subset) const;
  std::vector<TrialForce> Likeliest(const LinearisedPoints& points, double* chi2) const;
  // The likeliest forces, from those at hand; sets χ² and what speaks against them.
  std::vector<TrialForce> Search(const LinearisedPoints& points,
                                 const std::vector<TrialForce>& from, double* chi2,
                                 Rivals* rivals) const;
  std::vector<TrialForce> SearchFrom(const LinearisedPoints& points, std::vector<TrialForce> from,
                                     double* chi2, Rivals* rivals) const;
  bool SameAnswer(const std::vector<TrialForce>& a, const std::vector<TrialForce>& b) const;
  double Refine(const LinearisedPoints& points, std::vector<TrialForce>* forces) const;
  // Each makes the forces likelier by one kind of change if it can; if not, it adds to the rivals.
  bool Prune(const LinearisedPoints& points, std::vector<TrialForce>* forces, double* chi2,
             Rivals* rivals) const;
  bool Grow(const LinearisedPoints& points, std::vector<TrialForce>* forces, double* chi2,
            Rivals* rivals) const;
  bool ChangeFace(const LinearisedPoints& points, std::vector<TrialForce>* forces, double* chi2,
                  Rivals* rivals) const;
  std::vector<TrialForce> Survivors(const LinearisedPoints& points, double* chi2) const;
  // Gives them the identities of those of `before` that are nearest, new ones to the others.
  void Identify(const std::vector<TrialForce>& before, std::vector<TrialForce>* forces);

  // The likeliest forces for given observations, after those are rejected that they cannot explain.
  struct Round;
  bool Explain(const std::vector<Observation>& observations, bool search, Round* round,
               LocationEstimate* estimate);
  // From a shape, if there is one, else from the equilibrium under the last forces.
  LocationEstimate Converge(const std::vector<Observation>& observations,
                            const fem::Actuation& told, const fem::Equilibrium* shape);
  void Conclude(Round* round, LocationEstimate* estimate);
  // Places, forces and their covariances; false if they are not determined, with the culprit.
  bool Describe(const LinearisedPoints& points, const std::vector<TrialForce>& forces,
                std::vector<LocatedForce>* located, std::string* culprit) const;
  void FindAlternatives(const Round& round, LocationEstimate* estimate) const;
  int FaceOf(const mesh::SurfacePoint& at) const { return faces.walk().region()[at.triangle]; }
  int NearestCandidate(const Eigen::Vector3d& place) const;

  bool moves() const { return options.method == LocationMethod::kContinuous; }

  fem::StaticSolver* solver;
  std::vector<LocationCandidate> candidates;
  LocationOptions options;
  ForceFaces faces;
  std::vector<Eigen::Vector3d> candidate_places;  // m, body at rest
  std::vector<PlacedPatch> candidate_patches;
  geometry::Matrix6d registration_covariance = geometry::Matrix6d::Zero();
  double diagonal = NAN;  // m, of the body at rest

  fem::Equilibrium state;
  std::vector<TrialForce> forces;  // of the last usable estimate
  int next_identity = 0;
  int first_new_identity = 0;  // of the frame at hand

  Eigen::MatrixXd response;  // 3N×3m, see LinearisedPoints
  std::vector<mesh::NodalWeights> response_points;
  Eigen::Matrix3Xd response_u;
};

}  // namespace softforce::estimation
