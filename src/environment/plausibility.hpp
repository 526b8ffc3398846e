// What bodies of people and animals do not do: sizes and speeds that must come of another unit or rate.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "character/character.hpp"
#include "environment/key_frames.hpp"

namespace weft::environment {

/// What is wrong with a body that is as high along `up` as these places [m]. `scale`: metres per unit of its file;
/// `said`: by the scene, which may want giants, but none of ten times that.
std::optional<std::string> doubt_of_height(std::span<const Vec3> x, const Vec3& up, double scale, bool said);

/// What is wrong with a body of which a clip moves limbs, where no limb has a skin.
std::optional<std::string> doubt_of_skin(const character::Character& body, const character::Clip& clip);

/// What is wrong with a body that moves so: `count` key frames of `vertices` places from `begin` [s] on, `rate` a
/// second.
std::optional<std::string> doubt_of_speed(const KeyFrames& keys, double begin, double rate, std::size_t count,
                                          std::size_t vertices);

/// What is wrong with a body whose lowest vertex is as high over the one floor there is, at each of its key frames [m].
/// `alone`: there is nothing else to stand on.
std::optional<std::string> doubt_of_floor(std::vector<double> lowest, bool alone);

}  // namespace weft::environment
