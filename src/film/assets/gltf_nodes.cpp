#include "film/assets/gltf_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.hpp"

namespace weft::assets {
namespace {

using Json = nlohmann::json;

}  // namespace

const Json& part_of(const Json& json, const char* key) {
  static const Json kNone;
  return json.is_object() && json.contains(key) ? json[key] : kNone;
}

Json& list_of(Json& json, const char* key) {
  static Json nothing;
  return json.is_object() && json.contains(key) ? json[key] : nothing = Json();
}

bool add_missing_scene(Json& gltf) {
  const Json& nodes = part_of(gltf, "nodes");
  if (!nodes.is_array() || !part_of(gltf, "scenes").empty()) return false;
  std::set<std::size_t> children;
  for (const Json& node : nodes)
    for (const Json& child : part_of(node, "children"))
      if (child.is_number_unsigned()) children.insert(child.get<std::size_t>());
  Json scene;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!children.contains(n)) scene["nodes"].push_back(n);
  gltf["scenes"] = Json::array();
  gltf["scenes"].push_back(std::move(scene));
  gltf["scene"] = 0;
  return true;
}

bool remove_other_channels(Json& gltf) {
  constexpr std::array<std::string_view, 4> kPaths{"translation", "rotation", "scale", "weights"};
  bool removed = false;
  for (Json& animation : list_of(gltf, "animations")) {
    Json& channels = list_of(animation, "channels");
    Json kept = Json::array();
    for (const Json& channel : channels) {
      const Json& target = part_of(channel, "target");
      const std::string path = value_or<std::string>(target, "path", "");
      if (part_of(target, "node").is_number_unsigned() && std::ranges::count(kPaths, std::string_view(path)) > 0)
        kept.push_back(channel);
    }
    if (kept.size() == channels.size()) continue;
    channels = std::move(kept);
    removed = true;
  }
  return removed;
}

bool copy_shared_parts(Json& gltf) {
  bool copied = false;
  Json& nodes = list_of(gltf, "nodes");
  for (const bool is_camera : {false, true}) {
    const char* key = is_camera ? "camera" : "mesh";
    Json& parts = list_of(gltf, is_camera ? "cameras" : "meshes");
    if (!parts.is_array()) continue;
    const std::size_t count = parts.size();
    std::map<std::array<int, 2>, std::size_t> own;  // by part and its user: the skin of a mesh, the node of a camera
    std::set<int> used;
    int number = -1;
    for (Json& node : nodes) {
      ++number;
      const int part = value_or<int>(node, key, -1), user = is_camera ? number : value_or<int>(node, "skin", -1);
      if (part < 0 || std::cmp_greater_equal(part, count)) continue;
      const auto [found, is_new] = own.emplace(std::array{part, user}, static_cast<std::size_t>(part));
      if (is_new && !used.insert(part).second) {
        found->second = parts.size();
        Json copy = parts[static_cast<std::size_t>(part)];
        parts.push_back(std::move(copy));
        copied = true;
      }
      node[key] = found->second;
    }
  }
  return copied;
}

bool name_nodes_apart(Json& gltf) {
  Json& nodes = list_of(gltf, "nodes");
  if (!nodes.is_array()) return false;
  std::vector<std::size_t> order;  // joints first, then animated nodes
  std::vector<bool> is_referred(nodes.size(), false);
  const auto add = [&](const Json& node, bool may_hold_camera) {
    const std::size_t n = node.is_number_unsigned() ? node.get<std::size_t>() : nodes.size();
    if (n >= nodes.size() || is_referred[n] || (!may_hold_camera && nodes[n].contains("camera"))) return;
    is_referred[n] = true;
    order.push_back(n);
  };
  for (const Json& skin : part_of(gltf, "skins"))
    for (const Json& joint : part_of(skin, "joints")) add(joint, true);
  const std::size_t joints = order.size();
  for (const Json& animation : part_of(gltf, "animations"))
    for (const Json& channel : part_of(animation, "channels")) add(part_of(part_of(channel, "target"), "node"), false);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!is_referred[n] && !nodes[n].contains("mesh") && !nodes[n].contains("camera")) order.push_back(n);
  std::set<std::string> names;  // of joints, animated nodes and cameras
  bool changed = false;
  const auto rename = [&](std::size_t n, std::string name) {
    name = fmt::format("{}_{}", name.empty() ? "joint" : name, n);
    while (!names.insert(name).second) name += '_';
    nodes[n]["name"] = name;
    changed = true;
  };
  std::vector<std::size_t> equal;  // cameras with the name of an earlier one
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!is_referred[n] && nodes[n].contains("camera"))
      if (const auto name = value_or<std::string>(nodes[n], "name", ""); !name.empty() && !names.insert(name).second)
        equal.push_back(n);
  for (const std::size_t n : equal) rename(n, value_or<std::string>(nodes[n], "name", ""));
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t n = order[k];
    if (!nodes[n].is_object()) continue;
    const auto name = value_or<std::string>(nodes[n], "name", "");
    if (name.empty() && k >= joints) continue;  // assimp gives it a name of its own
    if (is_referred[n] ? !name.empty() && names.insert(name).second : !names.contains(name)) continue;
    rename(n, name);
  }
  return changed;
}

}  // namespace weft::assets
