#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/estimation/observation.h"

namespace softforce::estimation {

// The model's error in two states in which the body is displaced by s and t: it grows along the
// way, so that the states have in common what it was at the smaller displacement. Alike in pictures
// of one shape, half alike at half the way.
double ErrorCorrelation(double s, double t);

// What whitens observations of one point of the body in several states, which share the model's
// error there (standard deviation `sd` of each, m; in proportion to the displacement). Of the
// stacked whitened misfits, which hold noise of unit covariance, the matrix L⁻¹ with
// (L Lᵀ)_ij = δ_ij I + ErrorCorrelation · sd_i sd_j · whitening_i whitening_jᵀ. A single
// observation is whitened for R + sd² I.
Eigen::MatrixXd SharedErrorWhitening(const std::vector<const Observation*>& sharing,
                                     const std::vector<double>& sd);

}  // namespace softforce::estimation
