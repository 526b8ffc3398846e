// Procedural bodies, with z up; all lengths in metres. The centre of a body is at the origin; that of a half pipe is
// the middle of its axis. All but the plane are watertight, with triangles that are counter-clockwise seen from
// outside. Vertices of round parts lie on the exact surface, so a convex shape contains its mesh.
#pragma once

#include "physics/mesh/mesh.hpp"

namespace weft::mesh {

/// Geodesic sphere with about `segments` edges around it: an icosahedron whose edges are cut into an even number of
/// pieces, with all vertices moved radially onto the sphere. The six points on the axes are
/// vertices, so the bounding box is that of the sphere.
Mesh make_sphere(double radius, int segments);

/// Box with edge lengths `size` [m]. Its edges and corners are rounded with the radius `bevel` [m], at most 0.49 of the
/// smallest edge length (larger values are reduced); 0: sharp. A rounded edge has segments / 8 faces across, at least
/// one.
Mesh make_box(const Vec3& size, double bevel, int segments);

/// Cone around the z axis, with the base at z = -height / 2 and the tip at z = +height / 2. `segments`: number of edges
/// around the axis; values below 3 count as 3 (also for the torus and the cylinder).
Mesh make_cone(double radius, double height, int segments);

/// Ring around the z axis. `radius` is the distance of the tube's centre line from the axis; `tube_radius` < `radius`.
Mesh make_torus(double radius, double tube_radius, int segments);

/// Cylinder around the z axis, from z = -height / 2 to z = +height / 2.
Mesh make_cylinder(double radius, double height, int segments);

/// Lower half of a pipe around the x axis, open upward, with rims at z = 0, from x = -length / 2 to x = +length / 2.
/// `radius` is the inner radius; the wall of thickness `thickness` lies outside of it. The half turn has segments / 2
/// faces, at least two.
Mesh make_half_pipe(double radius, double length, double thickness, int segments);

/// One quad in the plane z = 0, front toward +z. `size`: edge lengths along x and y [m].
Mesh make_plane(const Vec2& size);

}  // namespace weft::mesh
