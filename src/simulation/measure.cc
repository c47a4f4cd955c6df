#include "softforce/simulation/measure.h"

#include <algorithm>
#include <random>
#include <string>

#include "softforce/base/input_error.h"

namespace softforce::simulation {
namespace {

bool Lost(int marker, double time_s, const std::vector<Dropout>& dropouts) {
  return std::any_of(dropouts.begin(), dropouts.end(), [&](const Dropout& dropout) {
    if (time_s < dropout.from_s || time_s >= dropout.until_s) return false;
    const std::vector<int>& markers = dropout.markers;
    return markers.empty() || std::find(markers.begin(), markers.end(), marker) != markers.end();
  });
}

}  // namespace

void MeasureOptions::Check() const {
  if (!(noise >= 0 && noise <= 1)) {
    throw base::InputError("simulated markers: noise", "must lie between 0 and 1 m");
  }
  if (!(hidden_share >= 0 && hidden_share <= 1)) {
    throw base::InputError("simulated markers: hidden", "must lie between 0 and 1");
  }
  for (const Dropout& dropout : dropouts) {
    if (dropout.from_s < dropout.until_s) continue;
    throw base::InputError("simulated markers: dropouts", "must end after they begin");
  }
}

std::vector<std::optional<Eigen::Vector3d>> MeasureMarkers(
    const std::vector<Eigen::Vector3d>& places, int frame, double time_s,
    const MeasureOptions& options, std::uint32_t seed) {
  std::seed_seq mixed{seed, static_cast<std::uint32_t>(frame)};
  std::mt19937_64 random(mixed);
  std::vector<std::optional<Eigen::Vector3d>> measured;
  for (const Eigen::Vector3d& place : places) {
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> uniform(0, 1);
    Eigen::Vector3d noise;
    for (double& component : noise) component = options.noise * normal(random);
    const bool hidden = uniform(random) < options.hidden_share ||
                        Lost(static_cast<int>(measured.size()), time_s, options.dropouts);
    measured.push_back(hidden ? std::nullopt : std::optional<Eigen::Vector3d>(place + noise));
  }
  return measured;
}

}  // namespace softforce::simulation
