// Plain tables of points, with a row for every point or for every frame.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/measured_formats.h"
#include "scene/spelling.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"

namespace softforce::scene {
namespace {

using base::InputError;

constexpr char kExamples[] =
    "The header is time_s,marker,x_mm,y_mm,z_mm with a row for every point, or "
    "time_s,LABEL_x_mm,LABEL_y_mm,LABEL_z_mm,… with a row for every frame.";
constexpr size_t kNowhere = static_cast<size_t>(-1);

// A column of lengths: "0_x_mm" is the axis x of the point 0, in millimetres.
struct LengthColumn {
  std::string label;  // "0"; empty in a table with a row for every point
  std::string axis;   // "x", "y", "z" or "sd"
  double metres_per_unit = NAN;
};

struct Columns {
  size_t time = kNowhere, frame = kNowhere, marker = kNowhere;
  struct Point {
    std::string label;
    PointLabels::Meaning meaning;
    std::array<size_t, 3> columns{kNowhere, kNowhere, kNowhere};
    size_t sd = kNowhere;
    double metres_per_unit = NAN, sd_in_metres = NAN;
  };
  std::vector<Point> points;  // one without a label if every row is a point
};

class TableReader {
 public:
  TableReader(const std::vector<CsvLine>& lines, const Measured& measured, const Markers& markers)
      : lines_(lines),
        measured_(measured),
        labels_(measured, markers),
        file_(measured.file.string()) {}

  MeasuredPoints Read() {
    if (lines_.size() < 2) {
      throw InputError(file_, "got no points, expected a header line and at least one row",
                       kExamples);
    }
    FindColumns();
    for (size_t l = 1; l < lines_.size(); ++l) {
      CheckCells(lines_[l], lines_[0], file_);
      ReadRow(lines_[l]);
    }
    return {"table", collector_.frames()};
  }

 private:
  std::string Where(const CsvLine& line) const { return fmt::format("{}:{}", file_, line.number); }

  std::string WhereColumn(const std::string& name) const {
    return fmt::format("{}: column \"{}\"", Where(lines_[0]), name);
  }

  void FindColumns() {
    const std::vector<std::string>& header = lines_[0].cells;
    for (size_t c = 0; c < header.size(); ++c) {
      const std::string& name = header[c];
      if (std::count(header.begin(), header.end(), name) > 1) {
        throw InputError(WhereColumn(name), "the column is given twice, expected once");
      }
      if (name == "time_s" || name == "t_s" || name == "t") {
        columns_.time = c;
      } else if (name == "frame") {
        columns_.frame = c;
      } else if (name == "marker") {
        columns_.marker = c;
      } else {
        AddLength(ParseLength(name), c);
      }
    }
    CheckTime();
    CheckPoints();
  }

  // Axis and unit from the end of a column's name.
  LengthColumn ParseLength(const std::string& name) const {
    std::string stem = name;
    LengthColumn column;
    column.metres_per_unit = measured_.metres_per_unit.value_or(NAN);
    for (const auto& [suffix, unit] :
         {std::pair{"_mm", 1e-3}, std::pair{"_cm", 1e-2}, std::pair{"_m", 1.0}}) {
      const std::string text = suffix;
      if (stem.size() <= text.size() || stem.substr(stem.size() - text.size()) != text) continue;
      stem.erase(stem.size() - text.size());
      if (measured_.metres_per_unit && std::abs(*measured_.metres_per_unit / unit - 1) > 1e-9) {
        throw InputError(WhereColumn(name),
                         fmt::format("the column is in {}, but the scene says \"unit\" {} m",
                                     text.substr(1), *measured_.metres_per_unit),
                         "Leave out \"measured: unit\", or the unit in the columns' names.");
      }
      column.metres_per_unit = unit;
      break;
    }
    const size_t underscore = stem.rfind('_');
    column.axis = underscore == std::string::npos ? stem : stem.substr(underscore + 1);
    if (underscore != std::string::npos) column.label = stem.substr(0, underscore);
    const bool known = column.axis == "x" || column.axis == "y" || column.axis == "z" ||
                       (column.axis == "sd" && column.label.empty());
    if (!known) {
      throw InputError(WhereColumn(name),
                       "unknown column, expected time_s, frame, marker, or a coordinate as x_mm or "
                       "LABEL_x_mm",
                       kExamples);
    }
    if (!std::isfinite(column.metres_per_unit)) {
      throw InputError(WhereColumn(name), "got a length without unit, expected x_mm, x_cm or x_m",
                       "Put the unit into the columns' names, or write \"measured: unit\" in the "
                       "scene.");
    }
    return column;
  }

  void AddLength(const LengthColumn& length, size_t c) {
    auto point = std::find_if(columns_.points.begin(), columns_.points.end(),
                              [&](const auto& other) { return other.label == length.label; });
    if (point == columns_.points.end()) {
      columns_.points.emplace_back();
      point = columns_.points.end() - 1;
      point->label = length.label;
      point->meaning = labels_.Of(length.label, WhereColumn(lines_[0].cells[c]));
    }
    if (length.axis == "sd") {
      point->sd = c;
      point->sd_in_metres = length.metres_per_unit;
      return;
    }
    size_t& place = point->columns[static_cast<size_t>(length.axis[0] - 'x')];
    const bool other_unit =
        std::isfinite(point->metres_per_unit) && point->metres_per_unit != length.metres_per_unit;
    if (place != kNowhere || other_unit) {
      throw InputError(WhereColumn(lines_[0].cells[c]),
                       other_unit ? "the axes of a point have different units, expected one"
                                  : "the coordinate is given twice, expected once");
    }
    place = c;
    point->metres_per_unit = length.metres_per_unit;
  }

  void CheckTime() const {
    if (columns_.time != kNowhere || (columns_.frame != kNowhere && measured_.rate)) return;
    throw InputError(
        Where(lines_[0]),
        columns_.frame == kNowhere
            ? fmt::format("got the columns {}; expected also \"time_s\"", Join(lines_[0].cells))
            : "got frames without times, expected also \"time_s\", or the frames' rate "
              "in the scene",
        columns_.frame == kNowhere
            ? kExamples
            : "Write for example: measured: {file: points.csv, rate: 100 Hz}");
  }

  void CheckPoints() const {
    for (const Columns::Point& point : columns_.points) {
      for (int i = 0; i < 3; ++i) {
        if (point.columns[i] != kNowhere) continue;
        throw InputError(Where(lines_[0]),
                         fmt::format("got no column for {} of {}", "xyz"[i],
                                     point.label.empty() ? std::string("the points")
                                                         : "\"" + point.label + "\""),
                         kExamples);
      }
    }
    const bool mixed = (IsLong() || columns_.marker != kNowhere) && columns_.points.size() > 1;
    if (!columns_.points.empty() && !mixed) return;
    throw InputError(Where(lines_[0]),
                     mixed ? "got columns of points with and without labels, expected either"
                           : "got no coordinates",
                     kExamples);
  }

  // Whether every row is a point.
  bool IsLong() const {
    return std::any_of(columns_.points.begin(), columns_.points.end(),
                       [](const Columns::Point& point) { return point.label.empty(); });
  }

  void BeginFrame(const CsvLine& line) {
    const bool has_frame = columns_.frame != kNowhere;
    const int frame = has_frame ? ReadFrameNumber(line, columns_.frame, file_) : -1;
    const double time_s =
        columns_.time != kNowhere
            ? ReadNumber(line, columns_.time, lines_[0].cells[columns_.time], file_)
            : frame / *measured_.rate;
    const std::vector<MeasuredFrame>& frames = collector_.frames();
    const bool same_time = !frames.empty() && frames.back().time_s == time_s;
    if (IsLong() && same_time && (!has_frame || frames.back().frame == frame)) return;
    collector_.Begin(has_frame ? frame : static_cast<int>(frames.size()), time_s, Where(line));
  }

  void ReadRow(const CsvLine& line) {
    BeginFrame(line);
    for (const Columns::Point& point : columns_.points) {
      const std::string label =
          columns_.marker == kNowhere ? point.label : line.cells[columns_.marker];
      const PointLabels::Meaning meaning =
          columns_.marker == kNowhere ? point.meaning
                                      : labels_.Of(label, Where(line) + ": column \"marker\"");
      if (!meaning.used) continue;
      const auto p = ReadCoordinates(line, point.columns, point.metres_per_unit, label, file_);
      if (p) collector_.Add({*p, Sd(line, point), meaning.marker}, label, Where(line));
    }
  }

  double Sd(const CsvLine& line, const Columns::Point& point) const {
    if (point.sd == kNowhere || line.cells[point.sd].empty()) return measured_.noise;
    const double sd = point.sd_in_metres * ReadNumber(line, point.sd, "sd", file_);
    if (sd >= 0) return sd;
    throw InputError(Where(line) + ": column \"sd\"",
                     fmt::format("got {}, expected 0 or more", line.cells[point.sd]));
  }

  const std::vector<CsvLine>& lines_;
  const Measured& measured_;
  const PointLabels labels_;
  const std::string file_;
  Columns columns_;
  FrameCollector collector_;
};

}  // namespace

MeasuredPoints ReadPointTable(const std::vector<CsvLine>& lines, const Measured& measured,
                              const Markers& markers) {
  return TableReader(lines, measured, markers).Read();
}

}  // namespace softforce::scene
