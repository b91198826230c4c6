// A lug of aluminium in mm: a plate with a foot and a bore, meshed by 10-node tetrahedra with straight edges.
SetFactory("OpenCASCADE");
Box(1) = {0, -15, 0, 50, 30, 8};
Cylinder(2) = {50, 0, 0, 0, 0, 8, 15};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {50, 0, -1, 0, 0, 10, 7};
BooleanDifference(5) = { Volume{3}; Delete; }{ Volume{4}; Delete; };

foot() = Surface In BoundingBox {-0.1, -15.1, -0.1, 0.1, 15.1, 8.1};
bore() = Surface In BoundingBox {42.9, -7.1, -0.1, 57.1, 7.1, 8.1};
Physical Surface("FOOT") = {foot()};
Physical Surface("BORE") = {bore()};
Physical Volume("LUG") = {Volume{:}};

Mesh.MeshSizeMin = 13;
Mesh.MeshSizeMax = 13;
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 1;
Mesh.MshFileVersion = 4.1;
