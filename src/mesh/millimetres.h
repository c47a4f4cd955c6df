#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

namespace softforce::mesh {

// "(1.50, 0.00, -3.25) mm": a place (m) in messages.
inline std::string InMillimetres(const Eigen::Vector3d& p, int decimals = 3) {
  const double power = std::pow(10, decimals);
  // + 0.0: a small negative number is shown as 0.00, not as -0.00
  const auto rounded = [&](double metres) {
    return std::round(1e3 * metres * power) / power + 0.0;
  };
  return fmt::format("({:.{}f}, {:.{}f}, {:.{}f}) mm", rounded(p.x()), decimals, rounded(p.y()),
                     decimals, rounded(p.z()), decimals);
}

}  // namespace softforce::mesh
