#pragma once

namespace softforce::report {

// The style sheet of the page.
extern const char* const kPageStyle;

}  // namespace softforce::report
