#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/chart.h"
#include "report/format.h"
#include "report/run_charts.h"

namespace softforce::report {
namespace {

constexpr double kWide = 940;  // px

// Tall enough to be read, low enough that many markers stay within a screen.
double RowHeight(size_t rows) { return std::clamp(420.0 / static_cast<double>(rows), 3.0, 18.0); }

// Where column i ends: half way to the next, so that the rows have no gaps.
double EndOf(const std::vector<RunColumn>& columns, size_t i) {
  if (i + 1 == columns.size()) return columns[i].last_s;
  return (columns[i].last_s + columns[i + 1].first_s) / 2;
}

int StatusOf(const RunColumn& column, size_t marker) {
  return marker < column.markers.size() ? column.markers[marker] : -1;
}

// Boxes over all runs of columns in which the marker has the status.
std::string Boxes(const std::vector<RunColumn>& columns, const Chart& chart, size_t marker,
                  int status, double y, double height) {
  std::string d;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (StatusOf(columns[i], marker) != status) continue;
    const double begin = i == 0 ? columns[0].first_s : EndOf(columns, i - 1);
    while (i + 1 < columns.size() && StatusOf(columns[i + 1], marker) == status) ++i;
    d += fmt::format("M{:.1f} {:.1f}H{:.1f}v{:.1f}H{:.1f}Z", chart.X(begin), y,
                     chart.X(EndOf(columns, i)), height, chart.X(begin));
  }
  return d;
}

}  // namespace

std::string MarkerTimeline(const RunRecord& record) {
  const std::vector<RunColumn>& columns = record.time.columns();
  const size_t rows = record.markers.size();
  const double height = RowHeight(rows);
  const double gap = height > 6 ? 2 : 0.5;
  Chart chart(kWide, Chart::kTop + height * static_cast<double>(rows) + Chart::kBottom,
              "Status of every marker over time");
  chart.svg.Text(4, 12, "marker");
  chart.XAxis("time, s", columns.front().first_s, columns.back().last_s);
  for (size_t status = 0; status < record.marker_statuses.size(); ++status) {
    std::string d;
    for (size_t m = 0; m < rows; ++m) {
      d += Boxes(columns, chart, m, static_cast<int>(status),
                 chart.top() + height * static_cast<double>(m), height - gap);
    }
    if (!d.empty()) chart.svg.Path(d, fmt::format("status s{}", status));
  }
  const auto every = static_cast<size_t>(std::ceil(12 / height));  // labels must not overlap
  for (size_t m = 0; m < rows; m += every) {
    chart.svg.Text(chart.left() - 6, chart.top() + height * (static_cast<double>(m) + 0.5) + 3,
                   std::to_string(record.markers[m]), "end");
  }
  return chart.Readable("markers");
}

std::string StageBars(const RunRecord& record) {
  constexpr double kName = 90, kNumbers = 250, kRow = 24;
  double most = 0;
  for (const StageRow& row : record.stages) most = std::max(most, row.p95_ms);
  if (!(most > 0)) most = 1;
  Svg svg(kWide, kRow * static_cast<double>(record.stages.size()) + 20, "Time of every stage");
  const auto x = [&](double ms) { return kName + ms / most * (kWide - kName - kNumbers - 10); };
  const double numbers = kWide - kNumbers;
  svg.Text(numbers + 70, 12, "median, ms", "end");
  svg.Text(numbers + 145, 12, "95 %, ms", "end");
  svg.Text(numbers + 215, 12, "max, ms", "end");
  double y = 20;
  for (const StageRow& row : record.stages) {
    svg.Text(kName - 8, y + 15, row.stage, "end");
    svg.Rect(kName, y + 4, std::max(x(row.median_ms) - kName, 0.5), kRow - 10, "bar c0");
    svg.Line(x(row.median_ms), y + kRow / 2 - 1, x(row.p95_ms), y + kRow / 2 - 1, "whisker c1");
    svg.Line(x(row.p95_ms), y + 6, x(row.p95_ms), y + kRow - 8, "whisker c1");
    svg.Text(numbers + 70, y + 15, fmt::format("{:.2f}", row.median_ms), "end");
    svg.Text(numbers + 145, y + 15, fmt::format("{:.2f}", row.p95_ms), "end");
    svg.Text(numbers + 215, y + 15, fmt::format("{:.2f}", row.max_ms), "end");
    y += kRow;
  }
  return svg.str();
}

}  // namespace softforce::report
