#pragma once

#include <string>
#include <vector>

#include "softforce/mesh/surface.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// The selectors that AddSurfaceGroups knows, a line each, for the help of commands.
extern const char kSelectorHelp[];

// Names parts of the surface. Each request is "NAME=SELECTOR", where SELECTOR is one of
//   x-min x-max y-min …      what lies in the outermost plane on that side
//   plane(0 0 5 mm, 0 0 1)   what lies in the plane through a point, across a direction
//   box(0 0 0, 9 9 9 mm)     triangles within a box, given by two opposite corners
//   normal(0 0 1, 10 deg)    triangles that face a direction, up to an angle
//   near(1 2 3 mm, 30 deg)   the smooth part of the surface closest to a point: up to edges where
//                            neighbouring triangles meet at more than the angle
//   cavity, outer            surfaces around hollows within the body; all the others
// or several of them joined by " & ": what all of them select. Requests of the same name add up. A
// request with `cavity` that selects several hollows gives a group for each, "NAME-1", "NAME-2", …,
// ordered by their centres' x, then y, then z. Coordinates are those of the mesh. Throws InputError
// naming `where` if a request cannot be read, selects nothing, or the mesh has that name already.
TetMesh WithSurfaceGroups(TetMesh mesh, const std::vector<std::string>& requests,
                          const std::string& where);

// The triangles of the surface, by index, that a named group of its mesh is made of. Throws
// InputError naming `where` if the mesh has no such group.
std::vector<int> GroupTriangles(const std::string& group, const TetMesh& mesh,
                                const Surface& surface, const std::string& where);

}  // namespace softforce::mesh
