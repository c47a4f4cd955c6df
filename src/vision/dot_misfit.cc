#include "vision/dot_misfit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace softforce::vision {
namespace {

constexpr int kSectors = 16;  // directions in which the shape is compared
constexpr int kDepths = 20;   // thirds of a pixel across the edge

struct EdgeMisfit {
  double value;   // coverage, seen less expected
  double noise2;  // its variance
  int sector;     // direction from the centre
  int depth;      // distance from the contour, in classes
};

std::vector<EdgeMisfit> EdgeMisfits(const Patch& patch, const Levels& levels,
                                    const Eigen::Vector2d& patch_centre,
                                    const BlurredEllipse& disc) {
  std::vector<EdgeMisfit> misfits;
  misfits.reserve(patch.edge.size());
  for (const PatchPixel* pixel : patch.edge) {
    const Eigen::Vector2d d = pixel->d + patch_centre - disc.ellipse.centre();
    const Ellipse::Place place = disc.ellipse.PlaceOf(d);
    // Blur pulls the half level of a curved edge inward.
    const double outside = place.outside + 0.5 * disc.blur * disc.blur * place.curvature;
    const double expected = ExpectedCoverage(outside, disc.blur);
    const double coverage = levels.Coverage(*pixel);
    const double contrast = levels.Contrast(pixel->d);
    misfits.push_back(
        {coverage - expected, levels.Noise(coverage) / (contrast * contrast),
         static_cast<int>(kSectors * disc.ellipse.SectorOf(d)) % kSectors,
         std::clamp(static_cast<int>(3 * place.outside) + kDepths / 2, 0, kDepths - 1)});
  }
  return misfits;
}

Misfit Summarize(const std::vector<EdgeMisfit>& edge, double area) {
  std::array<double, kSectors> excess{}, variance{};
  std::array<double, kDepths> profile{}, count{};
  for (const EdgeMisfit& pixel : edge) {
    // Blur moves light across the contour and cancels in the sum over a sector.
    excess[pixel.sector] += pixel.value;
    variance[pixel.sector] += pixel.noise2;
    profile[pixel.depth] += pixel.value;
    ++count[pixel.depth];
  }
  Misfit misfit{0, 0, 0};
  double classes = 0;
  for (int k = 0; k < kSectors; ++k) {
    misfit.area_share += std::max(0.0, std::abs(excess[k]) - 2 * std::sqrt(variance[k])) / area;
  }
  for (int k = 0; k < kDepths; ++k) {
    if (count[k] == 0) continue;
    profile[k] /= count[k];
    ++classes;
  }
  // What all directions share is the lens's blur, not quite as expected, and moves nothing.
  for (const EdgeMisfit& pixel : edge) {
    const double own = pixel.value - profile[pixel.depth];
    misfit.roughness += own * own / pixel.noise2;
  }
  const double freedom = std::max(1.0, static_cast<double>(edge.size()) - classes);
  misfit.roughness /= freedom;
  misfit.chance = std::sqrt(2 / freedom);
  return misfit;
}

}  // namespace

double ExpectedCoverage(double outside, double blur) {
  return 0.5 * std::erfc(outside / (blur * M_SQRT2));
}

Misfit MeasureMisfit(const Patch& patch, const Levels& levels, const Eigen::Vector2d& patch_centre,
                     const BlurredEllipse& disc, double area) {
  return Summarize(EdgeMisfits(patch, levels, patch_centre, disc), area);
}

}  // namespace softforce::vision
