#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace softforce::scene {

// A line of a CSV file. Cells are without spaces at their ends, and without quotes around them.
struct CsvLine {
  int number = 0;  // in the file, counted from 1
  std::vector<std::string> cells;

  bool IsBlank() const;
};

// All lines but those in which nothing but commas stands. Throws InputError if the file cannot be
// read.
std::vector<CsvLine> ReadCsvLines(const std::filesystem::path& file);

}  // namespace softforce::scene
