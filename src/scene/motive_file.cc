// The CSV export of OptiTrack's Motive: a line of keys and values, then rows that say of every
// column what it is (Type, Name, ID, Parent, Rotation or Position), the row "Frame, Time (Seconds),
// …, X, Y, Z …", and the frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "scene/measured_formats.h"
#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

using base::InputError;

constexpr char kExport[] =
    "Export the take from Motive as CSV, with the header, markers and unlabeled markers.";

// The three columns of a marker.
struct MarkerColumns {
  std::string name;
  int marker = -1;
  std::array<size_t, 3> columns{};  // X Y Z
};

class MotiveReader {
 public:
  MotiveReader(const std::vector<CsvLine>& lines, const Measured& measured, const Markers& markers)
      : lines_(lines),
        measured_(measured),
        labels_(measured, markers),
        file_(measured.file.string()) {}

  MeasuredPoints Read() {
    const std::vector<std::string>& cells = lines_[0].cells;
    for (size_t i = 0; i + 1 < cells.size(); i += 2) about_[cells[i]] = cells[i + 1];
    CheckSpace();
    const double metres_per_unit = Unit();
    const size_t axes = FindAxes();
    const std::vector<MarkerColumns> markers = FindMarkers(axes);
    const bool has_time_code = lines_[axes].cells.size() > 2 && lines_[axes].cells[2] == "TimeCode";
    const size_t cells_at_least = has_time_code ? 3 : 2;

    FrameCollector collector;
    for (size_t l = axes + 1; l < lines_.size(); ++l) {
      const CsvLine& line = lines_[l];
      if (line.cells.size() < cells_at_least) CheckCells(line, lines_[axes], file_);
      // Rows without the commas of the last, unseen points are well-formed in some versions; more
      // cells than columns are not.
      CsvLine row = line;
      if (row.cells.size() > lines_[axes].cells.size()) CheckCells(row, lines_[axes], file_);
      row.cells.resize(lines_[axes].cells.size());
      collector.Begin(ReadFrameNumber(row, 0, file_), ReadNumber(row, 1, "Time (Seconds)", file_),
                      fmt::format("{}:{}", file_, row.number));
      for (const MarkerColumns& marker : markers) {
        const auto p = ReadCoordinates(row, marker.columns, metres_per_unit, marker.name, file_);
        if (!p) continue;
        collector.Add({*p, measured_.noise, marker.marker}, marker.name,
                      fmt::format("{}:{}", file_, row.number));
      }
    }
    return {"Motive " + about_["Format Version"], collector.frames()};
  }

 private:
  std::string Where(const CsvLine& line) const { return fmt::format("{}:{}", file_, line.number); }

  void CheckSpace() {
    const auto space = about_.find("Coordinate Space");
    if (space == about_.end() || space->second.empty() || space->second == "Global") return;
    throw InputError(Where(lines_[0]) + ": Coordinate Space",
                     fmt::format("got \"{}\", expected Global", space->second),
                     "Export the take with world coordinates.");
  }

  double Unit() {
    const std::map<std::string, double> units = {
        {"Millimeters", 1e-3}, {"Centimeters", 1e-2}, {"Meters", 1.0}};
    const std::string where = Where(lines_[0]) + ": Length Units";
    const auto unit = units.find(about_["Length Units"]);
    if (unit == units.end()) {
      throw InputError(where,
                       fmt::format("got \"{}\", expected Millimeters, Centimeters or Meters",
                                   about_["Length Units"]),
                       kExport);
    }
    const std::optional<double> told = measured_.metres_per_unit;
    if (told && std::abs(*told / unit->second - 1) > 1e-9) {
      throw InputError(where,
                       fmt::format("got {}, but the scene says \"unit\" {} m", unit->first, *told),
                       "Leave out \"measured: unit\": an export of Motive has its own.");
    }
    return unit->second;
  }

  size_t FindAxes() const {
    for (size_t l = 1; l < lines_.size(); ++l) {
      const std::vector<std::string>& cells = lines_[l].cells;
      if (cells.size() >= 2 && cells[0] == "Frame" && cells[1].rfind("Time", 0) == 0) return l;
    }
    throw InputError(file_, "got no row \"Frame, Time (Seconds), X, Y, Z …\" of a Motive export",
                     kExport);
  }

  // The row above the axes in which some column has this word.
  const CsvLine* RowWith(size_t axes, const std::vector<std::string>& words) const {
    for (size_t l = 1; l < axes; ++l) {
      for (const std::string& cell : lines_[l].cells) {
        if (std::count(words.begin(), words.end(), cell) > 0) return &lines_[l];
      }
    }
    return nullptr;
  }

  std::vector<MarkerColumns> FindMarkers(size_t axes) const {
    const CsvLine* types = RowWith(axes, {"Marker"});
    const CsvLine* kinds = RowWith(axes, {"Position"});
    if (types == nullptr || kinds == nullptr || types + 1 >= kinds) {
      throw InputError(file_,
                       "got no columns of markers' positions (type Marker, Position), expected "
                       "those of every marker; rigid bodies are of no use here",
                       kExport);
    }
    const CsvLine& names = *(types + 1);
    const auto cell = [](const CsvLine& row, size_t column) {
      return column < row.cells.size() ? row.cells[column] : std::string();
    };
    std::vector<MarkerColumns> markers;
    const CsvLine& axis_row = lines_[axes];
    for (size_t c = 2; c < axis_row.cells.size(); ++c) {
      const bool starts =
          cell(*types, c) == "Marker" && cell(*kinds, c) == "Position" && axis_row.cells[c] == "X";
      if (!starts) continue;
      const std::string name = cell(names, c);
      const std::string where = fmt::format("{}: column {}", Where(names), c + 1);
      if (cell(axis_row, c + 1) != "Y" || cell(axis_row, c + 2) != "Z") {
        throw InputError(where, fmt::format("the point \"{}\" has no columns X, Y and Z", name),
                         kExport);
      }
      const PointLabels::Meaning meaning = labels_.Of(name, where);
      if (meaning.used) markers.push_back({name, meaning.marker, {c, c + 1, c + 2}});
    }
    return markers;
  }

  const std::vector<CsvLine>& lines_;
  const Measured& measured_;
  const PointLabels labels_;
  const std::string file_;
  std::map<std::string, std::string> about_;
};

}  // namespace

bool IsMotiveExport(const std::vector<CsvLine>& lines) {
  return !lines.empty() && lines[0].cells[0] == "Format Version";
}

MeasuredPoints ReadMotiveExport(const std::vector<CsvLine>& lines, const Measured& measured,
                                const Markers& markers) {
  return MotiveReader(lines, measured, markers).Read();
}

}  // namespace softforce::scene
