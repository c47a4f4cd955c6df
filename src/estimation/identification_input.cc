#include "estimation/identification_input.h"

#include <algorithm>

#include "softforce/base/input_error.h"

namespace softforce::estimation {

void CheckInput(const fem::Body& body, const std::vector<KnownState>& states,
                const std::vector<Unknown>& unknowns) {
  if (states.empty())
    throw base::InputError("identification", "got no state, expected one or more");
  if (unknowns.empty()) throw base::InputError("identification", "got nothing to be found");
  for (const KnownState& state : states) {
    const bool fits = state.forces.cols() == body.mesh.num_nodes() && state.forces.allFinite() &&
                      state.actuation.cables.size() == body.cables.size() &&
                      state.actuation.pressures.size() == body.chambers.size() &&
                      (state.points.empty() || state.points.size() == state.observations.size());
    if (!fits) {
      throw base::InputError("identification: " + state.name,
                             "its forces, commands or points do not fit the body");
    }
  }
  const int regions = static_cast<int>(body.materials.size());
  const int cables = static_cast<int>(body.cables.size());
  for (const Unknown& unknown : unknowns) {
    const auto outside = [&](int region) { return region < 0 || region >= regions; };
    const bool bad = unknown.kind == Unknown::Kind::kCableOffset
                         ? unknown.cable < 0 || unknown.cable >= cables
                         : std::any_of(unknown.regions.begin(), unknown.regions.end(), outside);
    if (bad) {
      throw base::InputError("identification: " + unknown.name,
                             "names a region or a cable that the body does not have");
    }
    if (!(unknown.prior_sd > 0)) {
      throw base::InputError("identification: " + unknown.name,
                             "its prior standard deviation must be greater than 0");
    }
  }
}

void IdentificationOptions::Check() const {
  estimator.Check();
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("identification option ") + option, rule);
  };
  require(tolerance > 0, "tolerance", "must be greater than 0");
  require(max_modulus_step > 1, "max_modulus_step", "must be greater than 1");
  require(max_poissons_ratio > 0 && max_poissons_ratio < 0.5, "max_poissons_ratio",
          "must lie between 0 and 0.5");
  require(guess_log_modulus > 0, "guess_log_modulus", "must be greater than 0");
  require(guess_poissons_ratio > 0, "guess_poissons_ratio", "must be greater than 0");
  require(guess_shortening > 0, "guess_shortening", "must be greater than 0 m");
  require(guess_tension > 0, "guess_tension", "must be greater than 0 N");
}

}  // namespace softforce::estimation
