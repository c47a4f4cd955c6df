#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softforce/validation/study.h"

namespace softforce::validation {

// A figure of the study, beside the paper's. NaN where there is none.
struct Figure {
  std::string table;   // "I", "II", "III"
  std::string layout;  // "s1"
  std::string error;   // what the inverse model has wrong: "none", "modulus", "markers", "tension"
  double size = 0;     // of it: kPa, mm or N
  std::string quantity;  // "I_w" or "I_e"
  std::string how;  // "converged", "linear", "least squares", "remedied", "remedied, selected", …
  double value = NAN;  // I_e in mN, I_w in N/mm
  double paper = NAN;  // the same in the paper
};

// All figures, in the order of the tables.
std::vector<Figure> Figures(const Study& study);

// Tables I, II and III for people.
std::string TextTables(const Study& study);

// Makes the folder if it is missing. Throws InputError unless validation.csv can be written there:
// to be called before minutes of work.
void PrepareCsv(const std::filesystem::path& folder);

// Writes validation.csv in the folder: a line per figure, under a header. Throws InputError if it
// cannot be written.
std::filesystem::path WriteCsv(const std::filesystem::path& folder, const Study& study);

}  // namespace softforce::validation
