#include "report/run_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "report/chart.h"
#include "report/format.h"

namespace softforce::report {
namespace {

constexpr double kWide = 940, kHalf = 460;  // px
constexpr int kNorm = 3;                    // its index in ForceExtent

// The extent of a column; its band, if it has one.
using Values = std::function<Extent(const RunColumn&)>;

double Middle(const RunColumn& column) { return (column.first_s + column.last_s) / 2; }

Values ForceValues(int force, int part, bool band) {
  return [=](const RunColumn& column) {
    const auto f = static_cast<size_t>(force);
    if (f >= column.forces.size()) return Extent();
    const auto& extents = band ? column.forces[f].band : column.forces[f].value;
    return extents[static_cast<size_t>(part)];
  };
}

// Runs of columns in which something is known.
std::vector<std::vector<size_t>> Runs(const std::vector<RunColumn>& columns, const Values& values) {
  std::vector<std::vector<size_t>> runs;
  bool open = false;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (!values(columns[i]).known()) {
      open = false;
      continue;
    }
    if (!open) runs.emplace_back();
    open = true;
    runs.back().push_back(i);
  }
  return runs;
}

// Through all values; up and down where a column has more than one.
std::string LinePath(const Chart& chart, const std::vector<RunColumn>& columns,
                     const Values& values) {
  std::string d;
  for (const std::vector<size_t>& run : Runs(columns, values)) {
    const char* stroke = "M";
    for (const size_t i : run) {
      const Extent extent = values(columns[i]);
      const double x = chart.X(Middle(columns[i]));
      d += fmt::format("{}{:.1f} {:.1f}", stroke, x, chart.Y(extent.low));
      if (extent.high > extent.low) d += fmt::format("V{:.1f}", chart.Y(extent.high));
      stroke = "L";
    }
    if (run.size() == 1) d += "h0.1";  // a frame by itself: a dot
  }
  return d;
}

std::string BandPath(const Chart& chart, const std::vector<RunColumn>& columns,
                     const Values& values) {
  std::string d;
  for (const std::vector<size_t>& run : Runs(columns, values)) {
    const char* stroke = "M";
    for (const size_t i : run) {
      d += fmt::format("{}{:.1f} {:.1f}", stroke, chart.X(Middle(columns[i])),
                       chart.Y(values(columns[i]).high));
      stroke = "L";
    }
    for (auto i = run.rbegin(); i != run.rend(); ++i) {
      d += fmt::format("L{:.1f} {:.1f}", chart.X(Middle(columns[*i])),
                       chart.Y(values(columns[*i]).low));
    }
    d += "Z";
  }
  return d;
}

Extent Over(const RunRecord& record, const std::vector<Values>& all) {
  Extent extent;
  for (const RunColumn& column : record.time.columns()) {
    for (const Values& values : all) extent.Add(values(column));
  }
  return extent;
}

void TimeAxis(const RunRecord& record, Chart* chart) {
  const std::vector<RunColumn>& columns = record.time.columns();
  chart->XAxis("time, s", columns.front().first_s, columns.back().last_s);
}

// A line with its band, or without.
struct Curve {
  Values values, band;
  std::string css_class;
};

std::string TimeChart(const RunRecord& record, Chart chart, const std::vector<Curve>& curves,
                      const std::string& key) {
  const std::vector<RunColumn>& columns = record.time.columns();
  TimeAxis(record, &chart);
  for (const Curve& curve : curves) {
    if (curve.band) {
      chart.svg.Path(BandPath(chart, columns, curve.band), "band " + curve.css_class);
    }
  }
  for (const Curve& curve : curves) {
    chart.svg.Path(LinePath(chart, columns, curve.values), "line " + curve.css_class);
  }
  return chart.Readable(key);
}

}  // namespace

std::string NormChart(const RunRecord& record) {
  std::vector<Curve> curves;
  std::vector<Values> all;
  for (size_t f = 0; f < record.forces.size(); ++f) {
    const int force = static_cast<int>(f);
    curves.push_back(
        {ForceValues(force, kNorm, false), ForceValues(force, kNorm, true), HueClass(force)});
    all.push_back(curves.back().band);
    all.push_back(curves.back().values);
  }
  const Extent extent = Over(record, all);
  return TimeChart(record,
                   Chart(kWide, 300, "Norms of the forces over time", "norm, N", extent.high),
                   curves, "norm");
}

std::string ComponentChart(const RunRecord& record, int force) {
  static constexpr std::array<const char*, 3> kClasses{"cx", "cy", "cz"};
  std::vector<Curve> curves;
  std::vector<Values> all;
  for (int part = 0; part < 3; ++part) {
    curves.push_back({ForceValues(force, part, false), ForceValues(force, part, true),
                      kClasses[static_cast<size_t>(part)]});
    all.push_back(curves.back().band);
    all.push_back(curves.back().values);
  }
  const Extent extent = Over(record, all);
  const std::string& name = record.forces[static_cast<size_t>(force)];
  // One by itself has the whole row.
  Chart chart(record.forces.size() == 1 ? kWide : kHalf, 250,
              "Components of " + name + " over time", name + ", N", std::max(extent.high, 0.0),
              std::min(extent.low, 0.0));
  return TimeChart(record, chart, curves, fmt::format("force{}", force));
}

std::string ResidualChart(const RunRecord& record) {
  const Values values = [](const RunColumn& column) { return column.reduced_chi2; };
  const Extent extent = Over(record, {values});
  if (!extent.known()) return "";
  Chart chart(kWide, 200, "Chi2 per degree of freedom over time", "χ² per degree of freedom",
              std::max(extent.high, 1.2));
  chart.svg.Line(chart.left(), chart.Y(1), chart.left() + chart.plot_width(), chart.Y(1),
                 "level c5");
  return TimeChart(record, chart, {{values, nullptr, "c0"}}, "chi2");
}

}  // namespace softforce::report
