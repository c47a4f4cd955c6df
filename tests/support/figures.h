#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace softforce::testing {

// Prints a figure that a test has measured, and records it in the test's report.
inline double Record(const std::string& what, double figure) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", figure);
  std::printf("%s: %s\n", what.c_str(), text);
  ::testing::Test::RecordProperty(what, text);
  return figure;
}

// The same beside a published figure, or another `reference`; returns the relative difference.
inline double Compare(const std::string& what, double ours, double theirs,
                      const std::string& reference = "published") {
  const double error = ours / theirs - 1;
  char text[96];
  std::snprintf(text, sizeof text, "%.6g, %s %.6g, %+.2f %%", ours, reference.c_str(), theirs,
                100 * error);
  std::printf("%s: %s\n", what.c_str(), text);
  ::testing::Test::RecordProperty(what, text);
  return error;
}

}  // namespace softforce::testing
