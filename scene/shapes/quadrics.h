// Shapes as triangles, in coordinates of their own. The corners of curved ones lie slightly outside
// the shape, so that its area, and with it the power of an area light, is exact.
#pragma once

#include "scene/shapes/mesh_data.h"

namespace bnvpl {

// Spheres and cylinders about the z axis between two heights, facing outwards; disks at a height,
// facing +z. They run from the x axis to `phiRad`. Radii are not negative.
MeshData sphereMesh(double radius, double zMin, double zMax, double phiRad);
MeshData diskMesh(double radius, double innerRadius, double height, double phiRad);
MeshData cylinderMesh(double radius, double zMin, double zMax, double phiRad);

// A rectangle about the origin of the plane z = 0, facing +z; its width runs along x.
MeshData rectangleMesh(double width, double height);

}  // namespace bnvpl
