#include "film/environment/soles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "film/character/pose.hpp"

namespace weft::environment {
namespace {

/// A body is moved if the height of its soles differs from that of the file's origin by at least this [m].
constexpr double kMaxSoleOffset = 0.05;

}  // namespace

Vec3 floor_offset(const CharacterContext& context, const character::Character& body) {
  const Vec3 up = context.up();
  std::vector<Vec3> x(body.mesh.positions.size());
  character::skin(body, character::rest_pose(body), x);
  const double soles = up.dot(std::ranges::min(x, {}, [&](const Vec3& v) { return up.dot(v); }));
  return std::abs(soles) < kMaxSoleOffset ? Vec3(Vec3::Zero()) : Vec3(-soles * up);
}

void put_on_floor(const CharacterContext& context, Body& body) {
  const Vec3 offset = floor_offset(context, body.character);
  if (offset.isZero(0)) return;
  for (character::Node& node : body.character.nodes)
    if (node.parent < 0) node.local.pretranslate(offset);
  const double soles = -context.up().dot(offset);
  body.warnings.push_back(
      fmt::format("{}: {} has its soles {:.3g} m {} its origin; they are put at the height of position", context.where,
                  body.source, std::abs(soles), soles < 0 ? "below" : "above"));
}

}  // namespace weft::environment
