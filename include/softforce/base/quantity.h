#pragma once

#include <string>
#include <vector>

namespace softforce::base {

// What a number in a file for people measures. Every kind but kNumber must carry a unit.
enum class Dimension {
  kNumber,
  kLength,
  kForce,
  kPressure,
  kDensity,
  kAcceleration,
  kTime,
  kFrequency,
  kAngle
};

// The size of one `unit` in SI, e.g. UnitInSi("mm", kLength) = 1e-3.
// Throws InputError, naming `where`, if the unit is unknown or measures something else.
double UnitInSi(const std::string& unit, Dimension dimension, const std::string& where);

// Reads "290 kPa" or "65 130 10 mm": `count` numbers and one unit at the end, converted to SI.
// Throws InputError, naming `where`, on a missing or wrong unit, a wrong count, or a number that is
// not finite.
std::vector<double> ParseQuantity(const std::string& text, Dimension dimension, int count,
                                  const std::string& where);

}  // namespace softforce::base
