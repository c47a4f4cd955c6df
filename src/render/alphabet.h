#pragma once

#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>

namespace softforce::render {

// A letter's coverage of the pixels, and where its top-left pixel lies from the pen's.
struct Letter {
  cv::Mat1b coverage;
  cv::Point corner;
};

// The letters of OpenCV's font in any size, stroke and place between two pixels. OpenCV draws them
// slowly, and in whole pixels only: each is drawn once, in a larger size, scaled down and kept.
class Alphabet {
 public:
  // `x` is where the pen stands on the baseline, px, of which what is beyond the whole pixel is
  // taken, in quarters.
  const Letter& Draw(char letter, double scale, double width, double x);

  // How far the pen goes for these letters, px at a scale of 1.
  static double Advance(const std::string& text);

  static constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;

 private:
  std::map<std::tuple<char, double, double, int>, Letter> letters_;
};

}  // namespace softforce::render
