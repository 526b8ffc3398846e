// Parts of a body by common names (hands, torso), by names of joints, or by the bones or materials of its file.
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

/// Names of parts: hands, feet, arms, legs, head and torso, then the names of joints.
const std::vector<std::string>& part_names();

/// The joints that a part of part_names() consists of, as indices into joint_names(); empty for other names. Case and
/// underscores between words are ignored.
std::vector<Index> joints_of_part(const std::string& name);

/// The vertices with at least half of their weight on nodes of these joints. The nodes of a joint are its own node and
/// all below it, up to the next joint. `nodes`: one per entry of joint_names(), −1 if there is none.
VertexMask vertices_of(const Character& character, std::span<const Index> nodes, std::span<const Index> joints);

/// limbs_of() returns, per vertex, the limb that has at least half of its weight, else the trunk.
enum class Limb : Index { trunk, left_arm, right_arm, left_leg, right_leg };
std::vector<Limb> limbs_of(const Character& character, std::span<const Index> nodes);

/// The vertices with at least half of their weight on a node or the nodes below it.
VertexMask vertices_below(const Character& character, Index node);

/// The vertices of a material of the file.
VertexMask vertices_of_material(const Character& character, Index material);

/// Appends vertices without faces, which have the given positions [m] in the pose `pose`. Their bone weights are means
/// over the nearby skin of the part, within a radius that grows with their distance from the skin.
void add_followers(Character& character, const Pose& pose, const VertexMask& part, std::span<const Vec3> places);

/// Whether three or more chains of nodes below a hand influence skin: thumb and fingers that move separately.
bool has_fingers(const Character& character, std::span<const Index> nodes);

}  // namespace weft::character
