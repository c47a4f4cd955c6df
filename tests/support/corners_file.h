#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "softforce/calibration/calibrate.h"

namespace softforce::testing {

// What a left and a right camera saw of a chessboard with 9×6 inner corners, 25 mm apart, in
// pictures of 640×480 px: a table as datasets/opencv_chessboard/corners.csv.
inline calibration::CalibrationInput ReadCorners(const std::filesystem::path& file,
                                                 calibration::LensFit lens) {
  calibration::CalibrationInput input;
  for (int i = 0; i < 9 * 6; ++i) input.board.emplace_back(0.025 * (i % 9), 0.025 * (i / 9), 0);
  for (const char* name : {"left", "right"}) input.cameras.push_back({name, 640, 480, lens});
  std::ifstream table(file);
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string view, camera;
    int id;
    double x, y, xx, xy, yy;
    if (!(words >> view >> camera >> id >> x >> y >> xx >> xy >> yy)) {
      throw std::runtime_error(file.string() + ": " + line);
    }
    if (input.views.empty() || input.views.back().name != view) {
      input.views.push_back({view, std::vector<vision::BoardView>(2)});
    }
    vision::BoardView& seen = input.views.back().seen[camera == "left" ? 0 : 1];
    seen.ids.push_back(id);
    seen.pixels.emplace_back(x, y);
    Eigen::Matrix2d covariance;
    covariance << xx, xy, xy, yy;
    seen.covariances.push_back(covariance);
  }
  if (input.views.empty()) throw std::runtime_error(file.string() + ": cannot be read");
  return input;
}

}  // namespace softforce::testing
