// A soft robot of our own design: four legs lean inwards and carry a platform.
// Units: mm. The feet stand on z = 0, one on each side of the axes' origin.
// README.md has the command that meshes this.
SetFactory("OpenCASCADE");

height = 100;      // of the platform's top
plate = 12;        // thickness of the platform
radius = 20;       // of the platform, an octagon's circumscribed circle
foot = 58;         // from the axis to the middle of a foot
knee = 14;         // from the axis to where the middle of a leg meets the platform
thick = 13;        // of a leg, in the direction in which it leans
wide = 16;         // of a leg, across
size = 5.75;       // wanted edge length of the tetrahedra

// The platform: an octagonal plate.
base = height - plate;
For i In {0:7}
  Point(100 + i) = {radius * Cos((2 * i + 1) * Pi / 8), radius * Sin((2 * i + 1) * Pi / 8), base};
EndFor
For i In {0:7}
  Line(100 + i) = {100 + i, 100 + (i + 1) % 8};
EndFor
Curve Loop(100) = {100:107};
Plane Surface(100) = {100};
platform() = Extrude {0, 0, plate} { Surface{100}; };

// A leg: its foot moved straight to the platform's underside, and a little into it.
top = base + plate / 2;
For i In {0:3}
  s = newp;
  Point(s) = {foot - thick / 2, -wide / 2, 0};
  Point(s + 1) = {foot + thick / 2, -wide / 2, 0};
  Point(s + 2) = {foot + thick / 2, wide / 2, 0};
  Point(s + 3) = {foot - thick / 2, wide / 2, 0};
  l = newl;
  For k In {0:3}
    Line(l + k) = {s + k, s + (k + 1) % 4};
  EndFor
  c = newll;
  Curve Loop(c) = {l:l + 3};
  f = news;
  Plane Surface(f) = {c};
  Rotate {{0, 0, 1}, {0, 0, 0}, i * Pi / 2} { Surface{f}; }
  legs~{i}() = Extrude {(knee - foot) * Cos(i * Pi / 2), (knee - foot) * Sin(i * Pi / 2), top} { Surface{f}; };
EndFor
BooleanUnion{ Volume{platform(1)}; Delete; }{ Volume{legs_0(1), legs_1(1), legs_2(1), legs_3(1)}; Delete; }

e = 1e-3;
far = foot + thick;
Physical Volume("robot") = Volume{:};
Physical Surface("feet") = Surface In BoundingBox {-far, -far, -e, far, far, e};
Physical Surface("platform_top") = Surface In BoundingBox {-far, -far, height - e, far, far, height + e};

Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
