#include "softforce/report/identification_page.h"

#include <fmt/format.h>

#include "report/bar_figure.h"
#include "report/format.h"
#include "report/page.h"

namespace softforce::report {
namespace {

constexpr double kMilli = 1e3;  // mm of a m

struct Shown {
  double factor;
  std::string unit;
};

Shown UnitOf(const std::string& unit) {
  if (unit == "Pa") return {1e-3, "kPa"};
  if (unit == "m") return {1e3, "mm"};
  return {1, unit};
}

std::string Cards(const estimation::Identification& found) {
  std::string cards = "<div class=\"cards\">\n";
  for (const estimation::IdentifiedValue& value : found.values) {
    const Shown shown = UnitOf(value.unit);
    const ValueText text = TextOf(shown.factor * value.value, shown.factor * value.sd, shown.unit);
    cards += Card(fmt::format("{} ± {} {}", text.value, text.sd, text.unit),
                  fmt::format("{}; in the scene: {:.5g} {}", value.name, shown.factor * value.start,
                              shown.unit));
  }
  return cards + "</div>\n";
}

std::string StatesFigure(const estimation::Identification& found) {
  BarFigure figure;
  figure.title = "Movement of the markers in every state, and what is left unexplained";
  figure.y_label = "mm";
  figure.logarithmic = true;
  BarSeries moved{"moved, the marker that moves most", {}};
  BarSeries offset{"rigid offset", {}};
  BarSeries left{"left unexplained, root mean square", {}};
  for (const estimation::StateFit& state : found.states) {
    figure.groups.push_back(state.name);
    moved.values.push_back(kMilli * state.displacement);
    offset.values.push_back(kMilli * state.offset.translation.norm());
    left.values.push_back(kMilli * state.rms_offset);
  }
  figure.series = {moved, offset, left};
  figure.caption = "The offset is an error of the rig's place, or of the model in common.";
  return "<h2>What the model leaves</h2>\n" + DrawBars(figure);
}

std::string ForcesFigure(const std::vector<ComparedForce>& forces) {
  if (forces.empty()) return "";
  BarFigure figure;
  figure.title = "Known forces and what a run finds with the values";
  figure.y_label = "N";
  BarSeries known{"known", {}};
  BarSeries found{"found by a run with these values", {}};
  for (const ComparedForce& force : forces) {
    figure.groups.push_back(fmt::format("{} ({})", force.state, force.candidate));
    known.values.push_back(force.known);
    found.values.push_back(force.found);
  }
  figure.series = {known, found};
  figure.caption = "In brackets: the candidate.";
  return "<h2>Known forces</h2>\n" + DrawBars(figure);
}

}  // namespace

std::string IdentificationPage(const IdentificationRecord& record) {
  const bool usable = record.found.ok();
  std::string page =
      fmt::format("<h1>Identification <span class=\"verdict {}\">{}</span></h1>\n<p>{}</p>\n",
                  usable ? "good" : "bad", usable ? "usable" : "not usable",
                  Escape(record.found.BriefReport()));
  if (usable) page += Cards(record.found);
  if (!record.found.states.empty()) page += StatesFigure(record.found);
  page += ForcesFigure(record.forces);
  page += Folded("As text", "<pre>" + Escape(record.text) + "</pre>");
  return Page("Identification", page);
}

}  // namespace softforce::report
