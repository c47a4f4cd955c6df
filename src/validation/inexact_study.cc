// Tables II and III: something of the inverse model is wrong.
#include <functional>
#include <utility>

#include "softforce/validation/calibrate.h"
#include "softforce/validation/direct_model.h"
#include "softforce/validation/inverse_model.h"
#include "softforce/validation/study.h"
#include "validation/jobs.h"

namespace softforce::validation {
namespace {

constexpr double kTolerance = 1e-9;  // of the body's diagonal, of direct and inverse models
constexpr double kFinest = 1e-8;     // m, of the estimates
// N. Least squares that ask for more, to explain a wrong model with forces of 0.4 N, have no answer
// worth minutes of following the body there.
constexpr double kAbsurd = 5;
// m, of the tangents. The fit corrects them by what it sees the body do.
constexpr double kStaleness = 2e-3;

const Eigen::Vector3d kNowhere = Eigen::Vector3d::Constant(NAN);

using Points = std::vector<Eigen::Vector3d>;

// What a layout's markers show of the direct model.
struct Views {
  Points unloaded, weighed, loaded;
};

Points Shifted(Points points, double z) {
  for (Eigen::Vector3d& point : points) point.z() += z;
  return points;
}

Views Shifted(const Views& views, double z) {
  return {Shifted(views.unloaded, z), Shifted(views.weighed, z), Shifted(views.loaded, z)};
}

std::vector<fem::Material> OfModulus(const Model& model, double youngs_modulus) {
  std::vector<fem::Material> materials = model.body.materials;
  for (fem::Material& material : materials) material.youngs_modulus = youngs_modulus;
  return materials;
}

// The method of the paper, on the given mesh.
void RunPlain(const Model& model, const Views& views, InexactCase* result) {
  fem::StaticSolverOptions options;
  options.tolerance = kTolerance;
  fem::StaticSolver solver(model.body, result->layout.name, options);
  estimation::EstimatorOptions least_squares = LeastSquares(kFinest);
  least_squares.max_staleness = kStaleness;
  const auto make = [&](double youngs_modulus) {
    solver.SetMaterials(OfModulus(model, youngs_modulus));
    InverseModel inverse(model, &solver, result->layout, least_squares, kWideSd);
    inverse.SetLargestForce(kAbsurd);
    return inverse;
  };
  for (size_t i = 0; i < kWrongModuli.size(); ++i) {
    result->modulus[i] = make(kWrongModuli[i]).Error(views.loaded, Tensioned(model.body));
  }
  InverseModel inverse = make(kYoungsModulus);
  result->alone = inverse.Error(views.loaded, Tensioned(model.body));
  for (size_t i = 0; i < kMarkerShifts.size(); ++i) {
    result->markers[i] =
        inverse.Error(Shifted(views.loaded, kMarkerShifts[i]), Tensioned(model.body));
  }
  if (model.body.cables.empty()) return;
  for (size_t i = 0; i < kTensionErrors.size(); ++i) {
    result->tension[i] = inverse.Error(views.loaded, Tensioned(model.body, kTensionErrors[i]));
  }
}

// The remedies, on the finer mesh: what is wrong is calibrated with a known weight, the place of
// the measuring frame is found along with the forces, and the robot's markers are compared with the
// model before the forces come, under its cables.
class Remedied {
 public:
  Remedied(const Model& model, const Views& views, const Layout& layout)
      : model_(model),
        views_(views),
        layout_(layout),
        actuated_(!model.body.cables.empty()),
        solver_(model.body, layout.name, Options()) {
    for (const Eigen::Vector3d& place : layout.markers) markers_.push_back(PointAt(model, place));
  }

  void Run(InexactCase* result) {
    RunMarkersAndTension(result);
    RunModulus(result);
  }

 private:
  static fem::StaticSolverOptions Options() {
    fem::StaticSolverOptions options;
    options.tolerance = kTolerance;
    return options;
  }

  InverseModel Make() {
    InverseModel inverse(model_, &solver_, layout_, WithRegistration(), kMarkerSd);
    inverse.FreeRegistration();
    return inverse;
  }

  static estimation::EstimatorOptions WithRegistration() {
    estimation::EstimatorOptions options = LeastSquares(kFinest);
    options.max_staleness = kStaleness;
    options.tolerance = kFinest / kMarkerSd;
    // The discretisations differ by more than the markers' noise: no marker is an outlier.
    options.rejection_probability = 1e-12;
    options.loss_scale = 1e3;
    return options;
  }

  fem::LoadCase Load(const std::vector<AppliedForce>& forces, double excess) const {
    return LoadOf(model_, forces, Tensioned(model_.body, excess));
  }

  // Where the model, as calibrated, has the markers before the forces. `state`: where to start
  // from.
  Points Unloaded(const fem::Actuation& actuation, fem::Equilibrium state) {
    fem::LoadCase load = Load({}, 0);
    load.actuation = actuation;
    if (!solver_.Solve(load, &state).ok()) return Points(markers_.size(), kNowhere);
    unloaded_ = state;
    return Seen(model_, state, layout_.markers);
  }

  static Points Offsets(const Points& seen, const Points& on_model) {
    Points offsets;
    for (size_t i = 0; i < seen.size(); ++i) offsets.push_back(seen[i] - on_model[i]);
    return offsets;
  }

  // Young's modulus is right: the places of the markers are wrong, or the tensions are.
  void RunMarkersAndTension(InexactCase* result) {
    solver_.SetMaterials(OfModulus(model_, kYoungsModulus));
    InverseModel inverse = Make();
    const fem::Actuation told = Tensioned(model_.body);
    Points on_model;
    if (actuated_) {
      on_model = Unloaded(told, solver_.AtRest());
      for (size_t i = 0; i < kMarkerShifts.size(); ++i) {
        result->markers_untared[i] =
            inverse.SelectedError(Shifted(views_.loaded, kMarkerShifts[i]), told);
      }
      inverse.SetOffsets(Offsets(views_.unloaded, on_model));
    }
    result->remedied_alone = inverse.SelectedError(views_.loaded, told);
    for (size_t i = 0; i < kMarkerShifts.size(); ++i) {
      const Views shifted = Shifted(views_, kMarkerShifts[i]);
      if (actuated_) inverse.SetOffsets(Offsets(shifted.unloaded, on_model));
      result->markers_remedied[i] = inverse.SelectedError(shifted.loaded, told);
    }
    if (actuated_) RunTension(&inverse, result);
  }

  void RunTension(InverseModel* inverse, InexactCase* result) {
    const double excess = kTensionErrors.back();
    const Calibration found = Calibrate(&solver_, markers_, {{Load({}, excess), views_.unloaded}},
                                        Uncertain::kTensions, unloaded_);
    if (!found.ok) return;
    fem::Actuation told = Tensioned(model_.body, excess);
    for (size_t c = 0; c < told.cables.size(); ++c) {
      told.cables[c].value += found.tension_change(static_cast<Eigen::Index>(c));
    }
    inverse->SetOffsets(Offsets(views_.unloaded, Unloaded(told, unloaded_)));
    result->tension_remedied = inverse->SelectedError(views_.loaded, told);
  }

  void RunModulus(InexactCase* result) {
    const fem::Equilibrium start = actuated_ ? unloaded_ : solver_.AtRest();
    solver_.SetMaterials(OfModulus(model_, kWrongModuli.back()));
    std::vector<CalibrationFrame> frames{{Load({KnownWeight(layout_.body)}, 0), views_.weighed}};
    if (actuated_) frames.push_back({Load({}, 0), views_.unloaded});
    const Calibration found =
        Calibrate(&solver_, markers_, frames, Uncertain::kYoungsModulus, start);
    if (!found.ok) return;
    result->youngs_modulus = found.youngs_modulus;
    InverseModel inverse = Make();
    const fem::Actuation told = Tensioned(model_.body);
    if (actuated_) inverse.SetOffsets(Offsets(views_.unloaded, Unloaded(told, unloaded_)));
    result->modulus_remedied = inverse.SelectedError(views_.loaded, told);
  }

  const Model& model_;
  const Views& views_;
  const Layout& layout_;
  const bool actuated_;
  fem::StaticSolver solver_;
  std::vector<mesh::NodalWeights> markers_;
  fem::Equilibrium unloaded_;  // the last that Unloaded found
};

InexactCase RunCase(const Layout& layout, const Model& given, const Model& finer,
                    const DirectModel& direct) {
  InexactCase result;
  result.layout = layout;
  const Views views{Seen(direct.model, direct.unloaded, layout.markers),
                    Seen(direct.model, direct.weighed, layout.markers),
                    Seen(direct.model, direct.loaded.back(), layout.markers)};
  RunPlain(given, views, &result);
  Remedied(finer, views, layout).Run(&result);
  return result;
}

}  // namespace

std::vector<InexactCase> RunInexact(BodyKind body, const Discretisations& meshes,
                                    const std::vector<Layout>& layouts,
                                    const StudyOptions& options) {
  std::vector<InexactCase> results(layouts.size());
  if (layouts.empty()) return results;
  const DirectModel direct =
      SolveDirectModel(body, MakeModel(body, meshes.truth, kYoungsModulus), 1, kTolerance);
  const Model given = MakeModel(body, meshes.given, kYoungsModulus);
  const Model finer = MakeModel(body, meshes.inverse, kYoungsModulus);
  std::vector<std::function<void()>> jobs;
  for (size_t i = 0; i < layouts.size(); ++i) {
    jobs.emplace_back([&, i] { results[i] = RunCase(layouts[i], given, finer, direct); });
  }
  const std::string table = body == BodyKind::kSheet ? "Table II" : "Table III";
  RunJobs(jobs, options.threads, options.show_progress ? table : "");
  return results;
}

}  // namespace softforce::validation
