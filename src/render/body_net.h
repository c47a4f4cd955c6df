#pragma once

#include <vector>

#include "render/body_picture.h"
#include "render/brush.h"
#include "render/surface_edges.h"

namespace softforce::render {

// The edges of the visible faces: thin and translucent, `opacity` of 1, stronger along the outline
// and sharp ridges.
void DrawNet(Brush* brush, const View& view, const mesh::Surface& surface,
             const Eigen::Matrix3Xd& x, const BodyPicture& body, const std::vector<Edge>& edges,
             const cv::Vec3b& colour, double opacity);

}  // namespace softforce::render
