#include <fmt/format.h>

#include "softforce/pipeline/simulate.h"

namespace softforce::pipeline {

std::string SimulateReport::FullReport() const {
  if (stopped) return fmt::format("Stopped in frame {}: nothing was written\n", frames);
  std::string text = fmt::format("{} frames of a body of {} cells of order {}, {} nodes\n", frames,
                                 cells, order, nodes);
  if (frames > 0)
    text += fmt::format("  direct problem   {:.2f} s per frame\n", solve_seconds / frames);
  if (pictures > 0) {
    text += fmt::format("  pictures         {}, {:.1f} per second\n", pictures,
                        pictures / picture_seconds);
  }
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  text += fmt::format("\nRecording: {}\n", out.string());
  if (pictures > 0) {
    text += fmt::format("Try: softforce run {} --out {}\n", (out / "scene.yaml").string(),
                        (out / "results").string());
  } else {
    text += "It has no pictures, which softforce run needs: the markers are in markers3d.csv\n";
  }
  return text;
}

}  // namespace softforce::pipeline
