#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <fstream>

#include "scene/sections.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

using base::Dimension;
using base::InputError;

struct Line {
  int number = 0;  // in the file, counted from 1
  std::vector<std::string> cells;
};

// How an actuator's column is called, and what its numbers are multiplied with.
struct Column {
  std::string name;
  double in_si = 1;
};

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string> SplitCells(const std::string& text) {
  std::vector<std::string> cells;
  size_t begin = 0;
  for (size_t comma; (comma = text.find(',', begin)) != std::string::npos; begin = comma + 1) {
    cells.push_back(Trimmed(text.substr(begin, comma - begin)));
  }
  cells.push_back(Trimmed(text.substr(begin)));
  return cells;
}

std::vector<Line> ReadLines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string(), "cannot be read", "Check that you may read it.");
  const std::string byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets put it in front of UTF-8
  std::vector<Line> lines;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    if (number == 1 && text.rfind(byte_order_mark, 0) == 0) text.erase(0, byte_order_mark.size());
    if (!Trimmed(text).empty()) lines.push_back({number, SplitCells(text)});
  }
  return lines;
}

Column ColumnOf(const Actuator& actuator) {
  const auto column = [&](const std::string& unit, Dimension dimension) {
    return Column{actuator.name + "_" + unit, base::UnitInSi(unit, dimension, actuator.name)};
  };
  switch (actuator.input) {
    case ActuatorInput::kTension:
      return column("N", Dimension::kForce);
    case ActuatorInput::kDisplacement:
      return column("mm", Dimension::kLength);
    case ActuatorInput::kPressure:
      return column("kPa", Dimension::kPressure);
  }
  assert(false);
  return {};
}

// Where in the header each expected name stands.
std::vector<size_t> Locate(const std::vector<std::string>& expected,
                           const std::vector<std::string>& header, const std::string& where) {
  for (const std::string& name : header) {
    const std::string here = fmt::format("{}: column \"{}\"", where, name);
    if (std::count(expected.begin(), expected.end(), name) == 0) {
      throw InputError(here, "unknown column, expected " + Join(expected),
                       DidYouMean(name, expected));
    }
    if (std::count(header.begin(), header.end(), name) > 1) {
      throw InputError(here, "the column is given twice, expected once");
    }
  }
  std::vector<size_t> places;
  for (const std::string& name : expected) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      throw InputError(where,
                       fmt::format("got the columns {}; expected also \"{}\"", Join(header), name));
    }
    places.push_back(found - header.begin());
  }
  return places;
}

}  // namespace

ActuationTable ReadActuationTable(const std::filesystem::path& file,
                                  const std::vector<Actuator>& actuators) {
  std::vector<Column> columns = {{"time_s"}};
  for (const Actuator& actuator : actuators) columns.push_back(ColumnOf(actuator));
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);

  std::vector<Line> lines = ReadLines(file);
  if (lines.size() < 2) {
    throw InputError(file.string(), "got no inputs, expected a header line and at least one row",
                     "The header is: " + fmt::format("{}", fmt::join(names, ",")));
  }
  const std::vector<std::string> header = lines[0].cells;
  const std::vector<size_t> places =
      Locate(names, header, fmt::format("{}:{}", file.string(), lines[0].number));
  lines.erase(lines.begin());

  ActuationTable table;
  table.inputs.resize(lines.size(), actuators.size());
  for (size_t row = 0; row < lines.size(); ++row) {
    const std::string where = fmt::format("{}:{}", file.string(), lines[row].number);
    const std::vector<std::string>& cells = lines[row].cells;
    if (cells.size() != header.size()) {
      throw InputError(where, fmt::format("got {} cells, expected {} as in the header",
                                          cells.size(), header.size()));
    }
    const auto number = [&](size_t column) {
      return base::ParseQuantity(cells[places[column]], Dimension::kNumber, 1,
                                 fmt::format("{}: column \"{}\"", where, names[column]))[0];
    };
    const double time_s = number(0);
    if (row > 0 && time_s <= table.time_s.back()) {
      throw InputError(where, fmt::format("got the time {} s after {} s, expected ascending times",
                                          time_s, table.time_s.back()));
    }
    table.time_s.push_back(time_s);
    for (size_t a = 0; a < actuators.size(); ++a) {
      table.inputs(row, a) = number(a + 1) * columns[a + 1].in_si;
      if (actuators[a].input == ActuatorInput::kTension && table.inputs(row, a) < 0) {
        throw InputError(
            fmt::format("{}: column \"{}\"", where, names[a + 1]),
            fmt::format("got a tension of {} N, expected 0 or more: a cable cannot push",
                        table.inputs(row, a)));
      }
    }
  }
  return table;
}

Eigen::VectorXd ActuationTable::At(double time) const {
  assert(static_cast<Eigen::Index>(time_s.size()) == inputs.rows());
  if (time_s.empty()) return Eigen::VectorXd::Zero(inputs.cols());
  const Eigen::Index after = std::upper_bound(time_s.begin(), time_s.end(), time) - time_s.begin();
  if (after == 0) return inputs.row(0);
  if (after == inputs.rows()) return inputs.row(after - 1);
  const double fraction = (time - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
  return (1 - fraction) * inputs.row(after - 1) + fraction * inputs.row(after);
}

}  // namespace softforce::scene
