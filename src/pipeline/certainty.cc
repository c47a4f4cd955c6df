#include "pipeline/certainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace softforce::pipeline {
namespace {

constexpr double kShare = 0.9;  // of the picture that must be certain
// Of cameras whose model is chosen in the end, by held-out views.
constexpr auto kUsualLens = calibration::LensFit::kBrownConrady5;

// A place where a lens of Brown and Conrady has folded over is not certain at all; beyond the
// circle of a fisheye there is nothing to see.
Certainty OfCamera(const calibration::ProjectionUncertainty& map, const camera::Lens& lens) {
  Certainty certainty;
  std::vector<double> sds;
  for (Eigen::Index r = 0; r < map.sd_px.rows(); ++r) {
    for (Eigen::Index c = 0; c < map.sd_px.cols(); ++c) {
      double sd = map.sd_px(r, c);
      if (std::isnan(sd) && lens.model == camera::LensModel::kKannalaBrandt) continue;
      if (std::isnan(sd)) sd = std::numeric_limits<double>::infinity();
      if (sds.empty() || sd > *std::max_element(sds.begin(), sds.end())) {
        certainty.worst = {map.x[c], map.y[r]};
      }
      sds.push_back(sd);
    }
  }
  if (sds.empty()) return certainty;
  const auto at = sds.begin() + std::lround(kShare * static_cast<double>(sds.size() - 1));
  std::nth_element(sds.begin(), at, sds.end());
  certainty.known = true;
  certainty.sd_px = *at;
  certainty.distance = map.distance;
  return certainty;
}

}  // namespace

std::string Certainty::Text(const calibration::CalibrationInput& input) const {
  if (!known) return reason;
  return fmt::format(
      "{}: the projection is uncertain by {:.2f} px (nine tenths of the picture, {:.2f} m away)",
      input.cameras[camera].name, sd_px, distance);
}

Certainty CertaintyOf(const calibration::Calibration& calibration) {
  Certainty least;
  least.reason = calibration.reason;
  if (!calibration.ok()) return least;
  for (size_t c = 0; c < calibration.uncertainty.size(); ++c) {
    Certainty certainty = OfCamera(calibration.uncertainty[c], calibration.rig.cameras[c].lens);
    certainty.camera = static_cast<int>(c);
    if (!least.known || certainty.sd_px > least.sd_px) least = certainty;
  }
  return least;
}

CertaintyWatch::CertaintyWatch(const CalibrateOptions& options) : options_(options) {
  options_.calibration.max_folds = 0;
  options_.calibration.on_progress = nullptr;
}

const Certainty& CertaintyWatch::Of(const calibration::CalibrationInput& input) {
  const int views = static_cast<int>(input.views.size());
  if (views < next_) return last_;
  next_ = views + std::max(1, views / 8);
  calibration::CalibrationInput with_lens = input;
  for (auto& camera : with_lens.cameras) camera.lens = camera.lens.value_or(kUsualLens);
  last_ = CertaintyOf(calibration::Calibrate(with_lens, options_.calibration));
  return last_;
}

}  // namespace softforce::pipeline
