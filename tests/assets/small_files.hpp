// Small mesh files of several formats, made in memory.
#pragma once

#include <string>

namespace weft::assets {

/// A unit cube with a corner at the origin: 8 vertices, 6 quads, each with its own normal and texture coordinates.
std::string obj_cube();

/// A tetrahedron with its corners at the origin and on the unit axes, in ASCII.
std::string ply_tetrahedron();

/// The same as binary STL: every triangle has its own three vertices.
std::string stl_tetrahedron();

/// The same as self-contained glTF; one node mirrors it with a scale of -1 along z and moves it up by 2.
std::string gltf_tetrahedron();
/// The same as binary glTF.
std::string glb_tetrahedron();

/// A camera "eye" 1 m above and 3 m along z from a rig that turns by 90 degrees about y in two seconds, as glTF.
std::string gltf_camera();

/// A square of 1 m as FBX in centimetres, and as Collada in inches, each with texture coordinates.
std::string fbx_square();
std::string collada_square();

}  // namespace weft::assets
