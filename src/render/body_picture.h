#pragma once

#include <array>
#include <vector>

#include "render/depth_buffer.h"
#include "render/view.h"
#include "softforce/mesh/surface.h"

namespace softforce::render {

// The body as one camera sees it.
struct BodyPicture {
  std::vector<Sight> nodes;        // as many as columns of x; set for nodes of the surface
  std::vector<bool> faces_camera;  // of each triangle
  DepthBuffer depth;               // its triangles are pieces, see NodesOfPiece
};

// The flat pieces of the surface's triangles: one of 3 nodes, of 6 five, of which the last is the
// whole triangle, and stands for the others where these lie in its plane.
int NumPieces(const mesh::Surface& surface);
std::array<int, 3> NodesOfPiece(const mesh::Surface& surface, int piece);

// Whether b is seen so close to the middle between a and c that a straight line shows all three.
bool IsMiddle(const Sight& a, const Sight& b, const Sight& c);

// In memory that was used before; nothing else of what it held is kept.
void PictureBody(const View& view, const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                 BodyPicture* body);

}  // namespace softforce::render
