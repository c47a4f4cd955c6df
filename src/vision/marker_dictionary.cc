#include "vision/marker_dictionary.h"

#include <fmt/format.h>

#include "softforce/base/input_error.h"
#include "softforce/vision/marker_cells.h"

namespace softforce::vision {
namespace {

struct Named {
  const char* name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME value;
};

constexpr Named kDictionaries[] = {
    {"4X4_50", cv::aruco::DICT_4X4_50},           {"4X4_100", cv::aruco::DICT_4X4_100},
    {"4X4_250", cv::aruco::DICT_4X4_250},         {"4X4_1000", cv::aruco::DICT_4X4_1000},
    {"5X5_50", cv::aruco::DICT_5X5_50},           {"5X5_100", cv::aruco::DICT_5X5_100},
    {"5X5_250", cv::aruco::DICT_5X5_250},         {"5X5_1000", cv::aruco::DICT_5X5_1000},
    {"6X6_50", cv::aruco::DICT_6X6_50},           {"6X6_100", cv::aruco::DICT_6X6_100},
    {"6X6_250", cv::aruco::DICT_6X6_250},         {"6X6_1000", cv::aruco::DICT_6X6_1000},
    {"7X7_50", cv::aruco::DICT_7X7_50},           {"7X7_100", cv::aruco::DICT_7X7_100},
    {"7X7_250", cv::aruco::DICT_7X7_250},         {"7X7_1000", cv::aruco::DICT_7X7_1000},
    {"ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
};

}  // namespace

cv::Ptr<cv::aruco::Dictionary> MarkerDictionary(const std::string& name, const std::string& where) {
  std::string known;
  for (const Named& dictionary : kDictionaries) {
    if (name == dictionary.name) return cv::aruco::getPredefinedDictionary(dictionary.value);
    known += std::string(known.empty() ? "" : ", ") + dictionary.name;
  }
  throw base::InputError(where, fmt::format("\"{}\" is not known; expected one of {}", name, known),
                         "These are OpenCV's names without \"DICT_\".");
}

int MarkersIn(const std::string& name, const std::string& where) {
  return MarkerDictionary(name, where)->bytesList.rows;
}

cv::Mat1b DrawMarker(const std::string& dictionary, int id, const std::string& where) {
  const auto markers = MarkerDictionary(dictionary, where);
  if (id < 0 || id >= markers->bytesList.rows) {
    throw base::InputError(where, fmt::format("dictionary {} has no marker {}, its ids are 0 to {}",
                                              dictionary, id, markers->bytesList.rows - 1));
  }
  cv::Mat1b cells;
  cv::aruco::drawMarker(markers, id, markers->markerSize + 2, cells);
  return cells;
}

}  // namespace softforce::vision
