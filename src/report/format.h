#pragma once

#include <string>

#include "softforce/calibration/calibrate.h"

namespace softforce::report {

// Three significant digits, "–" for what is not known.
std::string Short(double value);

// A value and its standard deviation with the same number of decimals, two significant digits of
// the latter.
struct ValueText {
  std::string value, sd, unit;
};

// For people: rotations in degrees, lengths in millimetres.
ValueText TextOf(const calibration::CalibratedValue& value);
ValueText TextOf(double value, double sd, const std::string& unit);

// "1 view", "2 views".
std::string Count(int count, const std::string& thing);

// Safe inside HTML text and attributes.
std::string Escape(const std::string& text);

}  // namespace softforce::report
