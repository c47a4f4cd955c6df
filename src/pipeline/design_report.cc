#include <fmt/format.h>

#include <cmath>

#include "softforce/pipeline/design.h"

namespace softforce::pipeline {
namespace {

constexpr double kMillimetre = 1e-3;

std::string Cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

std::string Line(const std::string& name, double location, double most, double force, double I_w) {
  return fmt::format("  {:<34}{:>10}{:>12}{:>12}{:>14}\n", name, Cell(location / kMillimetre, 2),
                     Cell(most / kMillimetre, 2), Cell(1e3 * force, 1), Cell(I_w * kMillimetre, 2));
}

std::string Spacings(const DesignReport& report) {
  std::string text =
      "\nCandidates spread over where forces may act, with forces on all of them at once:\n"
      "                            enough    I_w,  sd of the forces, mN  told apart,\n"
      "  spacing, mm  candidates  markers    N/mm    median   largest     % of them\n";
  for (const design::CandidateGrid& grid : report.grids) {
    text += fmt::format("  {:>11.1f}{:>12}{:>9}{:>8}{:>10}{:>10}{:>14}\n",
                        grid.spacing / kMillimetre, grid.candidates,
                        grid.enough_markers ? "yes" : "no", Cell(grid.I_w * kMillimetre, 1),
                        Cell(1e3 * grid.force_sd, 1), Cell(1e3 * grid.worst_force_sd, 1),
                        grid.enough_markers ? Cell(100 * grid.told_apart, 0) : "-");
  }
  const int supported = report.SupportedGrid();
  text += supported < 0
              ? std::string("  Not even the widest are told apart.\n")
              : fmt::format("  Candidates {:.0f} mm apart are told apart, nine in ten at least.\n",
                            std::ceil(report.grids[supported].spacing / kMillimetre));
  text += fmt::format(
      "One force at a time: its 95 % region lies within half a spacing around it at {:.1f} mm\n"
      "(median), {:.1f} mm (at 90 % of the places).\n",
      report.spacing_of_one.median / kMillimetre, report.spacing_of_one.most / kMillimetre);
  return text;
}

}  // namespace

std::string DesignReport::BriefReport() const {
  if (stopped) return "stopped: nothing was written";
  return fmt::format(
      "{} of {} places: a force of {:.3g} N is expected to be located within {:.2f} mm, with the "
      "scene's markers {:.2f} mm, with random ones {:.2f} mm",
      markers.size(), places, load, best.location / kMillimetre, own.location / kMillimetre,
      random_location / kMillimetre);
}

std::string DesignReport::FullReport() const {
  if (stopped) return BriefReport() + "\n";
  std::string text = fmt::format(
      "{} markers chosen of {} places {:.1f} mm apart, for forces of {:.3g} N at {} places\n",
      markers.size(), places, spacing / kMillimetre, load, loads);
  text += rig_from.empty() ? "Without cameras: every coordinate equally noisy\n"
                           : fmt::format("Seen by the cameras (their place from: {})\n", rig_from);
  text +=
      "\n                                    expected error of the place, mm   of force\n"
      "                                        median      90 % of      median,      I_w with the\n"
      "                                                   places <           mN  candidates, "
      "N/mm\n";
  text += Line("chosen", best.location, best.location_most, best.force, best.I_w);
  text += Line("the scene's own markers", own.location, own.location_most, own.force, own.I_w);
  text += Line(fmt::format("random, median of {} layouts", random_layouts), random_location,
               random_location_most, NAN, NAN);
  text += Line("random, the best of them", random_best, NAN, NAN, NAN);
  text += Line("no markers (what is assumed)", best.location_of_unknown, NAN, NAN, NAN);
  text += Spacings(*this);
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  if (!usable()) {
    text +=
        "NOT USABLE: no markers among these places tell where forces act. Take more markers "
        "(--count), another surface (--on), or larger forces (--load).\n";
  }
  text += fmt::format(
      "\nWritten: {}: markers.yaml, markers.csv, design.png, location_error.vtu, "
      "summary.json\n",
      out.string());
  return text;
}

}  // namespace softforce::pipeline
