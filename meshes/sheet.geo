// A soft sheet, 200 x 200 x 10 mm, clamped at its four corners.
// Units: mm. Top face at z = height. README.md has the command that meshes this.
SetFactory("OpenCASCADE");

side = 200;
height = 10;
clamp = 10;  // side of the square at each corner that a fixture holds
size = 8.84;  // wanted edge length of the tetrahedra

// The clamped corners are blocks of their own that share faces with the rest, so that elements end
// exactly where the clamps do.
Box(1) = {0, 0, 0, side, side, height};
Box(2) = {0, 0, 0, clamp, clamp, height};
Box(3) = {side - clamp, 0, 0, clamp, clamp, height};
Box(4) = {0, side - clamp, 0, clamp, clamp, height};
Box(5) = {side - clamp, side - clamp, 0, clamp, clamp, height};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2:5}; Delete; }

e = 1e-3;
clamps() = {};
For i In {0:1}
  For j In {0:1}
    x = i * (side - clamp);
    y = j * (side - clamp);
    clamps() += Surface In BoundingBox {x - e, y - e, -e, x + clamp + e, y + clamp + e, e};
    clamps() += Surface In BoundingBox {x - e, y - e, height - e, x + clamp + e, y + clamp + e, height + e};
  EndFor
EndFor

Physical Volume("sheet") = Volume{:};
Physical Surface("top") = Surface In BoundingBox {-e, -e, height - e, side + e, side + e, height + e};
Physical Surface("bottom") = Surface In BoundingBox {-e, -e, -e, side + e, side + e, e};
Physical Surface("clamps") = clamps();

Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
