#include "softforce/mesh/surface.h"

#include <algorithm>
#include <array>

namespace softforce::mesh {
namespace {

// The faces of an element, counter-clockwise seen from outside: three corners, then the middles of
// the edges between them.
constexpr int kFaces[4][6] = {
    {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}};

struct Face {
  std::array<int, 3> corners;  // ascending: the same for both elements of the face
  int index;                   // 4 · element + number of the face
};

}  // namespace

Surface ExtractSurface(const TetMesh& mesh) {
  std::vector<Face> faces(4 * mesh.num_elements());
  for (int index = 0; index < static_cast<int>(faces.size()); ++index) {
    Face& face = faces[index];
    face.index = index;
    for (int i = 0; i < 3; ++i) face.corners[i] = mesh.elements(kFaces[index % 4][i], index / 4);
    std::sort(face.corners.begin(), face.corners.end());
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.corners < b.corners; });

  std::vector<int> boundary;
  for (auto first = faces.begin(); first != faces.end();) {
    const auto last = std::find_if(
        first, faces.end(), [&](const Face& face) { return face.corners != first->corners; });
    if (last - first == 1) boundary.push_back(first->index);
    first = last;
  }
  std::sort(boundary.begin(), boundary.end());

  Surface surface;
  surface.triangles.resize(mesh.order() == 2 ? 6 : 3, static_cast<int>(boundary.size()));
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const int element = boundary[t] / 4;
    surface.element.push_back(element);
    for (int i = 0; i < surface.triangles.rows(); ++i) {
      surface.triangles(i, t) = mesh.elements(kFaces[boundary[t] % 4][i], element);
    }
  }
  return surface;
}

}  // namespace softforce::mesh
