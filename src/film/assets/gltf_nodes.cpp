#include "film/assets/gltf_nodes.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <set>
#include <string>
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
  std::set<std::string> names;  // of joints and animated nodes
  bool changed = false;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t n = order[k];
    if (!nodes[n].is_object()) continue;
    std::string name = value_or<std::string>(nodes[n], "name", "");
    if (name.empty() && k >= joints) continue;  // assimp gives it a name of its own
    if (is_referred[n] ? !name.empty() && names.insert(name).second : !names.contains(name)) continue;
    name = fmt::format("{}_{}", name.empty() ? "joint" : name, n);
    while (!names.insert(name).second) name += '_';
    nodes[n]["name"] = name;
    changed = true;
  }
  return changed;
}

}  // namespace weft::assets
