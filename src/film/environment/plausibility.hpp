// Warns of implausible sizes, speeds and heights of characters, which suggest a wrong unit or rate.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/character/character.hpp"
#include "physics/motion/key_frames.hpp"

namespace weft::environment {

/// Warns of an implausible height of a body along `up`. `x`: positions of its vertices [m]. `scale`: metres per unit of
/// its file. `scale_given`: whether the scene sets the scale; the limits are then ten times as wide.
std::optional<std::string> warn_of_height(std::span<const Vec3> x, const Vec3& up, double scale, bool scale_given);

/// Warns if all skin of a body is bound to one node, although the clip turns more than three nodes that do not move the
/// skin.
std::optional<std::string> warn_of_missing_skin(const character::Character& body, const character::Clip& clip);

/// Warns of an implausible speed of a body: of the mean position of its vertices over `count` key frames, which start
/// at the time `begin` [s] and have the rate `rate` [1/s]. `vertices`: number of vertices of the body, which come first
/// in `keys`; points that follow the body come after them.
std::optional<std::string> warn_of_speed(const motion::KeyFrames& keys, double begin, double rate, std::size_t count,
                                         std::size_t vertices);

/// Warns if a body is more than 5 cm below the only floor in more than half of the key frames. If `alone`, also warns
/// if it is more than 5 cm above the floor in all of them. `lowest`: height of its lowest vertex over the floor at each
/// key frame [m]. `alone`: whether there is no other obstacle on which the body could stand.
std::optional<std::string> warn_of_floor_distance(std::vector<double> lowest, bool alone);

}  // namespace weft::environment
