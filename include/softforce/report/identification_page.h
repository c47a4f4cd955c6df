#pragma once

#include <string>
#include <vector>

#include "softforce/estimation/identification.h"

namespace softforce::report {

// A known force, and what a run makes of the same observations with the values found; N.
struct ComparedForce {
  std::string state;  // "frames 20 to 29"
  int candidate = -1;
  double known = NAN, found = NAN;  // norms
};

// All that the page of an identification tells of.
struct IdentificationRecord {
  estimation::Identification found;
  std::vector<ComparedForce> forces;
  std::string text;  // the report for the terminal
};

// One HTML page with pictures (inline SVG): values before and after, what the body's movement was
// and what is left of it unexplained in every state, known forces beside those found. It needs no
// other file and no network.
std::string IdentificationPage(const IdentificationRecord& record);

}  // namespace softforce::report
