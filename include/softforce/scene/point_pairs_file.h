#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "softforce/camera/rig.h"

namespace softforce::scene {

// A point of the robot and where a camera saw it, as a person wrote it down.
struct TypedPair {
  Eigen::Vector3d p_robot;  // m
  int camera = -1;          // of the rig
  Eigen::Vector2d pixel;    // px
  int line = 0;             // of the table, or item of the list, counted from 1
};

// Reads a table with the columns x_mm, y_mm, z_mm, camera, u_px, v_px (CSV), or a list "pairs" of
// maps with position, camera and pixel (.yaml, .yml). Throws InputError naming file and line for a
// column that is missing or unknown, a cell that is no number, or a camera that the rig lacks.
std::vector<TypedPair> ReadPointPairs(const std::filesystem::path& file, const camera::Rig& rig);

}  // namespace softforce::scene
