#include "report/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace softforce::report {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

}  // namespace

std::string Short(double value) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return fmt::format("{:.{}f}", value, std::clamp(3 - before, 0, 6));
}

ValueText TextOf(double value, double sd, const std::string& unit) {
  int decimals = 6;
  if (std::isfinite(sd) && sd > 0) {
    decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sd))), 0, 9);
  }
  return {fmt::format("{:.{}f}", value, decimals),
          std::isfinite(sd) ? fmt::format("{:.{}f}", sd, decimals) : "–", unit};
}

ValueText TextOf(const calibration::CalibratedValue& value) {
  if (value.unit == "m") return TextOf(1e3 * value.value, 1e3 * value.sd, "mm");
  if (value.unit == "rad") return TextOf(kDegrees * value.value, kDegrees * value.sd, "°");
  return TextOf(value.value, value.sd, value.unit);
}

std::string Count(int count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string Escape(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

}  // namespace softforce::report
