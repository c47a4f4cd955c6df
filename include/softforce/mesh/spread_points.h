#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::mesh {

// Points spread evenly over triangles of the surface (nodes at X, 3×N, m): no two are closer than
// `spacing` (m, straight through the body), and no suitable place is further than that from all of
// them, as far as samples a quarter of the spacing apart show it. `suitable` is asked only for
// places that would be taken. Starts near the middle of the triangles; the same input gives the
// same points. Empty if nothing is suitable.
std::vector<SurfacePoint> SpreadPoints(const Surface& surface, const Eigen::Matrix3Xd& X,
                                       const std::vector<int>& triangles, double spacing,
                                       const std::function<bool(const SurfacePoint&)>& suitable);

}  // namespace softforce::mesh
