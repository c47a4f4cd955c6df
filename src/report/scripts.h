#pragma once

#include <string>

namespace softforce::report {

// What makes a run's charts readable with the pointer; web/run_page.js.
std::string RunPageScript();

// The body's 3-D view with all it needs; web/body_view.js. Empty if the program was built without
// it.
std::string BodyViewScript();

}  // namespace softforce::report
