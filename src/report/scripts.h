#pragma once

#include <string>

namespace softforce::report {

// What makes a run's charts readable with the pointer; web/run_page.js.
std::string RunPageScript();

// The body's 3-D view with all it needs; web/report_view.js. Empty if the program was built without
// it.
std::string BodyViewScript();

// What fills the live page; web/live_page.js. And its 3-D view, as above; web/live_view.js.
std::string LivePageScript();
std::string LiveViewScript();

}  // namespace softforce::report
