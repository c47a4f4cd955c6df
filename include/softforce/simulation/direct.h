#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softforce/fem/static_solver.h"

namespace softforce::simulation {

// Everything that acts on a body in one frame.
struct Loading {
  Eigen::Matrix3Xd forces;  // N, a column per place, dead loads in the mesh's frame
  fem::Actuation actuation;
};

// How tightly the truth is converged: no node would move further than this share of the body's
// diagonal, far less than a number in a file shows.
inline constexpr double kTruthTolerance = 1e-9;

// The direct problem: from known loads to the shape of a body, frame after frame, each started from
// the one before. Quasi-static, so that the way there does not matter unless the body buckles.
class DirectProblem {
 public:
  // `places`: where the forces act, each the mean of shape functions. Throws InputError naming
  // `where` if the body cannot be used.
  DirectProblem(fem::Body body, std::vector<mesh::NodalWeights> places, const std::string& where);

  const fem::Body& body() const { return solver_.body(); }

  // Throws InputError naming the frame, and what to do, if no equilibrium is found.
  const fem::Equilibrium& Solve(int frame, const Loading& loading);

 private:
  std::string where_;
  std::vector<mesh::NodalWeights> places_;
  fem::StaticSolver solver_;
  fem::Equilibrium state_;
};

}  // namespace softforce::simulation
