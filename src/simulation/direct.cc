#include "softforce/simulation/direct.h"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "softforce/base/input_error.h"

namespace softforce::simulation {
namespace {

fem::StaticSolverOptions Tight() {
  fem::StaticSolverOptions options;
  options.tolerance = kTruthTolerance;
  options.max_iterations = 200;
  return options;
}

}  // namespace

DirectProblem::DirectProblem(fem::Body body, std::vector<mesh::NodalWeights> places,
                             const std::string& where)
    : where_(where),
      places_(std::move(places)),
      solver_(std::move(body), where, Tight()),
      state_(solver_.AtRest()) {}

const fem::Equilibrium& DirectProblem::Solve(int frame, const Loading& loading) {
  assert(loading.forces.cols() == static_cast<Eigen::Index>(places_.size()));
  fem::LoadCase load{Eigen::Matrix3Xd::Zero(3, body().mesh.num_nodes()), loading.actuation, 1};
  for (size_t p = 0; p < places_.size(); ++p) {
    for (size_t i = 0; i < places_[p].nodes.size(); ++i) {
      load.forces.col(places_[p].nodes[i]) +=
          places_[p].weights[i] * loading.forces.col(static_cast<Eigen::Index>(p));
    }
  }
  const fem::SolveSummary summary = solver_.Solve(load, &state_);
  if (!summary.ok()) {
    throw base::InputError(
        fmt::format("{}: frame {}", where_, frame),
        "the body has no equilibrium that can be found under these loads: " + summary.BriefReport(),
        summary.Advice());
  }
  return state_;
}

}  // namespace softforce::simulation
