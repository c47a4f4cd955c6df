#include <fmt/format.h>

#include "report/format.h"
#include "report/json_text.h"
#include "report/page.h"
#include "report/run_charts.h"
#include "report/run_data.h"
#include "report/scripts.h"
#include "report/svg.h"
#include "report/table.h"

namespace softforce::report {
namespace {

std::string Head(const RunRecord& record) {
  const bool silent = record.warnings.empty() && record.advice.empty();
  const char* colour = !record.usable ? "bad" : silent ? "good" : "advice";
  const char* verdict = !record.usable ? "not usable"
                        : silent       ? "usable"
                                       : "usable, but read the warnings";
  std::string head = fmt::format("<h1>{} <span class=\"verdict {}\">{}</span></h1>\n<p>{}</p>\n",
                                 Escape(record.scene), colour, verdict, Escape(record.brief));
  head += "<div class=\"cards\">\n";
  for (const auto& [figure, meaning] : record.cards) head += Card(figure, meaning);
  return head + "</div>\n";
}

std::string Warnings(const RunRecord& record) {
  if (record.warnings.empty() && record.advice.empty()) return "";
  std::string box = "<h2>Warnings</h2>\n<div class=\"box\"><ul>\n";
  for (const RunAdvice& advice : record.advice) {
    box += "<li><b>" + Escape(advice.finding) + "</b><br>" + Escape(advice.what_to_do) + "</li>\n";
  }
  for (const std::string& warning : record.warnings) box += "<li>" + Escape(warning) + "</li>\n";
  return box + "</ul></div>\n";
}

std::string Joined(const RunRecord& record) {
  const int frames = record.time.frames_per_column();
  if (frames == 1) return "";
  return fmt::format(
      " A place stands for up to {} frames and shows the lowest and the highest of them.", frames);
}

std::string Forces(const RunRecord& record) {
  if (record.forces.empty()) return "";
  std::string key;
  for (size_t f = 0; f < record.forces.size(); ++f) {
    key += Key(HueClass(static_cast<int>(f)), record.forces[f]);
  }
  std::string section = "<h2>Forces</h2>\n";
  section += Figure(NormChart(record),
                    key + ". Shaded: 95 % band. Point at it for the values." + Joined(record));
  section += "<div class=\"row\">\n";
  const std::string components = Key("cx", "x") + Key("cy", "y") + Key("cz", "z");
  for (size_t f = 0; f < record.forces.size(); ++f) {
    section += Figure(ComponentChart(record, static_cast<int>(f)),
                      components + " of " + Escape(record.forces[f]) +
                          ", the force on the body in the robot frame.");
  }
  section += "</div>\n";
  if (record.forces_left_out > 0) {
    section += "<p class=\"soft\">" + Count(record.forces_left_out, "more force") +
               " not shown: see forces.csv.</p>\n";
  }
  return section;
}

std::string BodySection(const RunRecord& record) {
  if (record.views.empty()) return "";
  std::string section = "<h2>Body</h2>\n";
  if (BodyViewScript().empty()) {
    return section +
           "<p class=\"soft\">This softforce was built without the 3-D view "
           "(SOFTFORCE_WEB=OFF). With --vtu the body can be seen in ParaView.</p>\n";
  }
  return section +
         Figure(
             "<div id=\"view\"></div>",
             "Drag to turn, wheel or two fingers to zoom, right button or two fingers to move. "
             "Colour: displacement. Arrows: forces on the body. " +
                 [&] {
                   std::string key = "Markers:";
                   for (size_t s = 0; s < record.marker_statuses.size(); ++s) {
                     key += Key(fmt::format("s{}", s), record.marker_statuses[s]);
                   }
                   return key;
                 }());
}

std::string Pictures(const RunRecord& record) {
  if (record.pictures.empty()) return "";
  std::string section = "<h2>Pictures</h2>\n<div class=\"pictures\">\n";
  for (const KeyPicture& picture : record.pictures) {
    section += Figure("<img alt=\"" + Escape(picture.caption) + "\" src=\"data:image/jpeg;base64," +
                          Base64(picture.jpeg) + "\">",
                      Escape(picture.caption));
  }
  return section + "</div>\n";
}

std::string Quality(const RunRecord& record) {
  std::string section;
  const std::string residuals = ResidualChart(record);
  if (!residuals.empty()) {
    section += "<h2>Residuals</h2>\n" +
               Figure(residuals,
                      "How well the forces explain the markers. About 1, the dashed line: as well "
                      "as the standard deviations say. Far above: something is wrong, and the "
                      "bands are too narrow.");
  }
  if (!record.markers.empty()) {
    std::string key;
    for (size_t s = 0; s < record.marker_statuses.size(); ++s) {
      key += Key(fmt::format("s{}", s), record.marker_statuses[s]);
    }
    if (record.time.frames_per_column() > 1) {
      key += fmt::format(". A place shows the gravest of up to {} frames.",
                         record.time.frames_per_column());
    }
    section += "<h2>Markers</h2>\n" + Figure(MarkerTimeline(record), key);
  }
  return section;
}

std::string Stages(const RunRecord& record) {
  if (record.stages.empty()) return "";
  return "<h2>Time per frame</h2>\n" +
         Figure(StageBars(record), Key("c0", "median") + Key("c1", "up to the 95 % quantile") +
                                       ". Stages work beside each other on different frames.");
}

std::string Facts(const RunRecord& record) {
  Table facts({}, 2);
  for (const auto& [name, value] : record.facts) facts.Add({name, value});
  Table inputs({"file", "SHA-256"}, 2);
  for (const auto& [file, sum] : record.inputs) inputs.Add({file, sum});
  return "<h2>What ran</h2>\n<div class=\"box facts\">" + facts.str() + "</div>\n" +
         Folded(Count(static_cast<int>(record.inputs.size()), "input file"), inputs.str());
}

std::string DataElement(const std::string& id, const std::string& json) {
  return "<script type=\"application/json\" id=\"" + id + "\">" + json + "</script>\n";
}

std::string ScriptElement(const std::string& script) {
  return script.empty() ? "" : "<script>" + script + "</script>\n";
}

}  // namespace

std::string RunPage(const RunRecord& record) {
  std::string body = Head(record) + Warnings(record);
  std::string scripts;
  if (!record.time.columns().empty()) {
    body +=
        Forces(record) + BodySection(record) + Pictures(record) + Quality(record) + Stages(record);
    scripts += DataElement("chart-data", ChartData(record)) + ScriptElement(RunPageScript());
    if (!record.views.empty() && !BodyViewScript().empty()) {
      scripts += DataElement("body-data", BodyData(record)) + ScriptElement(BodyViewScript());
    }
  }
  return Page(record.scene + " – softforce", body + Facts(record), scripts);
}

}  // namespace softforce::report
