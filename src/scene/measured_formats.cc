#include "scene/measured_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/spelling.h"
#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"

namespace softforce::scene {
namespace {

using base::InputError;

// "Unlabeled 1023" of Motive, or no name at all.
bool IsWithoutLabel(const std::string& label) {
  const std::string small = base::LowerCase(label);
  return small.empty() || small.rfind("unlabeled", 0) == 0 || small.rfind("unlabelled", 0) == 0;
}

std::string WithoutAsset(const std::string& label) {
  const size_t colon = label.rfind(':');
  return colon == std::string::npos ? label : base::Trimmed(label.substr(colon + 1));
}

}  // namespace

PointLabels::PointLabels(const Measured& measured, const Markers& markers) : measured_(measured) {
  for (const MarkerPoint& point : markers.points) labels_.push_back(point.label);
}

PointLabels::Meaning PointLabels::Of(const std::string& label, const std::string& where) const {
  if (std::count(measured_.ignore.begin(), measured_.ignore.end(), label) > 0) return {false, -1};
  if (!measured_.labels || IsWithoutLabel(label)) return {};
  for (const std::string& name : {label, WithoutAsset(label)}) {
    const auto found = std::find(labels_.begin(), labels_.end(), name);
    if (found != labels_.end()) return {true, static_cast<int>(found - labels_.begin())};
  }
  const std::string guess = DidYouMean(WithoutAsset(label), labels_);
  throw InputError(
      where, fmt::format("got a point called \"{}\", expected {}", label, Join(labels_)),
      guess + (guess.empty() ? "" : " ") +
          "Give a marker of the scene this \"label\", list it under \"measured: ignore\", or set "
          "\"measured: labels\" to false.");
}

void FrameCollector::Begin(int frame, double time_s, const std::string& where) {
  if (!frames_.empty() && !(time_s > frames_.back().time_s)) {
    throw InputError(where, fmt::format("got the time {} s after {} s, expected ascending times",
                                        time_s, frames_.back().time_s));
  }
  if (!frames_.empty() && frame <= frames_.back().frame) {
    throw InputError(where, fmt::format("got the frame {} after {}, expected ascending numbers",
                                        frame, frames_.back().frame));
  }
  frames_.push_back({frame, time_s, {}});
}

void FrameCollector::Add(const MeasuredPoint& point, const std::string& label,
                         const std::string& where) {
  std::vector<MeasuredPoint>& points = frames_.back().points;
  const bool twice = point.marker >= 0 &&
                     std::any_of(points.begin(), points.end(), [&](const MeasuredPoint& other) {
                       return other.marker == point.marker;
                     });
  if (twice) {
    throw InputError(where, fmt::format("got the point \"{}\" twice at {} s, expected once", label,
                                        frames_.back().time_s));
  }
  points.push_back(point);
}

std::optional<Eigen::Vector3d> ReadCoordinates(const CsvLine& line,
                                               const std::array<size_t, 3>& columns,
                                               double metres_per_unit, const std::string& label,
                                               const std::string& file) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  const auto is_empty = [&](size_t column) {
    const std::string cell = base::LowerCase(line.cells[column]);
    return cell.empty() || cell == "nan";
  };
  const auto empty = std::count_if(columns.begin(), columns.end(), is_empty);
  if (empty == 3) return std::nullopt;
  if (empty > 0) {
    throw InputError(fmt::format("{}:{}", file, line.number),
                     fmt::format("got {} of the three coordinates of the point \"{}\", expected "
                                 "all, or none for a point that was not seen",
                                 3 - empty, label));
  }
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) {
    p(i) = metres_per_unit *
           ReadNumber(line, columns[i], fmt::format("{}\" of \"{}", kAxes[i], label), file);
  }
  return p;
}

double ReadNumber(const CsvLine& line, size_t column, const std::string& name,
                  const std::string& file) {
  return base::ParseQuantity(line.cells[column], base::Dimension::kNumber, 1,
                             fmt::format("{}:{}: column \"{}\"", file, line.number, name))[0];
}

int ReadFrameNumber(const CsvLine& line, size_t column, const std::string& file) {
  const double number = ReadNumber(line, column, "frame", file);
  if (number >= 0 && number < 2e9 && number == std::floor(number)) return static_cast<int>(number);
  throw InputError(fmt::format("{}:{}: column \"frame\"", file, line.number),
                   fmt::format("got {}, expected a whole number from 0 on", number));
}

void CheckCells(const CsvLine& line, const CsvLine& header, const std::string& file) {
  if (line.cells.size() == header.cells.size()) return;
  throw InputError(fmt::format("{}:{}", file, line.number),
                   fmt::format("got {} cells, expected {} as in the header", line.cells.size(),
                               header.cells.size()),
                   "The file may have been cut short.");
}

MeasuredPoints ReadMeasuredPoints(const Measured& measured, const Markers& markers) {
  const std::vector<CsvLine> lines = ReadCsvLines(measured.file);
  MeasuredPoints points = IsMotiveExport(lines) ? ReadMotiveExport(lines, measured, markers)
                                                : ReadPointTable(lines, measured, markers);
  if (points.frames.empty()) {
    throw InputError(measured.file.string(), "got no frames, expected at least one row of points");
  }
  return points;
}

}  // namespace softforce::scene
