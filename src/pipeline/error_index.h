#pragma once

#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// I_w = ‖W_ef⁺‖₁ of the paper (VI.A) for the body at rest, N/m: how much an error of the markers
// can be amplified. NaN if the markers are too few or the body has no equilibrium.
double IndexW(const World& world);

}  // namespace softforce::pipeline
