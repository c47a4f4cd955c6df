#include "softforce/report/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/bar_figure.h"
#include "report/format.h"
#include "report/page.h"
#include "softforce/validation/tables.h"

namespace softforce::report {
namespace {

using Figures = std::vector<validation::Figure>;

std::string BodyOf(const validation::Figure& figure) {
  return figure.layout.front() == 's' ? "soft sheet" : "soft robot";
}

void Put(double value, size_t group, BarSeries* series) {
  series->values.resize(std::max(series->values.size(), group + 1), NAN);
  series->values[group] = value;
}

BarSeries* SeriesOf(const std::string& name, BarFigure* figure) {
  for (BarSeries& series : figure->series) {
    if (series.name == name) return &series;
  }
  figure->series.push_back({name, {}});
  return &figure->series.back();
}

size_t GroupOf(const std::string& name, BarFigure* figure) {
  const auto known = std::find(figure->groups.begin(), figure->groups.end(), name);
  if (known != figure->groups.end()) return known - figure->groups.begin();
  figure->groups.push_back(name);
  return figure->groups.size() - 1;
}

// A group for each layout, a bar for each way to estimate, and the paper's figure as a spot.
BarFigure BarsOf(const Figures& figures, const std::string& y_label) {
  BarFigure bars;
  bars.y_label = y_label;
  bars.logarithmic = true;
  BarSeries paper{"the paper", {}, true};
  for (const validation::Figure& figure : figures) {
    const size_t group = GroupOf(figure.layout, &bars);
    Put(figure.value, group, SeriesOf(figure.how, &bars));
    if (std::isfinite(figure.paper)) Put(figure.paper, group, &paper);
  }
  if (!paper.values.empty()) bars.series.push_back(std::move(paper));
  return bars;
}

template <typename Wanted>
Figures Choose(const Figures& all, const Wanted& wanted) {
  Figures chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), wanted);
  return chosen;
}

std::string TableOne(const Figures& all, char body) {
  const auto of = [&](const char* quantity) {
    return Choose(all, [&](const validation::Figure& figure) {
      return figure.table == "I" && figure.layout.front() == body && figure.quantity == quantity;
    });
  };
  const Figures errors = of("I_e");
  if (errors.empty()) return "";
  std::string section = "<h2>Table I, " + BodyOf(errors.front()) + ": exact inverse model</h2>\n";
  BarFigure bars = BarsOf(errors, "I_e, mN");
  bars.title = "Errors of the forces with an exact inverse model";
  bars.caption = "Sum of the absolute errors of all force components.";
  section += DrawBars(bars);
  bars = BarsOf(of("I_w"), "I_w, N/mm");
  bars.title = "Norm of the inverse compliance";
  bars.caption = "What an error of a marker is multiplied by, at most.";
  return section + DrawBars(bars);
}

// One kind of error of the inverse model, of its largest size.
std::string Inexact(const Figures& all, char body, const std::string& error,
                    const std::string& heading, const char* unit) {
  double size = -INFINITY;
  Figures chosen = Choose(all, [&](const validation::Figure& figure) {
    return figure.table != "I" && figure.layout.front() == body && figure.error == error;
  });
  if (chosen.empty()) return "";
  // Of moduli the smallest is the furthest off.
  const double sign = error == "modulus" ? -1 : 1;
  for (const validation::Figure& figure : chosen) size = std::max(size, sign * figure.size);
  chosen =
      Choose(chosen, [&](const validation::Figure& figure) { return sign * figure.size == size; });
  BarFigure bars = BarsOf(chosen, "I_e, mN");
  bars.title = heading;
  if (*unit != '\0') {
    bars.caption =
        fmt::format("The largest of three errors: {:g} {}. The others are in validation.csv.",
                    sign * size, unit);
  }
  return "<h3>" + Escape(heading) + "</h3>\n" + DrawBars(bars);
}

std::string TableOfBody(const Figures& all, char body) {
  constexpr std::array<std::array<const char*, 3>, 4> kErrors{
      {{"none", "Nothing wrong but the mesh", ""},
       {"modulus", "Young's modulus wrong: 300 kPa are true", "kPa"},
       {"markers", "Markers shifted", "mm"},
       {"tension", "Tension of the cables wrong", "N"}}};
  std::string section;
  for (const auto& [error, heading, unit] : kErrors) {
    section += Inexact(all, body, error, heading, unit);
  }
  if (section.empty()) return "";
  const bool sheet = body == 's';
  return fmt::format("<h2>Table {}, soft {}: inexact inverse model</h2>\n{}", sheet ? "II" : "III",
                     sheet ? "sheet" : "robot", section);
}

}  // namespace

std::string StudyPage(const validation::Study& study) {
  const Figures all = validation::Figures(study);
  std::string page =
      "<h1>The paper's simulated study</h1>\n<p>Errors of the estimated forces (I_e), beside those "
      "that the paper prints, on a logarithmic scale. Hover over a bar for its value; all values "
      "are in validation.csv beside this page.</p>\n";
  for (const char body : {'s', 'r'}) page += TableOne(all, body) + TableOfBody(all, body);
  return Page("The paper's simulated study", page);
}

}  // namespace softforce::report
