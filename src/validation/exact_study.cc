// Table I: the inverse model is exact.
#include <functional>

#include "softforce/fem/compliance.h"
#include "softforce/validation/direct_model.h"
#include "softforce/validation/inverse_model.h"
#include "softforce/validation/study.h"
#include "validation/jobs.h"

namespace softforce::validation {
namespace {

constexpr double kTolerance = 1e-13;  // of the body's diagonal: rounding
constexpr double kFinest = 1e-12;     // m, of the estimate: I_w = 2000 N/mm makes 2e-6 mN of it

// The linear method watches the cables being pulled before the forces come: it cannot follow a
// jump.
void PullCables(const Model& model, const Layout& layout, fem::StaticSolver* solver, int frames,
                InverseModel* linear) {
  fem::Equilibrium state = solver->AtRest();
  for (int frame = 1; frame <= frames; ++frame) {
    const double share = static_cast<double>(frame) / frames;
    const fem::Actuation told = Tensioned(model.body, (share - 1) * kTension);
    if (!solver->Solve(LoadOf(model, {}, told), &state).ok()) return;
    linear->Error(Seen(model, state, layout.markers), told);
  }
}

ExactCase RunCase(const Layout& layout, const mesh::TetMesh& mesh, const DirectModel& direct) {
  ExactCase result;
  result.layout = layout;
  const Model model = MakeModel(layout.body, mesh, kYoungsModulus);
  fem::StaticSolverOptions solver_options;
  solver_options.tolerance = kTolerance;
  fem::StaticSolver solver(model.body, layout.name, solver_options);
  const fem::Actuation told = Tensioned(model.body);
  const auto frames = static_cast<int>(direct.loaded.size());

  estimation::EstimatorOptions options = LeastSquares(kFinest);
  InverseModel converged(model, &solver, layout, options, kWideSd);
  converged.estimator().Advance(fem::NoActuation(model.body));
  result.I_w = fem::InverseComplianceNorm(converged.Compliance());
  // Frame by frame, as the linear method: at I_w = 2000 N/mm what a jump is off the tangent would
  // be taken for tens of newtons.
  for (const fem::Equilibrium& frame : direct.loaded) {
    result.converged = converged.Error(Seen(direct.model, frame, layout.markers), told);
  }

  options.method = estimation::EstimationMethod::kLinearStep;
  options.max_staleness = 0;  // a new tangent in every frame, as in the paper
  InverseModel linear(model, &solver, layout, options, kWideSd);
  if (!model.body.cables.empty()) PullCables(model, layout, &solver, frames, &linear);
  for (const fem::Equilibrium& frame : direct.loaded) {
    result.linear = linear.Error(Seen(direct.model, frame, layout.markers), told);
  }
  return result;
}

}  // namespace

std::vector<ExactCase> RunExact(BodyKind body, const mesh::TetMesh& mesh,
                                const std::vector<Layout>& layouts, const StudyOptions& options) {
  std::vector<ExactCase> results(layouts.size());
  if (layouts.empty()) return results;
  const DirectModel direct =
      SolveDirectModel(body, MakeModel(body, mesh, kYoungsModulus), options.frames, kTolerance);
  std::vector<std::function<void()>> jobs;
  for (size_t i = 0; i < layouts.size(); ++i) {
    jobs.emplace_back([&, i] { results[i] = RunCase(layouts[i], mesh, direct); });
  }
  RunJobs(jobs, options.threads,
          options.show_progress ? std::string("Table I, ") + Name(body) : "");
  return results;
}

}  // namespace softforce::validation
