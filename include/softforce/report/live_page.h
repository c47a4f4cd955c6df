#pragma once

#include <string>
#include <vector>

#include "softforce/report/run_report.h"

namespace softforce::report {

// The page that shows a run while it goes on, as files that are served beside each other. It asks
// for /events, /shape, /view, /history and /pictures/0, and posts to /tare, /record, /pause and
// /stop; see docs/live_page.md.
struct LivePageFiles {
  std::string html, style, script;
  std::string view_script;  // nothing if the program was built without its 3-D view
};

LivePageFiles MakeLivePage();

// The body at rest, and in one frame, as JSON for the page's 3-D view.
std::string LiveShape(const BodyShape& body, const std::vector<std::string>& marker_statuses);
std::string LiveView(const BodyView& view);

}  // namespace softforce::report
