#pragma once

#include <Eigen/Core>
#include <filesystem>

namespace softforce::mesh {

inline constexpr char kStlAdvice[] = "Export it again, as binary or text STL of a solid.";

// The corners of an .stl file's triangles, three columns each, as they stand in the file. Throws
// InputError if it is empty or damaged, text or binary.
Eigen::Matrix3Xd ReadStlCorners(const std::filesystem::path& path);

}  // namespace softforce::mesh
