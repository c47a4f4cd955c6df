#pragma once

#include <vector>

#include "softforce/fem/static_solver.h"

namespace softforce::validation {

// A frame whose forces are known.
struct CalibrationFrame {
  fem::LoadCase load;                 // its actuation as it was told
  std::vector<Eigen::Vector3d> seen;  // m, of each marker
};

struct Calibration {
  bool ok = false;
  double youngs_modulus = NAN;     // Pa
  Eigen::VectorXd tension_change;  // N, per cable: what it does less what it was told
  int iterations = 0;
};

// Which of a body's parameters is not what the model believes.
enum class Uncertain { kYoungsModulus, kTensions };

// Finds what was wrong from frames with known forces, by Gauss–Newton on the equilibrium: least
// squares of the markers' positions, over the logarithm of Young's modulus (one for the whole
// body), or over the cables' tensions. Starts from the materials that the solver has and from a
// shape near the frames', and leaves the solver with the materials found.
Calibration Calibrate(fem::StaticSolver* solver, const std::vector<mesh::NodalWeights>& markers,
                      const std::vector<CalibrationFrame>& frames, Uncertain uncertain,
                      const fem::Equilibrium& start);

}  // namespace softforce::validation
