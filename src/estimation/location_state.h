#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "estimation/location_fit.h"
#include "estimation/model_error.h"
#include "estimation/subset_search.h"
#include "softforce/estimation/location_estimator.h"

namespace softforce::estimation {

// A force that acted a few usable frames ago, and may come back.
struct GoneForce {
  int identity;
  Eigen::Vector3d rest;  // m, where it was on the body at rest
  int frames;            // usable ones since
};

// What a LocationEstimator holds.
struct LocationEstimator::State {
  State(fem::StaticSolver* solver_in, const mesh::Surface& surface,
        std::vector<LocationCandidate> candidates_in, const LocationOptions& options_in);

  // --- The body.
  fem::SolveSummary MoveTo(const Eigen::Matrix3Xd& nodal, const fem::Actuation& told,
                           double tolerance, bool continued,
                           std::optional<int> max_load_halvings = std::nullopt);
  Eigen::Matrix3Xd NodalForces(const std::vector<TrialForce>& trials) const;

  // --- The observations, linearised where the body stands.
  // Computes the response of the body to forces on the observed points, unless what it has is for
  // the same points and about the same shape; `renew`: exactly the same. False if the body is about
  // to buckle.
  bool RefreshResponse(const std::vector<WhitenedObservation>& used, bool renew = false);
  // Takes it from that of more points; false if one of them is not among these.
  bool SelectResponse(const std::vector<WhitenedObservation>& used);
  LinearisedPoints Linearise(const std::vector<WhitenedObservation>& used,
                             const std::vector<Observation>& observations) const;
  // `slack` (m): what the linear answer may be wrong by in each coordinate, per observation; one
  // with an infinite slack stays among them and has no weight.
  std::vector<WhitenedObservation> WhitenAll(const std::vector<Observation>& observations,
                                             const std::vector<char>& rejected,
                                             const std::vector<double>& slack) const;
  bool IsPossible(const Observation& seen) const;  // finite, and not absurdly far
  double LargestDisplacement(const std::vector<Observation>& observations) const;  // m
  // m, of the way from where the observed points of a shape are to where they were seen: one that
  // no more than all that may be rejected exceed.
  double Distance(const Eigen::Matrix3Xd& u, const std::vector<Observation>& observations) const;
  bool IsJumpTo(const fem::Equilibrium& shape, const std::vector<Observation>& observations) const;
  // By how much χ² would fall if one were left out, the forces giving way, as a share of the most
  // that it may be for a right observation.
  std::vector<double> Excesses(const std::vector<WhitenedObservation>& used,
                               const LinearisedPoints& points, const LocationResidual& at) const;
  // The observation that fits worst and cannot be right; −1 if there is none.
  int WorstOf(const std::vector<WhitenedObservation>& used, const LinearisedPoints& points,
              const LocationResidual& at) const;
  // How far each observation is from where the body stands, m.
  struct Ways {
    std::vector<double> way, sd;  // per observation of the caller's; sd of its surest coordinate
    std::vector<double> slack;    // that the linear answer may be wrong by; infinite: left out
    double usual;                 // of all but as many as may be rejected
  };
  Ways WaysLeft(const std::vector<Observation>& observations,
                const std::vector<char>& rejected) const;
  // Which observations another force should not be believed for, from forces at hand: indices among
  // the caller's.
  std::vector<int> Screen(const std::vector<Observation>& observations,
                          const std::vector<char>& rejected, std::vector<TrialForce> trials) const;
  // Those that forces, found from the others, would have to move much further than they do.
  std::vector<int> TooFar(const Ways& ways, const std::vector<WhitenedObservation>& used,
                          const std::vector<TrialForce>& trials) const;
  // Those of the rejected ones that forces found without them explain.
  std::vector<int> Explained(const std::vector<Observation>& observations,
                             const std::vector<char>& rejected, double slack,
                             const std::vector<TrialForce>& trials);

  // --- How many forces, and where.
  // What speaks for other answers than the one at hand.
  struct Rivals {
    double odds = 0;  // how much likelier than it they are, all together
    // Per force: candidates on other faces, at which it explains nearly the same.
    std::vector<std::vector<int>> elsewhere;
  };
  double Price(const TrialForce& force) const;  // by which χ² has to fall for it
  double Total(double chi2, const std::vector<TrialForce>& trials) const;
  GroupedProblem AtCandidates(const LinearisedPoints& points) const;
  std::vector<TrialForce> ForcesOf(const Subset& subset) const;
  std::vector<TrialForce> Likeliest(const LinearisedPoints& points, double* chi2) const;
  // The likeliest forces, from those at hand; sets χ² and what speaks against them.
  std::vector<TrialForce> Search(const LinearisedPoints& points,
                                 const std::vector<TrialForce>& from, double* chi2,
                                 Rivals* rivals) const;
  std::vector<TrialForce> SearchFrom(const LinearisedPoints& points, std::vector<TrialForce> trials,
                                     double* chi2, Rivals* rivals) const;
  bool SameAnswer(const std::vector<TrialForce>& a, const std::vector<TrialForce>& b) const;
  double Refine(const LinearisedPoints& points, std::vector<TrialForce>* trials) const;
  bool IsPlausible(double chi2, Eigen::Index rows, const std::vector<TrialForce>& trials) const;
  // χ² with a force at each candidate besides, those at hand giving way: the best few first.
  std::vector<std::pair<double, int>> Starts(const LinearisedPoints& points,
                                             const std::vector<TrialForce>& trials) const;
  // One more force, near the candidate at which it explains most; empty if none makes them
  // likelier, `nearest` then saying what the likeliest costs.
  std::vector<TrialForce> Another(const LinearisedPoints& points,
                                  const std::vector<TrialForce>& trials, double* chi2,
                                  double* nearest) const;
  // Each makes the forces likelier by one kind of change if it can; if not, it adds to the rivals.
  bool Prune(const LinearisedPoints& points, std::vector<TrialForce>* trials, double* chi2,
             Rivals* rivals) const;
  bool Grow(const LinearisedPoints& points, std::vector<TrialForce>* trials, double* chi2,
            Rivals* rivals) const;
  bool ChangeFace(const LinearisedPoints& points, std::vector<TrialForce>* trials, double* chi2,
                  Rivals* rivals) const;
  std::vector<TrialForce> Survivors(const LinearisedPoints& points, double* chi2) const;
  // Gives them the identities of those of `before` that are nearest, then of those that have
  // vanished, new ones to the others.
  void Identify(const std::vector<TrialForce>& before, const std::vector<GoneForce>& vanished,
                std::vector<TrialForce>* trials);
  // They are the last ones from now on; those that are no more have gone.
  void Remember(const std::vector<TrialForce>& now);

  // The likeliest forces for given observations, after those are rejected that they cannot explain.
  struct Round;
  // Whether what is seen asks for no other forces than those there were.
  bool Explains(const Round& round, const std::vector<TrialForce>& from) const;
  bool Explain(const std::vector<Observation>& observations, bool search, Round* round,
               LocationEstimate* estimate);
  // From a shape, if there is one, else from the equilibrium under the last forces.
  LocationEstimate Converge(const std::vector<Observation>& observations,
                            const fem::Actuation& told, const fem::Equilibrium* shape);
  void Conclude(Round* last, LocationEstimate* estimate);
  // Places, forces and their covariances; false if they are not determined, with the culprit.
  bool Describe(const LinearisedPoints& points, const std::vector<TrialForce>& trials,
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
  std::vector<GoneForce> gone;
  int next_identity = 0;
  int first_new_identity = 0;  // of the frame at hand

  Eigen::MatrixXd response;      // 3N×3m, see LinearisedPoints
  Eigen::MatrixXd all_response;  // the same for points that may have been rejected since
  std::vector<mesh::NodalWeights> response_points, all_response_points;
  Eigen::Matrix3Xd response_u;
};

}  // namespace softforce::estimation
