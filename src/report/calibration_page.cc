#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figures.h"
#include "report/format.h"
#include "report/page.h"
#include "report/page_tables.h"
#include "report/plots.h"
#include "report/svg.h"

namespace softforce::report {
namespace {

using calibration::Calibration;

// The colours of the cameras.
std::string CameraKey(const CalibrationRecord& record) {
  std::string key;
  for (size_t c = 0; c < record.input.cameras.size(); ++c) {
    key += Key(HueClass(static_cast<int>(c)), record.input.cameras[c].name);
  }
  return key;
}

std::string Head(const CalibrationRecord& record) {
  const Verdict verdict = VerdictOf(record.result);
  const char* colour = verdict == Verdict::kGood     ? "good"
                       : verdict == Verdict::kAdvice ? "advice"
                                                     : "bad";
  std::string head =
      fmt::format("<h1>Camera calibration <span class=\"verdict {}\">{}</span></h1>\n<p>{}</p>\n",
                  colour, Text(verdict), Escape(BriefReport(record)));
  if (!record.result.what_to_do.empty()) {
    head += "<p><b>" + Escape(record.result.what_to_do) + "</b></p>\n";
  }
  return head + "<p class=\"soft\">Board: " + Escape(record.board.Text()) + "</p>\n";
}

std::string Cards(const CalibrationRecord& record) {
  const Calibration& result = record.result;
  if (!result.ok()) return "";
  std::string cards = "<div class=\"cards\">\n";
  cards += Card(std::to_string(ViewsUsed(result)), "views used");
  cards += Card(Short(result.rms_px) + " px", "reprojection error, RMS");
  if (result.hold_out.folds > 0) {
    cards += Card(Short(result.hold_out.rms_px) + " px", "reprojection error of held-out views");
  }
  if (std::isfinite(result.hold_out.square_rms)) {
    cards += Card(Short(1e3 * result.hold_out.square_rms) + " mm",
                  "error between neighbouring points of held-out boards");
    cards +=
        Card(Short(1e3 * result.hold_out.board_rms) + " mm", "error of a point of held-out boards");
  }
  Centre most{0, 0};
  for (const calibration::ProjectionUncertainty& map : result.uncertainty) {
    const Centre centre = UncertaintyOf(map);
    most.value = std::max(most.value, centre.value);
    most.worst = std::max(most.worst, centre.worst);
  }
  if (!result.uncertainty.empty()) {
    cards += Card(Short(most.value) + " px", "uncertainty of projection in the picture's centre; " +
                                                 Short(most.worst) + " px where it is worst");
  }
  return cards + "</div>\n";
}

std::string AdviceBox(const Calibration& result) {
  if (result.advice.empty()) return "";
  std::string box = "<h2>Advice</h2>\n<div class=\"box\"><ul>\n";
  for (const calibration::Advice& advice : result.advice) {
    box += "<li><b>" + Escape(advice.finding) + "</b><br>" + Escape(advice.what_to_do) + "</li>\n";
  }
  return box + "</ul></div>\n";
}

std::string PicturesSection(const CalibrationRecord& record) {
  const Calibration& result = record.result;
  if (result.views.empty() || !(result.rms_px > 0)) return "";
  std::string section = "<h2>Reprojection error of every picture</h2>\n";
  section += Figure(PictureBars(record), CameraKey(record) +
                                             ". Dashed line: RMS of the camera. Empty bars: left "
                                             "out. Hover over a bar for its picture.");
  section += "<div class=\"row\">\n";
  section += Figure(PosePlot(record), CameraKey(record) +
                                          ". A good set is spread over both axes: tilts up to 45°, "
                                          "and at least two distances.");
  section +=
      Figure(TopView(record), "Cameras and boards from above (along y of the first camera).");
  return section + "</div>\n" + Folded("All pictures as a table", ViewsTable(record));
}

// Colours that serve all cameras.
std::pair<double, double> UncertaintyRange(const Calibration& result) {
  double lowest = INFINITY, highest = 0;
  for (const calibration::ProjectionUncertainty& map : result.uncertainty) {
    for (Eigen::Index i = 0; i < map.sd_px.size(); ++i) {
      const double sd = map.sd_px.data()[i];
      if (!std::isfinite(sd) || sd <= 0) continue;
      lowest = std::min(lowest, sd);
      highest = std::max(highest, sd);
    }
  }
  return {lowest, std::max(highest, 1.01 * lowest)};
}

std::string CameraSection(const CalibrationRecord& record, int c) {
  const Calibration& result = record.result;
  std::string section =
      "<h2>Camera " + Escape(record.input.cameras[c].name) + "</h2>\n<div class=\"row\">\n";
  section += Figure(CoveragePlot(record, c),
                    "Where the board was seen. Pink cells saw nothing: "
                    "there the lens is guessed from the rest.");
  if (result.ok()) {
    section += Figure(ResidualPlot(record, c),
                      "Reprojection errors, detected less projected. Arrows that agree with their "
                      "neighbours mean that the lens model does not fit.");
    const auto [lowest, highest] = UncertaintyRange(result);
    section += Figure(UncertaintyPlot(record, c, lowest, highest),
                      "How far the projection of a point may be off because of the calibration "
                      "(standard deviation, worst direction). The RMS does not show this.");
    section += "<div class=\"box\">" + ValuesTable(record, c) + "</div>\n";
  }
  return section + "</div>\n";
}

std::string HoldOutSection(const CalibrationRecord& record) {
  const calibration::HoldOut& hold_out = record.result.hold_out;
  if (hold_out.folds == 0 || hold_out.views.empty()) return "";
  const bool metric = std::isfinite(hold_out.board_rms);
  std::string section = fmt::format(
      "<h2>Views that were held out</h2>\n<p>The calibration was repeated {} times, each time "
      "without some of the views, which were then measured with it. RMS: {}.</p>\n",
      hold_out.folds, Escape(HoldOutText(hold_out)));
  return section +
         Figure(HoldOutBars(record),
                metric ? "<span class=\"key c0\"></span>distance of triangulated points from the "
                         "board's, after the best rigid fit"
                         "<span class=\"key c2\"></span>distance between neighbouring points less "
                         "that on the board"
                       : "Reprojection error after only the board's pose was fitted.");
}

std::string LeftOutSection(const CalibrationRecord& record) {
  std::string section;
  if (record.result.outliers > 0) {
    section += Folded(Count(record.result.outliers, "point") + " left out as outliers",
                      OutliersTable(record));
  }
  if (!record.left_out.empty()) {
    section += Folded(Count(static_cast<int>(record.left_out.size()), "picture") + " left out (" +
                          LeftOutText(record.left_out) + ")",
                      LeftOutTable(record));
  }
  return section.empty() ? "" : "<h2>Left out</h2>\n" + section;
}

std::string BoardSection(const CalibrationRecord& record) {
  if (!record.result.ok() || !record.result.warp_fitted) return "";
  return "<h2>Board</h2>\n<div class=\"box\"><p>How far its middle bends out of the plane along "
         "each axis:</p>" +
         ValuesTable(record, -1) + "</div>\n";
}

std::string LensSection(const CalibrationRecord& record) {
  if (record.result.trials.empty()) return "";
  return "<h2>Lens models tried</h2>\n<div class=\"box\">" + TrialsTable(record) + "</div>\n";
}

const char* const kDefinitions =
    "<p class=\"soft\">RMS is the root of the mean squared length of the error vectors, as "
    "OpenCV's; per axis it is smaller by √2. Standard deviations follow from the noise that the "
    "fit left over. Pixel (0, 0) is the centre of the top left pixel. Rotations and translations "
    "are those of T_camera_rig; the rig's frame is the first camera's.</p>\n";

}  // namespace

std::string CalibrationPage(const CalibrationRecord& record) {
  std::string page = Head(record) + Cards(record) + AdviceBox(record.result);
  if (!record.result.cameras.empty()) {
    page += "<h2>Cameras</h2>\n<div class=\"box\">" + CamerasTable(record) + "</div>\n";
  }
  page += PicturesSection(record);
  for (size_t c = 0; c < record.input.cameras.size(); ++c) {
    page += CameraSection(record, static_cast<int>(c));
  }
  page += HoldOutSection(record) + BoardSection(record) + LensSection(record) +
          LeftOutSection(record) + kDefinitions;
  return Page("Camera calibration", page);
}

}  // namespace softforce::report
