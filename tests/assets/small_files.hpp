// Small mesh files of several formats, made in memory.
#pragma once

#include <string>

namespace weft::assets {

/// A unit cube with a corner at the origin: 8 vertices, 6 quads, each with its own normal and texture coordinates.
std::string obj_cube();

/// A tetrahedron with its corners at the origin and on the unit axes, in ASCII.
std::string ply_tetrahedron();

/// The tetrahedron as binary STL: every triangle has its own three vertices.
std::string stl_tetrahedron();

/// The tetrahedron as self-contained glTF; its node scales it by -1 along z (a mirror), and moves it up by 2.
std::string gltf_tetrahedron();
/// The file of gltf_tetrahedron() as binary glTF.
std::string glb_tetrahedron();

/// The tetrahedron, not mirrored, as glTF with integers instead of floats: positions are shorts, of which a sparse part
/// replaces the last; texture coordinates are bytes, equal to x and y. `of_primitive`, `of_file`: further JSON members
/// of the primitive and of the file.
std::string gltf_tetrahedron_of_integers(const std::string& of_primitive = {}, const std::string& of_file = {});

/// Two triangles with the corners (0, 0, 0), (1, 0, 0) and (0, 1, 0), each bound to a skeleton of one joint called
/// "Hips"; the second joint is at x = 5.
std::string gltf_of_two_skeletons();

/// A camera "eye" 1 m above and 3 m along z from a rig that turns by 90 degrees about y in two seconds, as glTF.
/// `integers`: with shorts as keys of the rotation.
std::string gltf_camera(bool integers = false);

/// A square of 1 m as FBX in centimetres, and as Collada in inches, each with texture coordinates.
std::string fbx_square();
std::string collada_square();

}  // namespace weft::assets
