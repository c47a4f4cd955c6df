#include "validation/remedied.h"

#include <utility>

#include "softforce/estimation/identification.h"
#include "softforce/validation/direct_model.h"

namespace softforce::validation {
namespace {

const Eigen::Vector3d kNowhere = Eigen::Vector3d::Constant(NAN);

Views AllShifted(const Views& views, double z) {
  return {Shifted(views.unloaded, z), Shifted(views.weighed, z), Shifted(views.loaded, z)};
}

// The remedies, on the finer mesh: what is wrong is identified with a known weight, the place of
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
    options.max_staleness = estimation::EstimatorOptions().max_staleness;
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
      const Views shifted = AllShifted(views_, kMarkerShifts[i]);
      if (actuated_) inverse.SetOffsets(Offsets(shifted.unloaded, on_model));
      result->markers_remedied[i] = inverse.SelectedError(shifted.loaded, told);
    }
    if (actuated_) RunTension(&inverse, result);
  }

  // A frame whose forces are known, for identification.
  estimation::KnownState Known(const char* name, const std::vector<AppliedForce>& forces,
                               const fem::Actuation& told, const Points& seen) const {
    estimation::KnownState state;
    state.name = name;
    state.forces = LoadOf(model_, forces, told).forces;
    state.actuation = told;
    for (size_t i = 0; i < markers_.size(); ++i) {
      estimation::Observation observation;
      observation.at = markers_[i];
      observation.position = seen[i];
      observation.whitening = Eigen::Matrix3d::Identity() / kMarkerSd;
      state.observations.push_back(observation);
    }
    return state;
  }

  estimation::Identification Identify(double youngs_modulus,
                                      const std::vector<estimation::KnownState>& states,
                                      const std::vector<estimation::Unknown>& unknowns) const {
    fem::Body body = model_.body;
    body.materials = OfModulus(model_, youngs_modulus);
    estimation::IdentificationOptions options;
    options.estimator = WithRegistration();
    return estimation::Identify(body, states, unknowns, RegistrationCovariance(), options);
  }

  void RunTension(InverseModel* inverse, InexactCase* result) {
    fem::Actuation told = Tensioned(model_.body, kTensionErrors.back());
    std::vector<estimation::Unknown> tensions;
    for (size_t c = 0; c < told.cables.size(); ++c) {
      tensions.push_back({estimation::Unknown::Kind::kCableOffset,
                          model_.body.cables[c].name,
                          {},
                          static_cast<int>(c)});
    }
    const estimation::Identification found =
        Identify(kYoungsModulus, {Known("before the forces", {}, told, views_.unloaded)}, tensions);
    if (!found.ok()) return;
    for (size_t c = 0; c < told.cables.size(); ++c) {
      told.cables[c].value += found.cable_offsets(static_cast<Eigen::Index>(c));
    }
    inverse->SetOffsets(Offsets(views_.unloaded, Unloaded(told, unloaded_)));
    result->tension_remedied = inverse->SelectedError(views_.loaded, told);
  }

  void RunModulus(InexactCase* result) {
    const fem::Actuation told = Tensioned(model_.body);
    std::vector<estimation::KnownState> states{
        Known("known weight", {KnownWeight(layout_.body)}, told, views_.weighed)};
    if (actuated_) states.push_back(Known("before the forces", {}, told, views_.unloaded));
    estimation::Unknown modulus;
    modulus.kind = estimation::Unknown::Kind::kYoungsModulus;
    modulus.name = "Young's modulus";
    const estimation::Identification found = Identify(kWrongModuli.back(), states, {modulus});
    if (!found.ok()) return;
    result->youngs_modulus = found.materials.front().youngs_modulus;
    const fem::Equilibrium start = actuated_ ? unloaded_ : solver_.AtRest();
    solver_.SetMaterials(found.materials);
    InverseModel inverse = Make();
    if (actuated_) inverse.SetOffsets(Offsets(views_.unloaded, Unloaded(told, start)));
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

}  // namespace

Points Shifted(Points points, double z) {
  for (Eigen::Vector3d& point : points) point.z() += z;
  return points;
}

std::vector<fem::Material> OfModulus(const Model& model, double youngs_modulus) {
  std::vector<fem::Material> materials = model.body.materials;
  for (fem::Material& material : materials) material.youngs_modulus = youngs_modulus;
  return materials;
}

void RunRemedied(const Model& finer, const Views& views, InexactCase* result) {
  Remedied(finer, views, result->layout).Run(result);
}

}  // namespace softforce::validation
