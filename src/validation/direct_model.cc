#include "softforce/validation/direct_model.h"

#include <fmt/format.h>

#include <utility>

#include "softforce/base/input_error.h"

namespace softforce::validation {

fem::LoadCase LoadOf(const Model& model, const std::vector<AppliedForce>& forces,
                     const fem::Actuation& actuation) {
  fem::LoadCase load = fem::OwnWeight(model.body);
  load.actuation = actuation;
  for (const AppliedForce& applied : forces) {
    const mesh::NodalWeights at = SiteAt(model, applied.place).at;
    for (size_t i = 0; i < at.nodes.size(); ++i) {
      load.forces.col(at.nodes[i]) += at.weights[i] * applied.force;
    }
  }
  return load;
}

std::vector<Eigen::Vector3d> Seen(const Model& model, const fem::Equilibrium& state,
                                  const std::vector<Eigen::Vector3d>& places) {
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& place : places) {
    const mesh::NodalWeights at = PointAt(model, place);
    seen.push_back(at.Apply(model.body.mesh.nodes) + at.Apply(state.u));
  }
  return seen;
}

DirectModel SolveDirectModel(BodyKind kind, Model model, int frames, double tolerance) {
  DirectModel direct{std::move(model), {}, {}, {}};
  fem::StaticSolverOptions options;
  options.tolerance = tolerance;
  const std::string where = fmt::format("direct model of the {}", Name(kind));
  fem::StaticSolver solver(direct.model.body, where, options);
  const auto solve = [&](std::vector<AppliedForce> forces, double share, fem::Equilibrium state) {
    for (AppliedForce& applied : forces) applied.force *= share;
    const fem::LoadCase load = LoadOf(direct.model, forces, Tensioned(direct.model.body));
    const fem::SolveSummary summary = solver.Solve(load, &state);
    if (!summary.ok()) throw base::InputError(where, summary.BriefReport(), summary.Advice());
    return state;
  };
  direct.unloaded = solve({}, 1, solver.AtRest());
  direct.weighed = solve({KnownWeight(kind)}, 1, direct.unloaded);
  fem::Equilibrium state = direct.unloaded;
  for (int frame = 1; frame <= frames; ++frame) {
    state = solve(AppliedForces(kind), static_cast<double>(frame) / frames, state);
    direct.loaded.push_back(state);
  }
  return direct;
}

}  // namespace softforce::validation
