#pragma once

#include <Eigen/Core>
#include <optional>

#include "mesh/read_stl.h"

namespace softforce::mesh {

// A place where an edge of the surface runs through a triangle that it does not belong to.
std::optional<Eigen::Vector3d> FindCrossing(const StlSurface& surface);

}  // namespace softforce::mesh
