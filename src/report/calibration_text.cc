#include <fmt/format.h>

#include <algorithm>

#include "report/figures.h"
#include "report/format.h"

namespace softforce::report {

using calibration::CalibratedValue;
using calibration::Calibration;

namespace {

// Many pictures fail alike; the page lists them all.
constexpr size_t kMostNamed = 5;

std::string CamerasTable(const CalibrationRecord& record) {
  const Calibration& result = record.result;
  if (result.cameras.empty()) return "";
  const bool has_uncertainty = !result.uncertainty.empty();
  std::string text = fmt::format("  {:<12} {:>8} {:>7} {:>8} {:>8}", "camera", "pictures", "points",
                                 "outliers", "RMS, px");
  if (has_uncertainty) {
    text += fmt::format("   uncertainty at {:.2f} m, px: centre, worst",
                        result.uncertainty[0].distance);
  }
  text += "\n";
  for (size_t c = 0; c < result.cameras.size(); ++c) {
    const calibration::CameraFit& fit = result.cameras[c];
    text += fmt::format("  {:<12} {:>8} {:>7} {:>8} {:>8}", record.input.cameras[c].name,
                        fit.pictures, fit.points, fit.outliers, Short(fit.rms_px));
    if (has_uncertainty) {
      const Centre uncertainty = UncertaintyOf(result.uncertainty[c]);
      text += fmt::format("   {}, {}", Short(uncertainty.value), Short(uncertainty.worst));
    }
    text += "\n";
  }
  return text;
}

std::string ValuesTable(const CalibrationRecord& record) {
  std::string text;
  int camera = -2;
  for (const CalibratedValue& value : record.result.values) {
    if (value.camera != camera) {
      camera = value.camera;
      text += fmt::format("  {:<14} {:>14} {:>12}\n",
                          camera < 0 ? "board" : record.input.cameras[camera].name, "", "sd");
    }
    const ValueText shown = TextOf(value);
    text +=
        fmt::format("    {:<13} {:>13} {:>12} {}\n", value.name, shown.value, shown.sd, shown.unit);
  }
  return text;
}

std::string BaselineLines(const CalibrationRecord& record) {
  std::string text;
  for (size_t c = 1; c < record.result.rig.cameras.size(); ++c) {
    const Baseline baseline = BaselineOf(record.result, static_cast<int>(c));
    const ValueText shown = TextOf(1e3 * baseline.distance, 1e3 * baseline.sd, "mm");
    text += fmt::format("  {} to {}: {} mm, sd {} mm\n", record.input.cameras[0].name,
                        record.input.cameras[c].name, shown.value, shown.sd);
  }
  return text;
}

std::string LeftOutLines(const CalibrationRecord& record) {
  if (record.left_out.empty()) return "";
  std::string text = fmt::format("\n  {} left out ({})\n",
                                 Count(static_cast<int>(record.left_out.size()), "picture"),
                                 LeftOutText(record.left_out));
  for (size_t i = 0; i < std::min(record.left_out.size(), kMostNamed); ++i) {
    const LeftOutPicture& picture = record.left_out[i];
    text += fmt::format("    {}: {}: {}\n", record.input.cameras[picture.camera].name, picture.name,
                        picture.why);
  }
  if (record.left_out.size() > kMostNamed) text += "    …\n";
  return text;
}

std::string AdviceLines(const Calibration& result) {
  if (result.advice.empty()) return "";
  std::string text = "\n  Advice\n";
  for (const calibration::Advice& advice : result.advice) {
    text += fmt::format("    {}\n      {}\n", advice.finding, advice.what_to_do);
  }
  return text;
}

}  // namespace

std::string BriefReport(const CalibrationRecord& record) {
  const Calibration& result = record.result;
  const int cameras = static_cast<int>(record.input.cameras.size());
  if (!result.ok()) {
    return fmt::format("Not usable ({}): {}", Name(result.status), result.reason);
  }
  std::string text = fmt::format(
      "{}: {}, {}, {:.3f} px RMS", result.advice.empty() ? "Usable" : "Usable, but read the advice",
      Count(cameras, "camera"), Count(ViewsUsed(result), "view"), result.rms_px);
  const std::string held_out = HoldOutText(result.hold_out);
  if (!held_out.empty()) text += "; held-out views " + held_out;
  return text;
}

std::string FullReport(const CalibrationRecord& record) {
  const Calibration& result = record.result;
  std::string text = BriefReport(record) + "\n";
  if (!result.what_to_do.empty()) text += "  " + result.what_to_do + "\n";
  text += "\n  Board: " + record.board.Text() + "\n\n" + CamerasTable(record);
  if (result.ok()) text += "\n" + ValuesTable(record) + BaselineLines(record);
  return text + LeftOutLines(record) + AdviceLines(result);
}

}  // namespace softforce::report
