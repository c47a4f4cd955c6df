#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace softforce::testing {

using StlTriangles = std::vector<std::array<Eigen::Vector3d, 3>>;

// The surface of a cube, two triangles a side, in the file's unit.
inline StlTriangles CubeSurface(const Eigen::Vector3d& corner, double side) {
  const auto at = [&](int i) -> Eigen::Vector3d {
    return corner + side * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1);
  };
  constexpr int kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  StlTriangles triangles;
  for (const auto& s : kSides) {
    triangles.push_back({at(s[0]), at(s[1]), at(s[2])});
    triangles.push_back({at(s[0]), at(s[2]), at(s[3])});
  }
  return triangles;
}

inline StlTriangles Joined(const std::vector<StlTriangles>& surfaces) {
  StlTriangles all;
  for (const auto& surface : surfaces) all.insert(all.end(), surface.begin(), surface.end());
  return all;
}

inline std::string StlText(const StlTriangles& triangles) {
  std::ostringstream text;
  text.precision(9);
  text << "solid body of a test\n";
  for (const auto& triangle : triangles) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (const auto& corner : triangle) text << "  vertex " << corner.transpose() << '\n';
    text << " endloop\nendfacet\n";
  }
  return text.str() + "endsolid\n";
}

inline std::string StlBytes(const StlTriangles& triangles) {
  std::string bytes(80, ' ');
  const auto add = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) add(0.0f);
    for (const auto& corner : triangle) {
      for (int i = 0; i < 3; ++i) add(static_cast<float>(corner(i)));
    }
    add(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace softforce::testing
