#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

namespace softforce::testing {

// A number below 2^24 in a picture, as a row of 32 black and white blocks along its top edge: 24
// bits and 8 to check them by. It survives compression.
inline int BarCodeBlock(cv::Size size) { return std::max(4, size.width / 40); }  // px

inline uint32_t WithCheck(uint32_t number) {
  const uint32_t check = (number ^ (number >> 8) ^ (number >> 16) ^ 0xA5) & 0xFF;
  return (number << 8) | check;
}

inline void PaintNumber(uint32_t number, cv::Mat* picture) {
  const int block = BarCodeBlock(picture->size());
  const uint32_t code = WithCheck(number & 0xFFFFFF);
  for (int bit = 0; bit < 32; ++bit) {
    const cv::Rect place(bit * block, 0, block, block);
    (*picture)(place).setTo((code >> (31 - bit)) & 1 ? 235 : 20);
  }
}

// Nothing if the check fails: no number, or a damaged picture.
inline std::optional<uint32_t> ReadNumber(const cv::Mat& picture) {
  const int block = BarCodeBlock(picture.size());
  uint32_t code = 0;
  for (int bit = 0; bit < 32; ++bit) {
    const cv::Mat place = picture(cv::Rect(bit * block, 0, block, block));
    code = (code << 1) | (cv::mean(place)[0] > 127 ? 1 : 0);
  }
  if (WithCheck(code >> 8) != code) return std::nullopt;
  return code >> 8;
}

}  // namespace softforce::testing
