#include "softforce/base/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <string_view>

#include "softforce/base/input_error.h"

namespace softforce::base {
namespace {

struct Unit {
  const char* symbol;
  Dimension dimension;
  double in_si;
};

constexpr double kDegree = 3.14159265358979323846 / 180;  // rad

constexpr Unit kUnits[] = {
    {"m", Dimension::kLength, 1},
    {"cm", Dimension::kLength, 1e-2},
    {"mm", Dimension::kLength, 1e-3},
    {"um", Dimension::kLength, 1e-6},
    {"\u00b5m", Dimension::kLength, 1e-6},  // the micro sign of keyboards
    {"\u03bcm", Dimension::kLength, 1e-6},  // the Greek letter, which looks the same
    {"N", Dimension::kForce, 1},
    {"mN", Dimension::kForce, 1e-3},
    {"kN", Dimension::kForce, 1e3},
    {"Pa", Dimension::kPressure, 1},
    {"kPa", Dimension::kPressure, 1e3},
    {"MPa", Dimension::kPressure, 1e6},
    {"GPa", Dimension::kPressure, 1e9},
    {"kg/m^3", Dimension::kDensity, 1},
    {"g/cm^3", Dimension::kDensity, 1e3},
    {"m/s^2", Dimension::kAcceleration, 1},
    {"mm/s^2", Dimension::kAcceleration, 1e-3},
    {"s", Dimension::kTime, 1},
    {"ms", Dimension::kTime, 1e-3},
    {"Hz", Dimension::kFrequency, 1},
    {"kHz", Dimension::kFrequency, 1e3},
    {"rad", Dimension::kAngle, 1},
    {"mrad", Dimension::kAngle, 1e-3},
    {"deg", Dimension::kAngle, kDegree},
};

// What a dimension is called in messages, and a value that shows how it is written.
struct Kind {
  const char* name;
  const char* example_number;
  const char* example_unit;
};

Kind KindOf(Dimension dimension) {
  switch (dimension) {
    case Dimension::kNumber:
      return {"a number without unit", "0.5", ""};
    case Dimension::kLength:
      return {"a length", "6", "mm"};
    case Dimension::kForce:
      return {"a force", "0.5", "N"};
    case Dimension::kPressure:
      return {"a pressure", "290", "kPa"};
    case Dimension::kDensity:
      return {"a density", "1070", "kg/m^3"};
    case Dimension::kAcceleration:
      return {"an acceleration", "9.81", "m/s^2"};
    case Dimension::kTime:
      return {"a time", "0.1", "s"};
    case Dimension::kFrequency:
      return {"a rate", "30", "Hz"};
    case Dimension::kAngle:
      return {"an angle", "30", "deg"};
  }
  assert(false);
  return {};
}

std::string UnitsOf(Dimension dimension) {
  std::string units;
  for (const Unit& unit : kUnits) {
    if (unit.dimension == dimension)
      units += (units.empty() ? "" : ", ") + std::string(unit.symbol);
  }
  return units;
}

std::string Example(Dimension dimension, int count) {
  const Kind kind = KindOf(dimension);
  std::string example = "Write for example:";
  for (int i = 0; i < count; ++i) example += std::string(" ") + kind.example_number;
  return *kind.example_unit ? example + " " + kind.example_unit : example;
}

std::string Expected(Dimension dimension) {
  const std::string units = UnitsOf(dimension);
  return std::string("expected ") + KindOf(dimension).name + (units.empty() ? "" : " in " + units);
}

std::string_view WithoutLeadingSpace(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

// Takes a number off the front of `text`, or leaves `text` alone and returns false. A number too
// large for a double becomes infinite.
bool TakeNumber(std::string_view& text, double& number) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [rest, error] = std::from_chars(begin, end, number);
  if (error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) number = INFINITY;
  text.remove_prefix(rest - text.data());
  return true;
}

struct Split {
  std::vector<double> numbers;
  std::string unit;
};

Split SplitQuantity(std::string_view text) {
  Split split;
  double number = NAN;
  text = WithoutLeadingSpace(text);
  while (TakeNumber(text, number)) {
    split.numbers.push_back(number);
    text = WithoutLeadingSpace(text);
  }
  split.unit = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  return split;
}

// `count`: how many numbers the example shall show.
double UnitOrThrow(const std::string& unit, Dimension dimension, int count,
                   const std::string& where) {
  if (unit.empty() && dimension == Dimension::kNumber) return 1;
  const auto found = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [&](const Unit& known) { return known.symbol == unit; });
  if (found != std::end(kUnits) && found->dimension == dimension) return found->in_si;

  std::string got = fmt::format("the unknown unit \"{}\"", unit);
  if (unit.empty()) got = "no unit";
  if (found != std::end(kUnits)) {
    got = fmt::format("the unit \"{}\" of {}", unit, KindOf(found->dimension).name);
  }
  throw InputError(where, "got " + got + ", " + Expected(dimension), Example(dimension, count));
}

}  // namespace

double UnitInSi(const std::string& unit, Dimension dimension, const std::string& where) {
  return UnitOrThrow(unit, dimension, 1, where);
}

std::vector<double> ParseQuantity(const std::string& text, Dimension dimension, int count,
                                  const std::string& where) {
  const auto fail = [&](const std::string& problem) {
    throw InputError(where, fmt::format("got \"{}\", {}", text, problem),
                     Example(dimension, count));
  };
  auto [numbers, unit] = SplitQuantity(text);

  if (numbers.empty()) fail("which does not start with a number; " + Expected(dimension));
  if (static_cast<int>(numbers.size()) != count) {
    fail(fmt::format("which has {} number{}, expected {}", numbers.size(),
                     numbers.size() == 1 ? "" : "s", count));
  }
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(numbers.begin(), numbers.end(), is_finite)) {
    fail("which is not finite; expected ordinary numbers");
  }
  const double in_si = UnitOrThrow(unit, dimension, count, fmt::format("{}: \"{}\"", where, text));
  for (double& number : numbers) number *= in_si;
  return numbers;
}

}  // namespace softforce::base
