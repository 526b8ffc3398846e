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
/// its file. `scale_given`: whether the scene sets the scale; heights up to ten times beyond the limits are then
/// accepted.
std::optional<std::string> warn_of_height(std::span<const Vec3> x, const Vec3& up, double scale, bool scale_given);

/// Warns if all skin of a body is bound to one node, although the clip turns more than three nodes
/// that do not move the skin.
std::optional<std::string> warn_of_missing_skin(const character::Character& body, const character::Clip& clip);

/// Warns of an implausible speed of the mean position of the vertices of a body. `vertices`: their number; in `keys`,
/// points that follow the body come after them. Measures the speed over `count` key frames from the time `begin` [s]
/// on, `rate` per second.
std::optional<std::string> warn_of_speed(const motion::KeyFrames& keys, double begin, double rate, std::size_t count,
                                         std::size_t vertices);

/// Warns if a body is more than 5 cm below the only floor in more than half of the key frames or,
/// if `alone`, more than 5 cm above it in all of them. `lowest`: height of its lowest vertex over
/// the floor at each key frame [m]. `alone`: whether there is no other obstacle to stand on.
std::optional<std::string> warn_of_floor_distance(std::vector<double> lowest, bool alone);

}  // namespace weft::environment
