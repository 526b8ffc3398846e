// What touches or crosses at the start of a scene, place by place: for the refusal, and to be drawn.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "collision/bodies.hpp"
#include "collision/response/certificate.hpp"
#include "simulation/simulation.hpp"

namespace weft::simulation {

/// The places where these pairs meet at x [m], those of most pairs first. Pairs of the same two objects are of one
/// place where their triangles have common vertices. `names`: of the bodies.
std::vector<MeetingPlace> meeting_places(std::span<const collision::CornerPair> pairs, const collision::Bodies& bodies,
                                         std::span<const std::string> names, std::span<const Vec3> x);

/// "12 pairs of triangles that touch or cross in 2 places: 'sheet' and 'ball' (8 pairs) around (0, 0, 1) m, ...".
std::string describe(std::span<const MeetingPlace> places);

}  // namespace weft::simulation
