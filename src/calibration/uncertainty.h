#pragma once

#include "calibration/normal_equations.h"

namespace softforce::calibration {

// Of camera `camera` over a grid of the picture; see ProjectionUncertainty.
ProjectionUncertainty ProjectionUncertaintyOf(const NormalEquations& equations,
                                              const Estimate& estimate, double noise_factor,
                                              const CameraToCalibrate& size, int camera,
                                              double distance, int columns, int rows);

}  // namespace softforce::calibration
