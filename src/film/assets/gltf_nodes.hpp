// Changes the nodes of glTF files so that assimp 5.2 assigns joints and channels to the right ones.
#pragma once

#include <nlohmann/json.hpp>

namespace weft::assets {

/// The value of a key; null if there is none.
const nlohmann::json& part_of(const nlohmann::json& json, const char* key);

/// The value of a key, to be changed; a null of no use if there is none.
nlohmann::json& list_of(nlohmann::json& json, const char* key);

/// Gives each joint of a skin and each animated node without a camera a name that no other of them has, and no other
/// node without a mesh or camera: assimp names the node of a bone or of a channel by its name alone. Of several nodes
/// with one name, the first keeps it, joints before others; names of cameras and of meshes that do not move stay, as
/// scenes state them. Returns whether a name has changed.
bool name_nodes_apart(nlohmann::json& gltf);

}  // namespace weft::assets
