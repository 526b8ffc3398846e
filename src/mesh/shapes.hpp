// Procedural bodies in closed form, made for z up and centred on the origin. All but the plane are watertight with
// outward counter-clockwise triangles. Vertices of round parts lie on the true surface, so that polyhedra of convex
// shapes are inscribed.
#pragma once

#include "mesh/mesh.hpp"

namespace weft::mesh {

/// Geodesic sphere: an icosahedron whose sides are cut into an even number of pieces, about `segments` edges around.
/// The six points on the axes are vertices, so the bounding box is that of the sphere.
Mesh make_sphere(double radius, int segments);

/// Box of full sizes `size` [m]. With `bevel` > 0 its edges and corners are rounded with that radius [m], cut to 0.49
/// of the smallest size; a quarter turn gets segments / 8 faces, at least one.
Mesh make_box(const Vec3& size, double bevel, int segments);

/// Base at z = -height / 2, tip at +height / 2.
Mesh make_cone(double radius, double height, int segments);

/// Ring around the z axis; `tube_radius` < `radius`, the distance of the tube's middle from the axis.
Mesh make_torus(double radius, double tube_radius, int segments);

/// Axis along z from -height / 2 to +height / 2.
Mesh make_cylinder(double radius, double height, int segments);

/// Lower half of a pipe around the x axis, open upward, rims at z = 0: inner `radius`, wall `thickness` outside of it,
/// from x = -length / 2 to +length / 2. The half turn gets segments / 2 faces.
Mesh make_half_pipe(double radius, double length, double thickness, int segments);

/// One quad in the plane z = 0, front toward +z.
Mesh make_plane(const Vec2& size);

}  // namespace weft::mesh
