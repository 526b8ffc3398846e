// Finds the vertices of body parts. A part is given by a common name (hands, torso), the name of a joint, a node of the
// skeleton, or a material of the character's file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "film/character/character.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// Per vertex: 1 if it belongs to a part, else 0.
using VertexMask = std::vector<std::uint8_t>;

/// All names of parts: hands, feet, arms, legs, head and torso, then the names of joints.
const std::vector<std::string>& part_names();

/// The joints of a part of part_names(), as indices into joint_names(); empty for other names. Case and underscores are
/// ignored.
std::vector<Index> joints_of_part(const std::string& name);

/// For each node of the skeleton, the nearest joint at or above it; -1: none. `nodes`: the node of each of
/// joint_names(), -1 if there is none.
std::vector<Index> joints_of_nodes(const Character& character, std::span<const Index> nodes);

/// The vertices with at least half of their weight on nodes of these joints, as of joints_of_nodes(). `nodes`: as
/// there.
VertexMask vertices_of(const Character& character, std::span<const Index> nodes, std::span<const Index> joints);

/// Arms and legs; the trunk is all other parts, with head and shoulders.
enum class Limb : Index { trunk, left_arm, right_arm, left_leg, right_leg };
/// Per vertex, the limb that has at least half of its weight, else the trunk. `nodes`: as for joints_of_nodes().
std::vector<Limb> limbs_of(const Character& character, std::span<const Index> nodes);

/// The vertices with at least half of their weight on this node and its descendants.
VertexMask vertices_below(const Character& character, Index node);

VertexMask vertices_of_material(const Character& character, Index material);

/// Appends vertices without faces, which follow the skin of `part`. In the pose `pose`, they have the positions
/// `places` [m]. Their bone weights are weighted means over the nearby skin of `part`, within a radius that grows with
/// the distance from this skin and the size of the body. `part` must contain a vertex; it has no entries for vertices
/// that earlier calls have appended.
void add_followers(Character& character, const Pose& pose, const VertexMask& part, std::span<const Vec3> places);

/// Whether thumb and fingers of a hand move separately: at least three chains of nodes below one of the hands influence
/// skin. `nodes`: as for joints_of_nodes().
bool has_fingers(const Character& character, std::span<const Index> nodes);

}  // namespace weft::character
