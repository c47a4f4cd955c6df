#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/chart.h"
#include "report/format.h"
#include "report/plots.h"

namespace softforce::report {
namespace {

using calibration::HoldOutView;
using calibration::PictureFit;
using calibration::ViewFit;

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr double kChartWidth = 940, kChartHeight = 210;

// A group of bars for each view, counted from 1.
class ViewBars {
 public:
  ViewBars(size_t views, int bars, const std::string& label, const std::string& y_label,
           double y_max)
      : chart_(kChartWidth, kChartHeight, label, y_label, y_max),
        group_(
            std::min(chart_.plot_width() / static_cast<double>(std::max<size_t>(views, 1)), 60.0)),
        bar_(0.8 * group_ / bars) {
    const size_t every = std::max<size_t>(1, static_cast<size_t>(RoundStep(22 / group_, 1)));
    for (size_t v = 0; v < views; ++v) {
      if (v % every != 0) continue;
      chart_.svg.Text(Left(v) + 0.4 * group_, chart_.bottom() + 14, std::to_string(v + 1),
                      "middle");
    }
    chart_.XLabel("view");
  }

  void Bar(size_t view, int place, double value, const std::string& css_class,
           const std::string& tooltip) {
    const double shown = std::min(value, chart_.y_max());
    chart_.svg.Rect(Left(view) + place * bar_, chart_.Y(shown), std::max(0.9 * bar_, 1.0),
                    chart_.bottom() - chart_.Y(shown), css_class, tooltip);
  }

  void Level(double value, const std::string& css_class) {
    chart_.svg.Line(chart_.left(), chart_.Y(value), chart_.left() + chart_.plot_width(),
                    chart_.Y(value), css_class);
  }

  std::string str() const { return chart_.svg.str(); }

 private:
  double Left(size_t view) const { return chart_.left() + 2 + group_ * static_cast<double>(view); }

  Chart chart_;
  double group_, bar_;
};

double Millimetres(double squared) { return 1e3 * std::sqrt(squared); }

}  // namespace

std::string PictureBars(const CalibrationRecord& record) {
  const std::vector<ViewFit>& views = record.result.views;
  double most = 0;  // of the pictures used: one that was left out may be far higher
  for (const ViewFit& view : views) {
    for (const PictureFit& picture : view.pictures) {
      if (!picture.left_out && std::isfinite(picture.rms_px)) most = std::max(most, picture.rms_px);
    }
  }
  ViewBars bars(views.size(), static_cast<int>(record.input.cameras.size()),
                "Reprojection error of every picture", "RMS, px", 1.15 * most);
  for (size_t v = 0; v < views.size(); ++v) {
    for (const PictureFit& picture : views[v].pictures) {
      if (!std::isfinite(picture.rms_px)) continue;
      const bool out = picture.left_out || !views[v].used;
      bars.Bar(v, picture.camera, picture.rms_px,
               (out ? "out " : "bar ") + HueClass(picture.camera),
               fmt::format("{}, {}: {} px, {}{}{}", views[v].name,
                           record.input.cameras[picture.camera].name, Short(picture.rms_px),
                           Count(picture.points, "point"),
                           picture.outliers > 0 ? ", " + Count(picture.outliers, "outlier") : "",
                           out ? ", left out" : ""));
    }
  }
  for (size_t c = 0; c < record.result.cameras.size(); ++c) {
    bars.Level(record.result.cameras[c].rms_px, "level " + HueClass(static_cast<int>(c)));
  }
  return bars.str();
}

std::string HoldOutBars(const CalibrationRecord& record) {
  const std::vector<HoldOutView>& views = record.result.hold_out.views;
  const bool metric = std::isfinite(record.result.hold_out.board_rms);
  const auto value = [&](const HoldOutView& view) {
    return metric ? Millimetres(view.squared_board) : std::sqrt(view.squared_px);
  };
  double most = 0;
  for (const HoldOutView& view : views) {
    if (std::isfinite(value(view))) most = std::max(most, value(view));
    if (metric && std::isfinite(view.squared_square)) {
      most = std::max(most, Millimetres(view.squared_square));
    }
  }
  const size_t count = record.input.views.size();
  ViewBars bars(count, metric ? 2 : 1, "Error of every held-out view",
                metric ? "RMS, mm" : "RMS, px", 1.1 * most);
  for (const HoldOutView& view : views) {
    const std::string name = record.input.views[view.view].name;
    if (!std::isfinite(value(view))) continue;
    bars.Bar(view.view, 0, value(view), "bar c0",
             fmt::format("{}: {} {}, {} px", name, Short(value(view)),
                         metric ? "mm from the board" : "px", Short(std::sqrt(view.squared_px))));
    if (metric) {
      bars.Bar(view.view, 1, Millimetres(view.squared_square), "bar c2",
               fmt::format("{}: {} mm between neighbours", name,
                           Short(Millimetres(view.squared_square))));
    }
  }
  return bars.str();
}

std::string PosePlot(const CalibrationRecord& record) {
  double distance = 0, tilt = 30 / kDegrees;
  for (const ViewFit& view : record.result.views) {
    for (const PictureFit& picture : view.pictures) {
      if (std::isfinite(picture.distance)) distance = std::max(distance, picture.distance);
      if (std::isfinite(picture.tilt)) tilt = std::max(tilt, picture.tilt);
    }
  }
  Chart chart(440, 250, "Distance and tilt of the board", "tilt, °", kDegrees * tilt);
  chart.XAxis("distance, m", 1.05 * distance);
  for (const ViewFit& view : record.result.views) {
    for (const PictureFit& picture : view.pictures) {
      if (!std::isfinite(picture.distance) || !std::isfinite(picture.tilt)) continue;
      chart.svg.Circle(chart.X(picture.distance), chart.Y(kDegrees * picture.tilt), 4,
                       "spot " + HueClass(picture.camera),
                       fmt::format("{}, {}: {:.3f} m, {:.0f}°", view.name,
                                   record.input.cameras[picture.camera].name, picture.distance,
                                   kDegrees * picture.tilt));
    }
  }
  return chart.svg.str();
}

}  // namespace softforce::report
