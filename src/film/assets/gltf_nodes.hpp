// Changes the nodes of glTF files so that assimp 5.2 assigns joints, skins, cameras and channels to the right ones.
#pragma once

#include <nlohmann/json.hpp>

namespace weft::assets {

/// The value of a key; null if there is none.
const nlohmann::json& part_of(const nlohmann::json& json, const char* key);

/// The value of a key, to be changed; a null of no use if there is none.
nlohmann::json& list_of(nlohmann::json& json, const char* key);

/// Adds a scene of all nodes to a file without scenes, which glTF allows and assimp refuses. Returns whether it did.
bool add_missing_scene(nlohmann::json& gltf);

/// Removes channels of animations that change no node, such as colors of materials (KHR_animation_pointer): assimp
/// takes them for translations of the first node, or refuses the file. Returns whether there were any.
bool remove_other_channels(nlohmann::json& gltf);

/// Copies a mesh for each skin with which nodes use it, and a camera for each node that uses it: assimp stores the
/// bones of a skin in the mesh, and the name of the node in the camera, so that only the last node would count. Returns
/// whether anything was copied.
bool copy_shared_parts(nlohmann::json& gltf);

/// Gives each joint of a skin and each animated node without a camera a name that no other of them has, nor a camera,
/// nor any other node without a mesh: assimp names the node of a bone, a channel or a camera by its name alone. Of
/// several nodes with one name, the first keeps it: cameras, then joints, then animated nodes. Names of meshes that do
/// not move stay, as scenes state them; so does the name of a camera, except if an earlier camera has it. The others
/// get their number in the file after their name. Returns whether a name has changed.
bool name_nodes_apart(nlohmann::json& gltf);

}  // namespace weft::assets
