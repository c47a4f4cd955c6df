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
  // pixels, as estimated from this edge alone: rough; take the mean over several edges. Its own
  // standard deviation is sqrt(2 / pieces) of it.
  double clustering;
  int pieces;
  // Variance of the pixels that tell the edge's place over that of all of the band, more than 1
  // where something roughens edges; and of how many pixels that is.
  double roughness, rough_pixels;
  double noise;  // grey levels, standard deviation of a pixel about the step
};

// What is known of an edge's blur before one looks, px: in a narrow band the picture says little.
struct BlurPrior {
  double mean = 0.75, spread = 0.25;  // as lenses do
};

// The step that fits a band best, from a guess. `half_length` and `reach` (px) are the band's
// extent along and across. Nothing if there is no such step, or too much of the band is something
// else.
std::optional<FittedStep> FitStep(const std::vector<BandPixel>& band, const Step& guess,
                                  double half_length, double reach, const BlurPrior& blur = {});

}  // namespace softforce::vision
