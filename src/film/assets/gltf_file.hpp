// Rewrites glTF files that assimp 5.2 reads wrongly.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace weft::assets {

/// Returns bytes of a binary glTF file that assimp reads in place of `file`, or nullopt if assimp
/// can read the file itself. These kinds of files need this:
/// - Files with integers in attributes or in channels of animations: the integers become floats.
///   Otherwise assimp would copy the bytes of the integers into its floats.
/// - Files with second sets of attributes, such as texture coordinates: the sets become sorted.
/// - Files with animations in steps or splines: their keys become such with linear changes between
///   them, as assimp reads all keys.
/// - Files with skins in which joints have no names or equal names, as those of two skeletons: they get names of their
///   own. assimp finds the node of a bone by its name.
/// - Files without scenes: they get one of all nodes.
/// - Files with animations of other things than nodes, such as colors of materials: their channels are left out.
/// - Files in which nodes share a mesh but not its skin, or share a camera: each gets a copy.
/// - Files with skins without bind matrices, which assimp does not expect: they get those that glTF prescribes.
/// - Files in binary layout with another ending than .glb, such as .vrm, which assimp would read as
///   OBJ: their bytes are returned unchanged.
/// Throws std::runtime_error if a glTF file requires an unsupported extension of glTF, such as a
/// compression, if its JSON is nested too deeply, or if such integers, keys or their
/// buffers cannot be read.
std::optional<std::string> readable_gltf(const std::filesystem::path& file);

}  // namespace weft::assets
