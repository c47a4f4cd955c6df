#pragma once

#include <string>
#include <vector>

namespace softforce::validation {

// What the paper prints for a layout in its Tables I, II and III.
struct PaperFigures {
  double I_e_mN;      // exact inverse model
  double I_w_per_mm;  // N/mm
  // mN, for the errors of kWrongModuli, kMarkerShifts and kTensionErrors; empty where the paper
  // has none.
  std::vector<double> modulus, markers, tension;
};

// Throws std::out_of_range for a name that is not among s1 … s8, r1 … r8.
const PaperFigures& FiguresOf(const std::string& layout);

}  // namespace softforce::validation
