#include "report/page_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "report/figures.h"
#include "report/format.h"
#include "report/table.h"

namespace softforce::report {
namespace {

using calibration::CalibratedValue;
using calibration::PictureFit;
using calibration::PointResidual;
using calibration::ViewFit;

constexpr double kDegrees = 180 / 3.14159265358979323846;

}  // namespace

std::string CamerasTable(const CalibrationRecord& record) {
  const calibration::Calibration& result = record.result;
  Table table({"camera", "lens", "size, px", "pictures", "points", "outliers", "RMS, px",
               "uncertainty, centre, px", "worst, px"},
              2);
  for (size_t c = 0; c < result.cameras.size(); ++c) {
    const calibration::CameraToCalibrate& camera = record.input.cameras[c];
    const calibration::CameraFit& fit = result.cameras[c];
    const Centre uncertainty =
        c < result.uncertainty.size() ? UncertaintyOf(result.uncertainty[c]) : Centre{};
    table.Add({camera.name, c < result.lenses.size() ? Name(result.lenses[c]) : "–",
               fmt::format("{} × {}", camera.width, camera.height), std::to_string(fit.pictures),
               std::to_string(fit.points), std::to_string(fit.outliers), Short(fit.rms_px),
               Short(uncertainty.value), Short(uncertainty.worst)});
  }
  return table.str();
}

std::string ValuesTable(const CalibrationRecord& record, int camera) {
  Table table({"parameter", "value", "sd", ""}, 1);
  for (const CalibratedValue& value : record.result.values) {
    if (value.camera != camera) continue;
    const ValueText shown = TextOf(value);
    table.Add({value.name, shown.value, shown.sd, shown.unit});
  }
  if (camera > 0) {
    const Baseline baseline = BaselineOf(record.result, camera);
    const ValueText shown = TextOf(1e3 * baseline.distance, 1e3 * baseline.sd, "mm");
    table.Add({"distance to " + record.input.cameras[0].name, shown.value, shown.sd, shown.unit});
  }
  return table.str();
}

std::string TrialsTable(const CalibrationRecord& record) {
  Table table({"lens model", "RMS, px", "held-out, px"}, 1);
  for (const calibration::LensTrial& trial : record.result.trials) {
    table.Add(
        {Name(trial.lens), trial.ok ? Short(trial.rms_px) : "failed", Short(trial.hold_out_px)});
  }
  return table.str();
}

std::string OutliersTable(const CalibrationRecord& record) {
  Table table({"camera", "view", "point", "x, px", "y, px", "error, px", "standard deviations"}, 2);
  for (const PointResidual& point : record.result.residuals) {
    if (!point.outlier) continue;
    table.Add({record.input.cameras[point.camera].name, record.input.views[point.view].name,
               std::to_string(point.id), fmt::format("{:.1f}", point.pixel.x()),
               fmt::format("{:.1f}", point.pixel.y()), Short(point.error.norm()),
               Short(point.sigmas)});
  }
  return table.str();
}

std::string LeftOutTable(const CalibrationRecord& record) {
  Table table({"camera", "picture", "why"}, 3);
  for (const LeftOutPicture& picture : record.left_out) {
    table.Add({record.input.cameras[picture.camera].name, picture.name, picture.why});
  }
  return table.str();
}

std::string ViewsTable(const CalibrationRecord& record) {
  Table table({"no.", "view", "camera", "points", "outliers", "RMS, px", "distance, m", "tilt, °"},
              3);
  for (size_t v = 0; v < record.result.views.size(); ++v) {
    const ViewFit& view = record.result.views[v];
    for (const PictureFit& picture : view.pictures) {
      const bool out = picture.left_out || !view.used;
      table.Add({std::to_string(v + 1), view.name,
                 record.input.cameras[picture.camera].name + (out ? " (left out)" : ""),
                 std::to_string(picture.points), std::to_string(picture.outliers),
                 Short(picture.rms_px), Short(picture.distance), Short(kDegrees * picture.tilt)});
    }
  }
  return table.str();
}

}  // namespace softforce::report
