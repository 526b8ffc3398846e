// Parts of a body, by what people call them: its hands, one arm, all that a bone of its file holds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "character/character.hpp"
#include "character/pose.hpp"

namespace weft::character {

/// 1 for each vertex that belongs to a part, else 0.
using VertexMask = std::vector<std::uint8_t>;

/// hands, feet, arms, legs, head and torso, and then the names of joints.
const std::vector<std::string>& part_names();

/// The joints of part_names() that such a part consists of, as places in joint_names(); in any case, and with or
/// without _ between words. Empty for other names.
std::vector<Index> joints_of_part(const std::string& name);

/// The vertices that are held for at least half by the nodes of these joints. The nodes of a joint are its own and all
/// below it, up to the next joint. `nodes`: of each of joint_names(), −1 where there is none.
VertexMask vertices_of(const Character& character, std::span<const Index> nodes, std::span<const Index> joints);

/// Of each vertex the limb that holds at least half of it; head and torso are one, and what no limb holds.
enum class Limb : Index { trunk, left_arm, right_arm, left_leg, right_leg };
std::vector<Limb> limbs_of(const Character& character, std::span<const Index> nodes);

/// Those that are held for at least half by a node and all below it.
VertexMask vertices_below(const Character& character, Index node);

/// Those of a material of the file.
VertexMask vertices_of_material(const Character& character, Index material);

/// Appends to the character vertices that are in no face and, as the character is posed now, are at these places: they
/// go where the skin of the part around them goes, by the mean of its weights. The farther a place is from the skin,
/// the wider the mean. [m]
void add_followers(Character& character, const Pose& pose, const VertexMask& part, std::span<const Vec3> places);

/// Whether skin is held by three or more chains of nodes below a hand: thumb and fingers that move apart.
bool has_fingers(const Character& character, std::span<const Index> nodes);

}  // namespace weft::character
