#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace softforce::scene {

// Numbers over time from a CSV file with one header line.
struct TimeTable {
  std::vector<std::string> columns;  // without "time_s"
  std::vector<double> time_s;        // ascending
  Eigen::MatrixXd values;            // rows like time_s, columns like `columns`
  std::vector<int> lines;            // of each row in the file, counted from 1
};

enum class Columns { kAll, kSome };  // that must be there

// Reads the column "time_s" and, in the order of `names`, those called so. Throws InputError naming
// file, line and column if one is missing, unknown or there twice, or a cell is no number.
TimeTable ReadTimeTable(const std::filesystem::path& file, const std::vector<std::string>& names,
                        Columns which = Columns::kAll);

// Linear between the rows, held before the first and after the last.
Eigen::VectorXd Interpolate(const std::vector<double>& time_s, const Eigen::MatrixXd& rows,
                            double time);

}  // namespace softforce::scene
