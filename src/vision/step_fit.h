#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace softforce::vision {

// A pixel of the band around a straight edge.
struct BandPixel {
  double u, v;  // px, along and across the edge
  double value;
};

// A blurred step: value = low + rise · Φ((v − a − b·u) / blur)
struct Step {
  double low, rise, blur, a, b;
};

struct FittedStep {
  Step step;
  Eigen::Matrix2d covariance;  // of a and b, for noise that is independent in each pixel
  // How many times larger the covariance is because video compression errs alike in neighbouring
  // pixels, as estimated from this edge alone: rough; take the mean over several edges.
  double clustering;
  double noise;  // grey levels, standard deviation of a pixel about the step
};

// The step that fits a band best, from a guess. `half_length` and `reach` (px) are the band's
// extent along and across. Nothing if there is no such step, or too much of the band is something
// else.
std::optional<FittedStep> FitStep(const std::vector<BandPixel>& band, const Step& guess,
                                  double half_length, double reach);

}  // namespace softforce::vision
