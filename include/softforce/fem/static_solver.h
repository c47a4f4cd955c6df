#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softforce/fem/body.h"

namespace softforce::fem {

enum class CableInput { kTension, kDisplacement };

struct CableCommand {
  CableInput input = CableInput::kTension;
  double value = 0;  // N (≥ 0), or m by which the cable is shortened against the body at rest
};

// What the body is told to do.
struct Actuation {
  std::vector<CableCommand> cables;  // one per cable of the body
  std::vector<double> pressures;     // Pa above the surroundings, one per chamber of the body
};

// Cables without tension, chambers without pressure.
Actuation NoActuation(const Body& body);

// Everything that acts on the body.
struct LoadCase {
  Eigen::Matrix3Xd forces;  // 3×N, N; dead loads on the nodes
  Actuation actuation;      // tensions ≥ 0
  double weight_share = 1;  // of the body's own weight
};

// The body's own weight and nothing else.
LoadCase OwnWeight(const Body& body);

// A shape of the body, and what its cables do there.
struct Equilibrium {
  Eigen::Matrix3Xd u;          // 3×N, m; displacement of the nodes
  Eigen::VectorXd tension;     // N, per cable
  Eigen::VectorXd shortening;  // m, per cable: length at rest − length now
  LoadCase load;               // that it balances
};

struct StaticSolverOptions {
  // Converged when no node would move further than this share of the body's diagonal.
  double tolerance = 1e-7;
  int max_iterations = 60;
  // What a factorisation of the tangent costs, in iterations with the one at hand. The old one is
  // kept until it has cost as many iterations more than a new one would have. 0: a new tangent for
  // every iteration, Newton's method of the textbook.
  double factorisation_worth = 10;
  int max_load_halvings = 8;

  void Check() const;  // throws InputError naming the option
};

struct SolveSummary {
  enum class Status {
    kNotRun,
    kConverged,
    kNotConverged,  // too many iterations, or none that lowers the energy
    kUnstable,      // the body buckles, snaps or bursts beyond the load reached
    kInverted       // a cell turns inside out
  };

  Status status = Status::kNotRun;
  int iterations = 0;         // Newton steps
  int factorisations = 0;     // of the tangent
  int load_steps = 0;         // 1 unless the load had to be cut
  double reached_share = 0;   // of the way from the old load to the new one that was gone
  double last_step = NAN;     // m, largest movement of a node in the last iteration
  int inverted_element = -1;  // set if kInverted, with
  Eigen::Vector3d inverted_at = Eigen::Vector3d::Constant(NAN);  // m, its centre at rest

  bool ok() const { return status == Status::kConverged; }
  std::string BriefReport() const;
  std::string Advice() const;  // what to try if it is not ok; empty if it is
};

// How the body answers to small changes of what acts on it, at an equilibrium and with the other
// commands of the cables held: a cable commanded by displacement gives way in tension (paper eqs. 4
// and 12).
struct Sensitivity {
  bool ok =
      false;  // false if the tangent is not positive definite there: the body is about to buckle
  Eigen::MatrixXd du;  // 3N×k, m per N (or m, Pa): K⁻¹ Hᵀ and its correction for the cables
  Eigen::MatrixXd d_tension;  // cables×k, N per the same
};

// Quasi-static equilibrium at large displacement:
//
//   f_int(x) + Σ_c t_c ∂ℓ_c/∂x = f + gravity + Σ_k p_k ∂V_k/∂x      on the nodes that are free,
//
// with f_int from the cells' elastic law, t_c ≥ 0 the tension and ℓ_c the length of cable c, p_k
// the pressure and V_k the volume of chamber k. A cable commanded by displacement d adds ℓ_c =
// ℓ_c(rest) − d or, where that would take a push, t_c = 0.
//
// Newton's method with a line search on the potential energy (augmented by the cables'
// constraints). The tangent is factorised by supernodal CHOLMOD on one thread, and kept over
// iterations and calls, corrected by limited-memory BFGS, for as long as that is cheaper than a new
// one. If Newton fails the load is approached in smaller steps; a step that would leave a cell
// inside out is not taken.
//
//   StaticSolver solver(body);
//   Equilibrium state = solver.AtRest();
//   SolveSummary summary = solver.Solve(load, &state);   // warm-started from `state`
class StaticSolver {
 public:
  // Checks the body: throws InputError naming `where`.
  StaticSolver(Body body, const std::string& where, const StaticSolverOptions& options = {});
  ~StaticSolver();
  StaticSolver(StaticSolver&&) noexcept;

  const Body& body() const;

  // The undeformed body without loads, its own weight included. With gravity, solve before use.
  Equilibrium AtRest() const;

  // Moves `state` to the equilibrium under `load`. If it does not converge, `state` is the last
  // equilibrium reached on the way.
  SolveSummary Solve(const LoadCase& load, Equilibrium* state);

  // The same, but only until no node would move further than `tolerance` (m), often after a single
  // step: for a load that is itself still being looked for. Of several approaches that follow one
  // another closely, all but the first are `continued`: a kept tangent that makes them many is
  // given up. `max_load_halvings`: instead of that of the options, where the caller has smaller
  // steps of its own to try.
  SolveSummary Approach(const LoadCase& load, double tolerance, bool continued, Equilibrium* state,
                        std::optional<int> max_load_halvings = std::nullopt);

  // One step of Newton's method with the tangent at `state`, without regard to how far that is
  // right (paper eqs. 3 and 4): false, and `state` as it was, if there is none.
  bool LinearStep(const LoadCase& load, Equilibrium* state);

  // Solves for the k columns of `forces` (3N×k, N) at `state`. The tangent is factorised anew if
  // any node stands further than `max_staleness` (m) from where it was last factorised.
  Sensitivity Solve(const Equilibrium& state, const Eigen::MatrixXd& forces, double max_staleness);

  // The same for small changes of the actuators' commands (their values: N or m of the cables, Pa
  // of the chambers), the dead loads and all other commands held. Columns: cables, then chambers.
  Sensitivity SolveActuation(const Equilibrium& state, double max_staleness);

  // Makes the body of other materials, one per region, after which no equilibrium found before is
  // one. Throws InputError for a material that is of no use.
  void SetMaterials(std::vector<Material> materials);

  // Elastic energy (J), for tests and reports.
  double ElasticEnergy(const Equilibrium& state) const;

  // Forces that the cells exert on the nodes, 3×N, N: f_int.
  Eigen::Matrix3Xd InternalForces(const Eigen::Matrix3Xd& u) const;

  // The same if the body were made of other materials: what derivatives by them are made of.
  Eigen::Matrix3Xd InternalForces(const Eigen::Matrix3Xd& u,
                                  const std::vector<Material>& materials) const;

 private:
  // Moves `state` to `load`, in smaller steps if it must.
  SolveSummary Reach(const LoadCase& load, double tolerance, int max_load_halvings,
                     Equilibrium* state);

  // The answer to k changes of the dead loads (3N×k, N) that come with changes of the commands of
  // the cables driven by displacement (cables×k, m).
  Sensitivity Respond(const Equilibrium& state, const Eigen::MatrixXd& forces,
                      const Eigen::MatrixXd& shortening, double max_staleness);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::fem
