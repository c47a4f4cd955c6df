#include "calibration/fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "calibration/start.h"

namespace softforce::calibration {
namespace {

int DegreesOfFreedom(const std::vector<Sighting>& sightings, const Estimate& estimate) {
  std::set<int> views;
  int degrees = 0;
  for (const Sighting& sighting : sightings) {
    if (!sighting.used) continue;
    degrees += 2;
    views.insert(sighting.view);
  }
  degrees -= 6 * static_cast<int>(views.size() + estimate.lenses.size() - 1);
  for (size_t c = 0; c < estimate.lenses.size(); ++c) {
    degrees -= estimate.num_lens(static_cast<int>(c));
  }
  return estimate.fit_warp ? degrees - 2 : degrees;
}

// Whether anything changed.
bool Classify(const std::vector<double>& errors, double limit, std::vector<Sighting>* sightings) {
  std::map<std::pair<int, int>, std::pair<int, int>> beyond_of_picture;  // beyond, all
  for (size_t i = 0; i < errors.size(); ++i) {
    auto& [beyond, all] = beyond_of_picture[{(*sightings)[i].view, (*sightings)[i].camera}];
    beyond += errors[i] > limit ? 1 : 0;
    ++all;
  }
  bool changed = false;
  for (size_t i = 0; i < errors.size(); ++i) {
    Sighting& sighting = (*sightings)[i];
    const auto& [beyond, all] = beyond_of_picture[{sighting.view, sighting.camera}];
    const bool use = errors[i] <= limit && 2 * beyond <= all;
    changed = changed || use != sighting.used;
    sighting.used = use;
  }
  return changed;
}

std::vector<double> Errors(const BoardShape& board, const std::vector<Sighting>& sightings,
                           const Estimate& estimate) {
  std::vector<double> errors;
  for (const Sighting& sighting : sightings) {
    errors.push_back(WhitenedError(board, estimate, sighting));
  }
  return errors;
}

// A view that was left out as a whole kept the pose that it had then, perhaps a bad one: it gets
// another chance with the lenses as they are now.
void PlaceViewsLeftOut(const BoardShape& board, const std::vector<Sighting>& sightings,
                       Estimate* estimate) {
  using Picture = std::vector<const Sighting*>;
  std::map<int, std::map<int, Picture>> pictures_of_view;  // by camera
  std::set<int> used;
  for (const Sighting& sighting : sightings) {
    pictures_of_view[sighting.view][sighting.camera].push_back(&sighting);
    if (sighting.used) used.insert(sighting.view);
  }
  for (const auto& [view, pictures] : pictures_of_view) {
    if (used.count(view) > 0) continue;
    const auto& [camera, picture] = *std::max_element(
        pictures.begin(), pictures.end(),
        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    if (const auto T = PoseOfBoard(estimate->lenses[camera], board, picture)) {
      estimate->T_rig_board[view] = estimate->T_camera_rig[camera].inverse() * *T;
    }
  }
}

}  // namespace

double NoiseFactor(const BoardShape& board, const std::vector<Sighting>& sightings,
                   const Estimate& estimate) {
  double chi2 = 0;
  for (const Sighting& sighting : sightings) {
    const double error = sighting.used ? WhitenedError(board, estimate, sighting) : 0;
    chi2 += error * error;
  }
  const int degrees = DegreesOfFreedom(sightings, estimate);
  return degrees > 0 ? std::sqrt(chi2 / degrees) : NAN;
}

Fit FitWithoutOutliers(const BoardShape& board, double outlier_probability,
                       const AdjustOptions& options, std::vector<Sighting>* sightings,
                       Estimate* estimate) {
  Fit fit;
  // χ² of two degrees of freedom is exponentially distributed.
  const double limit = std::sqrt(-2 * std::log(outlier_probability));
  constexpr double kFloor = 1e-7;  // of the noise factor: data that have no noise at all
  double noise = std::max(kFloor, RobustNoise(board, *estimate, *sightings));
  Classify(Errors(board, *sightings, *estimate), limit * noise, sightings);
  for (int round = 0; round < 10; ++round) {
    fit.adjustment = Adjust(board, *sightings, options, estimate);
    if (!fit.adjustment.usable || fit.adjustment.stopped) return fit;
    noise = std::max(kFloor, NoiseFactor(board, *sightings, *estimate));
    if (!std::isfinite(noise)) break;
    PlaceViewsLeftOut(board, *sightings, estimate);
    if (!Classify(Errors(board, *sightings, *estimate), limit * noise, sightings)) break;
  }
  fit.noise_factor = NoiseFactor(board, *sightings, *estimate);
  for (double error : Errors(board, *sightings, *estimate)) {
    fit.sigmas.push_back(error / std::max(kFloor, fit.noise_factor));
  }
  return fit;
}

}  // namespace softforce::calibration
