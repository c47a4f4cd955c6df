#include "report/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "report/json_text.h"

namespace softforce::report {
namespace {

constexpr float kSteps = 32767;  // that the largest displacement is divided into

template <typename Value>
std::string Column(const RunRecord& record, Value&& value) {
  return JsonList(record.time.columns(),
                  [&](const RunColumn& column) { return JsonNumber(value(column)); });
}

// Times need more digits than values, in a long run.
template <typename Value>
std::string Times(const RunRecord& record, Value&& value) {
  return JsonList(record.time.columns(), [&](const RunColumn& column) {
    return fmt::format("{:.10g}", static_cast<double>(value(column)));
  });
}

template <typename Get>
std::string Line(const RunRecord& record, const std::string& name, const std::string& unit,
                 Get&& extent) {
  std::string json = fmt::format(
      "{{\"name\":{},\"unit\":{},\"low\":{}", JsonText(name), JsonText(unit),
      Column(record, [&](const RunColumn& column) { return extent(column, false).low; }));
  if (record.time.frames_per_column() > 1) {
    json += ",\"high\":" +
            Column(record, [&](const RunColumn& column) { return extent(column, false).high; });
  }
  return json;
}

std::string ForceLine(const RunRecord& record, size_t force, size_t part, const std::string& name) {
  const auto extent = [=](const RunColumn& column, bool band) {
    if (force >= column.forces.size()) return Extent();
    return band ? column.forces[force].band[part] : column.forces[force].value[part];
  };
  return Line(record, name, "N", extent) + ",\"bandLow\":" +
         Column(record, [&](const RunColumn& column) { return extent(column, true).low; }) +
         ",\"bandHigh\":" +
         Column(record, [&](const RunColumn& column) { return extent(column, true).high; }) + "}";
}

// A digit per column; '-' before a marker was known.
std::string Statuses(const RunRecord& record, size_t marker) {
  std::string text = "\"";
  for (const RunColumn& column : record.time.columns()) {
    text += marker < column.markers.size() ? static_cast<char>('0' + column.markers[marker]) : '-';
  }
  return text + "\"";
}

template <typename Scalar, typename Matrix>
std::string Bytes(const Matrix& matrix) {
  std::string bytes;
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    const auto value = static_cast<Scalar>(matrix.data()[i]);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return '"' + Base64(bytes) + '"';
}

std::string Point(const Eigen::Vector3f& p) {
  return fmt::format("{},{},{}", JsonNumber(p.x()), JsonNumber(p.y()), JsonNumber(p.z()));
}

float Largest(const BodyView& view) {
  return view.u.size() == 0 ? 0 : view.u.cwiseAbs().maxCoeff();
}

float StepOf(float largest) { return largest > 0 ? largest / kSteps : 1; }

std::string ViewData(const BodyView& view, float step) {
  const Eigen::Matrix3Xf rounded = (view.u / step).array().round();
  return fmt::format(
      "{{\"frame\":{},\"time\":{:.10g},\"label\":{},\"u\":{},\"forces\":{},\"markers\":{},"
      "\"cables\":{}}}",
      view.frame, view.time_s, JsonText(view.label), Bytes<std::int16_t>(rounded),
      JsonList(view.forces,
               [](const ViewForce& force) {
                 return fmt::format("[{},{},{},{}]", JsonText(force.name), Point(force.position),
                                    Point(force.force), JsonNumber(force.sd));
               }),
      JsonList(view.markers,
               [](const ViewMarker& marker) {
                 return fmt::format("[{},{},{}]", marker.id, marker.status, Point(marker.position));
               }),
      JsonList(view.cables, [](const std::vector<Eigen::Vector3f>& cable) {
        return JsonList(cable, [](const Eigen::Vector3f& p) { return "[" + Point(p) + "]"; });
      }));
}

}  // namespace

std::string ChartData(const RunRecord& record) {
  std::string charts;
  std::string norms;
  for (size_t f = 0; f < record.forces.size(); ++f) {
    norms += (f == 0 ? "" : ",") + ForceLine(record, f, 3, record.forces[f]);
    charts += fmt::format(",\"force{}\":[{},{},{}]", f, ForceLine(record, f, 0, "x"),
                          ForceLine(record, f, 1, "y"), ForceLine(record, f, 2, "z"));
  }
  const auto chi2 = [](const RunColumn& column, bool /*band*/) { return column.reduced_chi2; };
  std::vector<std::string> rows;
  for (size_t m = 0; m < record.markers.size(); ++m) rows.push_back(Statuses(record, m));
  const auto same = [](const std::string& text) { return text; };
  return fmt::format(
      "{{\"first\":{},\"last\":{},\"from\":{},\"to\":{},\"charts\":{{\"norm\":[{}]{},\"chi2\":[{}]}"
      "}"
      ",\"statuses\":{},\"markers\":{},\"rows\":{}}}",
      Times(record, [](const RunColumn& column) { return column.first_frame; }),
      Times(record, [](const RunColumn& column) { return column.last_frame; }),
      Times(record, [](const RunColumn& column) { return column.first_s; }),
      Times(record, [](const RunColumn& column) { return column.last_s; }), norms, charts,
      Line(record, "χ² per degree of freedom", "", chi2) + "}",
      JsonList(record.marker_statuses, JsonText),
      JsonList(record.markers, [](int id) { return std::to_string(id); }), JsonList(rows, same));
}

std::string BodyData(const RunRecord& record) {
  float largest = 0;
  for (const BodyView& view : record.views) largest = std::max(largest, Largest(view));
  const float step = StepOf(largest);
  return fmt::format(
      "{{\"nodes\":{},\"triangles\":{},\"step\":{},\"first\":{},\"statuses\":{},\"views\":{}}}",
      Bytes<float>(record.body.nodes), Bytes<std::uint32_t>(record.body.triangles),
      JsonNumber(step), record.first_view, JsonList(record.marker_statuses, JsonText),
      JsonList(record.views, [&](const BodyView& view) { return ViewData(view, step); }));
}

std::string OneView(const BodyView& view) {
  const float step = StepOf(Largest(view));
  return fmt::format("{{\"step\":{},\"view\":{}}}", JsonNumber(step), ViewData(view, step));
}

}  // namespace softforce::report
