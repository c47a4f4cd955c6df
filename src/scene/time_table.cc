#include "scene/time_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "scene/csv_lines.h"
#include "scene/spelling.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"

namespace softforce::scene {
namespace {

using base::InputError;

// Where a name stands in the header; nothing if it does not.
std::optional<size_t> Find(const std::string& name, const std::vector<std::string>& header) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) return std::nullopt;
  return found - header.begin();
}

void CheckHeader(const std::vector<std::string>& header, const std::vector<std::string>& known,
                 const std::string& where) {
  for (const std::string& name : header) {
    const std::string here = fmt::format("{}: column \"{}\"", where, name);
    if (!Find(name, known)) {
      throw InputError(here, "unknown column, expected " + Join(known), DidYouMean(name, known));
    }
    if (std::count(header.begin(), header.end(), name) > 1) {
      throw InputError(here, "the column is given twice, expected once");
    }
  }
}

// Where the columns stand that are there, and their names; the time is the first of them.
std::vector<std::pair<std::string, size_t>> Locate(const std::vector<std::string>& known,
                                                   const std::vector<std::string>& header,
                                                   Columns which, const std::string& where) {
  CheckHeader(header, known, where);
  std::vector<std::pair<std::string, size_t>> places;
  for (const std::string& name : known) {
    if (const auto place = Find(name, header)) {
      places.emplace_back(name, *place);
    } else if (which == Columns::kAll || name == known.front()) {
      throw InputError(where,
                       fmt::format("got the columns {}; expected also \"{}\"", Join(header), name));
    }
  }
  return places;
}

}  // namespace

TimeTable ReadTimeTable(const std::filesystem::path& file, const std::vector<std::string>& names,
                        Columns which) {
  std::vector<std::string> known{"time_s"};
  known.insert(known.end(), names.begin(), names.end());
  const std::vector<CsvLine> lines = ReadCsvLines(file);
  if (lines.size() < 2) {
    throw InputError(file.string(), "got no inputs, expected a header line and at least one row",
                     "The header is: " + fmt::format("{}", fmt::join(known, ",")));
  }
  const std::vector<std::string>& header = lines[0].cells;
  const auto places =
      Locate(known, header, which, fmt::format("{}:{}", file.string(), lines[0].number));

  TimeTable table;
  for (size_t c = 1; c < places.size(); ++c) table.columns.push_back(places[c].first);
  table.values.resize(lines.size() - 1, table.columns.size());
  for (size_t row = 0; row + 1 < lines.size(); ++row) {
    const std::string where = fmt::format("{}:{}", file.string(), lines[row + 1].number);
    const std::vector<std::string>& cells = lines[row + 1].cells;
    if (cells.size() != header.size()) {
      throw InputError(where, fmt::format("got {} cells, expected {} as in the header",
                                          cells.size(), header.size()));
    }
    const auto number = [&](size_t c) {
      return base::ParseQuantity(cells[places[c].second], base::Dimension::kNumber, 1,
                                 fmt::format("{}: column \"{}\"", where, places[c].first))[0];
    };
    const double time_s = number(0);
    if (row > 0 && time_s <= table.time_s.back()) {
      throw InputError(where, fmt::format("got the time {} s after {} s, expected ascending times",
                                          time_s, table.time_s.back()));
    }
    table.time_s.push_back(time_s);
    table.lines.push_back(lines[row + 1].number);
    for (size_t c = 1; c < places.size(); ++c) table.values(row, c - 1) = number(c);
  }
  return table;
}

Eigen::VectorXd Interpolate(const std::vector<double>& time_s, const Eigen::MatrixXd& rows,
                            double time) {
  if (time_s.empty()) return Eigen::VectorXd::Zero(rows.cols());
  const Eigen::Index after = std::upper_bound(time_s.begin(), time_s.end(), time) - time_s.begin();
  if (after == 0) return rows.row(0);
  if (after == rows.rows()) return rows.row(after - 1);
  const double fraction = (time - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
  return (1 - fraction) * rows.row(after - 1) + fraction * rows.row(after);
}

}  // namespace softforce::scene
