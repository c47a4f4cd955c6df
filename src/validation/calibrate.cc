#include "softforce/validation/calibrate.h"

#include <Eigen/QR>
#include <cmath>

namespace softforce::validation {
namespace {

constexpr int kMaxIterations = 15;
// Of the modulus, or N: Gauss–Newton's next step is far smaller still.
constexpr double kConverged = 1e-4;
// m. Gauss–Newton converges with a tangent from this near; its answer does not depend on it.
constexpr double kMaxStaleness = 1e-4;

struct Unknowns {
  double log_factor = 0;           // of Young's modulus
  Eigen::VectorXd tension_change;  // N
};

// The markers' misfits of all frames and their derivatives, at the bodies' equilibria.
struct Linearisation {
  bool ok = true;
  Eigen::VectorXd misfit;  // m
  Eigen::MatrixXd J;
};

Linearisation Linearise(fem::StaticSolver* solver, const std::vector<mesh::NodalWeights>& markers,
                        const std::vector<CalibrationFrame>& frames, Uncertain uncertain,
                        const Unknowns& unknowns, std::vector<fem::Equilibrium>* states) {
  const Eigen::Matrix3Xd& X = solver->body().mesh.nodes;
  const int parameters =
      uncertain == Uncertain::kYoungsModulus ? 1 : static_cast<int>(solver->body().cables.size());
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(markers.size() * frames.size());
  Linearisation at{true, Eigen::VectorXd(rows), Eigen::MatrixXd(rows, parameters)};
  Eigen::Index row = 0;
  for (size_t f = 0; f < frames.size(); ++f) {
    fem::LoadCase load = frames[f].load;
    for (size_t c = 0; c < load.actuation.cables.size(); ++c) {
      load.actuation.cables[c].value += unknowns.tension_change(static_cast<Eigen::Index>(c));
    }
    fem::Equilibrium& state = (*states)[f];
    if (!solver->Solve(load, &state).ok()) return {false, {}, {}};
    // f_int goes with Young's modulus: K du = −f_int d(log E).
    const fem::Sensitivity sensitivity =
        uncertain == Uncertain::kYoungsModulus
            ? solver->Solve(state, -solver->InternalForces(state.u).reshaped(), kMaxStaleness)
            : solver->SolveActuation(state, kMaxStaleness);
    if (!sensitivity.ok) return {false, {}, {}};
    for (size_t m = 0; m < markers.size(); ++m, row += 3) {
      at.misfit.segment<3>(row) =
          markers[m].Apply(X) + markers[m].Apply(state.u) - frames[f].seen[m];
      for (int p = 0; p < parameters; ++p) {
        at.J.block<3, 1>(row, p) = markers[m].Apply(sensitivity.du.col(p).reshaped(3, X.cols()));
      }
    }
  }
  return at;
}

std::vector<fem::Material> Scaled(std::vector<fem::Material> materials, double factor) {
  for (fem::Material& material : materials) material.youngs_modulus *= factor;
  return materials;
}

}  // namespace

Calibration Calibrate(fem::StaticSolver* solver, const std::vector<mesh::NodalWeights>& markers,
                      const std::vector<CalibrationFrame>& frames, Uncertain uncertain,
                      const fem::Equilibrium& start) {
  const std::vector<fem::Material> believed = solver->body().materials;
  Unknowns unknowns;
  unknowns.tension_change =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(solver->body().cables.size()));
  std::vector<fem::Equilibrium> states(frames.size(), start);
  Calibration calibration;
  for (int iteration = 1; iteration <= kMaxIterations && !calibration.ok; ++iteration) {
    calibration.iterations = iteration;
    const Linearisation at = Linearise(solver, markers, frames, uncertain, unknowns, &states);
    if (!at.ok) break;
    const Eigen::VectorXd step = -at.J.colPivHouseholderQr().solve(at.misfit);
    calibration.ok = step.lpNorm<Eigen::Infinity>() < kConverged;
    if (uncertain == Uncertain::kTensions) {
      unknowns.tension_change += step;
    } else {
      unknowns.log_factor += step(0);
      solver->SetMaterials(Scaled(believed, std::exp(unknowns.log_factor)));
    }
  }
  calibration.youngs_modulus = solver->body().materials.front().youngs_modulus;
  calibration.tension_change = unknowns.tension_change;
  return calibration;
}

}  // namespace softforce::validation
