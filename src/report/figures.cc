#include "report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/format.h"

namespace softforce::report {

using calibration::Calibration;

Centre UncertaintyOf(const calibration::ProjectionUncertainty& uncertainty) {
  Centre centre;
  const Eigen::MatrixXd& sd = uncertainty.sd_px;
  if (sd.size() == 0) return centre;
  centre.value = sd(sd.rows() / 2, sd.cols() / 2);
  for (Eigen::Index i = 0; i < sd.size(); ++i) {
    const double value = sd.data()[i];
    if (std::isfinite(value) && !(centre.worst >= value)) centre.worst = value;
  }
  return centre;
}

Baseline BaselineOf(const Calibration& result, int camera) {
  const Eigen::Isometry3d T =
      result.rig.cameras[camera].T_camera_rig * result.rig.cameras[0].T_camera_rig.inverse();
  Baseline baseline{T.translation().norm(), NAN};
  std::vector<Eigen::Index> places;  // of its translation among the values
  for (size_t i = 0; i < result.values.size(); ++i) {
    const calibration::CalibratedValue& value = result.values[i];
    const bool translation = value.kind == calibration::CalibratedValue::Kind::kTranslation;
    if (translation && value.camera == camera) places.push_back(static_cast<Eigen::Index>(i));
  }
  if (places.size() == 3 && result.covariance.rows() > places[2]) {
    const Eigen::Vector3d along = T.translation().normalized();
    const Eigen::Matrix3d covariance = result.covariance(places, places);
    baseline.sd = std::sqrt(along.dot(covariance * along));
  }
  return baseline;
}

int ViewsUsed(const Calibration& result) {
  return static_cast<int>(std::count_if(result.views.begin(), result.views.end(),
                                        [](const auto& view) { return view.used; }));
}

Verdict VerdictOf(const Calibration& result) {
  if (!result.ok()) return Verdict::kNotUsable;
  return result.advice.empty() ? Verdict::kGood : Verdict::kAdvice;
}

const char* Text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return "usable";
    case Verdict::kAdvice:
      return "usable, but read the advice";
    case Verdict::kNotUsable:
      return "not usable";
  }
  return "";
}

std::string HoldOutText(const calibration::HoldOut& hold_out) {
  if (hold_out.folds == 0) return "";
  std::string text = Short(hold_out.rms_px) + " px";
  if (std::isfinite(hold_out.square_rms)) {
    text += fmt::format(", {} mm between neighbouring points, {} mm from the board",
                        Short(1e3 * hold_out.square_rms), Short(1e3 * hold_out.board_rms));
  }
  return text;
}

std::string LeftOutText(const std::vector<LeftOutPicture>& pictures) {
  std::map<std::string, int> counts;
  for (const LeftOutPicture& picture : pictures) ++counts[picture.why];
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [why, count] : sorted) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", why, count);
  }
  return text;
}

}  // namespace softforce::report
