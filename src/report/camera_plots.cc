#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/format.h"
#include "report/plots.h"
#include "report/svg.h"

namespace softforce::report {
namespace {

using calibration::CameraToCalibrate;
using calibration::PointResidual;

constexpr double kWidth = 440;  // of a picture's plot
constexpr double kKey = 26;     // below it, for the key

// A drawing of a camera's picture.
struct PictureFrame {
  PictureFrame(const CameraToCalibrate& camera, const std::string& label)
      : scale(kWidth / camera.width),
        height(camera.height * scale),
        svg(kWidth, height + kKey, label) {}

  // Pixel (0, 0) is the centre of the top left pixel.
  double X(double pixel) const { return (pixel + 0.5) * scale; }
  double Y(double pixel) const { return (pixel + 0.5) * scale; }
  double key_y() const { return height + 17; }

  double scale, height;
  Svg svg;
};

void DrawCells(const Eigen::MatrixXi& counts, PictureFrame& frame) {
  const double width = kWidth / static_cast<double>(counts.cols());
  const double height = frame.height / static_cast<double>(counts.rows());
  const double most = std::max(1, counts.size() == 0 ? 0 : counts.maxCoeff());
  for (Eigen::Index row = 0; row < counts.rows(); ++row) {
    for (Eigen::Index col = 0; col < counts.cols(); ++col) {
      const int count = counts(row, col);
      const double x = static_cast<double>(col) * width, y = static_cast<double>(row) * height;
      const int lightness = 97 - static_cast<int>(30 * std::sqrt(count / most));
      frame.svg.Rect(x, y, width, height, count == 0 ? "empty" : "cell", Count(count, "point"),
                     count == 0 ? "" : fmt::format("hsl(210,70%,{}%)", lightness));
    }
  }
}

// Where the cells around the places of a grid end, in drawing units: halfway to the next one.
std::vector<double> CellEdges(const std::vector<double>& pixels, double scale, double end) {
  std::vector<double> edges = {0};
  for (size_t i = 1; i < pixels.size(); ++i) {
    edges.push_back(scale * ((pixels[i - 1] + pixels[i]) / 2 + 0.5));
  }
  edges.push_back(end);
  return edges;
}

// Some seven of a grid's places in a row, the middle one among them: where numbers have room.
std::vector<Eigen::Index> Labelled(Eigen::Index count) {
  const Eigen::Index step = std::max<Eigen::Index>(1, (count - 1) / 6);
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = (count / 2) % step; i < count; i += step) places.push_back(i);
  return places;
}

void DrawHeatKey(double lowest, double highest, double distance, PictureFrame& frame) {
  for (int i = 0; i < 60; ++i) {
    frame.svg.Rect(70 + 2 * i, frame.key_y() - 10, 2.5, 12, "heat", "", HeatColour(i / 59.0));
  }
  frame.svg.Text(64, frame.key_y(), Short(lowest) + " px", "end");
  frame.svg.Text(196, frame.key_y(), fmt::format("{} px, at {:.2f} m", Short(highest), distance));
}

}  // namespace

std::string CoveragePlot(const CalibrationRecord& record, int camera) {
  PictureFrame frame(record.input.cameras[camera], "Where the board was seen");
  if (camera < static_cast<int>(record.result.cameras.size())) {
    DrawCells(record.result.cameras[camera].coverage, frame);
  }
  std::string dots;
  for (const calibration::CalibrationView& view : record.input.views) {
    for (const Eigen::Vector2d& pixel : view.seen[camera].pixels) {
      dots +=
          Stroke(frame.X(pixel.x()), frame.Y(pixel.y()), frame.X(pixel.x()), frame.Y(pixel.y()));
    }
  }
  frame.svg.Path(dots, "dots " + HueClass(camera));
  frame.svg.Rect(0, 0, kWidth, frame.height, "frame");
  frame.svg.Rect(0, frame.key_y() - 9, 14, 10, "empty");
  frame.svg.Text(20, frame.key_y(), "no point here; darker blue: more points");
  return frame.svg.str();
}

std::string ResidualPlot(const CalibrationRecord& record, int camera) {
  const double rms = record.result.cameras[camera].rms_px;
  PictureFrame frame(record.input.cameras[camera], "Reprojection errors as arrows");
  frame.svg.Rect(0, 0, kWidth, frame.height, "paper");
  const double key_px = RoundStep(3 * rms, 1);     // px, length that the key shows
  const double magnified = 0.1 * kWidth / key_px;  // drawing units per px of error
  std::string small, large, crosses;
  for (const PointResidual& point : record.result.residuals) {
    if (point.camera != camera) continue;
    const double x = frame.X(point.pixel.x()), y = frame.Y(point.pixel.y());
    if (point.outlier) {
      crosses += Stroke(x - 3, y - 3, x + 3, y + 3) + Stroke(x - 3, y + 3, x + 3, y - 3);
    } else if (point.error.allFinite()) {
      std::string& strokes = point.error.norm() > 2 * rms ? large : small;
      strokes += Stroke(x, y, x + magnified * point.error.x(), y + magnified * point.error.y());
    }
  }
  frame.svg.Path(small, "arrows " + HueClass(camera));
  frame.svg.Path(large, "arrows large");
  frame.svg.Path(crosses, "arrows outlier");
  frame.svg.Rect(0, 0, kWidth, frame.height, "frame");
  frame.svg.Path(Stroke(2, frame.key_y() - 4, 2 + 0.1 * kWidth, frame.key_y() - 4), "scale");
  frame.svg.Text(0.1 * kWidth + 10, frame.key_y(),
                 fmt::format("{} px; red: longer than twice the RMS; cross: outlier, left out",
                             Short(key_px)));
  return frame.svg.str();
}

std::string UncertaintyPlot(const CalibrationRecord& record, int camera, double lowest,
                            double highest) {
  const calibration::ProjectionUncertainty& map = record.result.uncertainty[camera];
  PictureFrame frame(record.input.cameras[camera], "Projection uncertainty over the picture");
  const std::vector<double> xs = CellEdges(map.x, frame.scale, kWidth);
  const std::vector<double> ys = CellEdges(map.y, frame.scale, frame.height);
  const auto share = [&](double sd) { return std::log(sd / lowest) / std::log(highest / lowest); };
  for (Eigen::Index row = 0; row < map.sd_px.rows(); ++row) {
    for (Eigen::Index col = 0; col < map.sd_px.cols(); ++col) {
      const double sd = map.sd_px(row, col);
      const bool known = std::isfinite(sd);
      // Half a unit larger, so that no gaps shine through.
      frame.svg.Rect(
          xs[col], ys[row], xs[col + 1] - xs[col] + 0.5, ys[row + 1] - ys[row] + 0.5,
          known ? "heat" : "empty",
          fmt::format("pixel ({:.0f}, {:.0f}): {} px", map.x[col], map.y[row], Short(sd)),
          known ? HeatColour(share(sd)) : "");
    }
  }
  for (const Eigen::Index row : Labelled(map.sd_px.rows())) {
    for (const Eigen::Index col : Labelled(map.sd_px.cols())) {
      const double sd = map.sd_px(row, col);
      if (!std::isfinite(sd)) continue;
      frame.svg.Text(std::clamp(frame.X(map.x[col]), 18.0, kWidth - 18),
                     std::clamp(frame.Y(map.y[row]) + 4, 11.0, frame.height - 3),
                     fmt::format("{:.2g}", sd), "middle",
                     share(sd) > 0.6 ? "number dark" : "number light");
    }
  }
  frame.svg.Rect(0, 0, kWidth, frame.height, "frame");
  DrawHeatKey(lowest, highest, map.distance, frame);
  return frame.svg.str();
}

}  // namespace softforce::report
