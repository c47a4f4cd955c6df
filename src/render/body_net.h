#pragma once

#include "render/brush.h"
#include "render/depth_buffer.h"
#include "render/view.h"
#include "softforce/mesh/surface.h"

namespace softforce::render {

// The body as one camera sees it.
struct BodyPicture {
  std::vector<Sight> nodes;        // as many as columns of x; set for nodes of the surface
  std::vector<bool> faces_camera;  // of each triangle
  DepthBuffer depth;
};

BodyPicture PictureBody(const View& view, const mesh::Surface& surface, const Eigen::Matrix3Xd& x);

// The edges of the visible faces: thin and translucent, stronger along the outline and sharp
// ridges.
void DrawNet(Brush* brush, const View& view, const mesh::Surface& surface,
             const Eigen::Matrix3Xd& x, const BodyPicture& body);

}  // namespace softforce::render
