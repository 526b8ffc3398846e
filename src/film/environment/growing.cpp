#include "film/environment/growing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "core/disjoint_sets.hpp"
#include "core/log.hpp"
#include "film/environment/wearers.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/mesh/topology.hpp"
#include "physics/mesh/triangle_grid.hpp"

namespace weft::environment {
namespace {

/// Fraction of the time `dressing` in which a wearer grows. In the rest of this time, the garment settles.
constexpr double kGrowingFraction = 0.5;

/// Angle between the arms and the downward direction, for garments without sleeves [degrees].
constexpr double kAngleBesideSkirt = 45;

/// Number of cells of the search grid along the longest side of the bounding box of a garment.
constexpr double kCellsPerSide = 30;

/// An opening of a garment: a closed border, in the axes of the wearer [m].
struct Opening {
  Box3 box;
  Vec3 sum = Vec3::Zero();
  double count = 0;

  Vec3 middle() const { return sum / count; }
};

std::vector<Opening> openings_of(const model::Cloth& cloth, const garment::Wearer& wearer) {
  DisjointSets rims(cloth.start.size());
  std::vector<std::uint8_t> on_rim(cloth.start.size(), 0);
  for (const mesh::Edge& edge : mesh::collect_edges(cloth.sheet.triangles).edges)
    if (edge.triangles[1] < 0) {
      rims.join(edge.vertices[0], edge.vertices[1]);
      for (const Index v : edge.vertices) on_rim[v] = 1;
    }
  std::map<Index, Opening> found;
  const Eigen::Isometry3d to_own = wearer.to_world.inverse();
  for (std::size_t v = 0; v < on_rim.size(); ++v) {
    if (on_rim[v] == 0) continue;
    Opening& opening = found[rims.root(static_cast<Index>(v))];
    const Vec3 x = to_own * cloth.start[v];
    opening.box.extend(x);
    opening.sum += x;
    ++opening.count;
  }
  std::vector<Opening> openings;
  for (const auto& [root, opening] : found) openings.push_back(opening);
  return openings;
}

/// Angle from the downward direction at which straight arms point through the sleeves, averaged over both sides
/// [degrees]. The end of a sleeve is an opening beside the shoulder and above the hips. Absent if one side has no such
/// opening or no arm joints.
std::optional<double> angle_of_sleeves(const model::Cloth& cloth, const garment::Wearer& wearer) {
  double sum = 0;
  const std::vector<Opening> openings = openings_of(cloth, wearer);
  for (const double side : {1.0, -1.0}) {
    const auto& arm = side > 0 ? wearer.left_arm : wearer.right_arm;
    const auto& leg = side > 0 ? wearer.left_leg : wearer.right_leg;
    if (!arm) return std::nullopt;
    const Vec3& shoulder = (*arm)[0];
    const auto cuff = std::ranges::find_if(openings, [&](const Opening& opening) {
      const bool beside = std::min(side * opening.box.min().x(), side * opening.box.max().x()) > 0;
      return beside && side * (opening.middle() - shoulder).x() > 0 && (!leg || opening.middle().z() > (*leg)[0].z());
    });
    if (cuff == openings.end()) return std::nullopt;
    const Vec3 along = cuff->middle() - shoulder;
    sum += std::atan2(side * along.x(), -along.z());
  }
  return 0.5 * sum * 180 / std::numbers::pi;
}

/// Whether the bones of an arm, from shoulder to wrist, go through the garment.
bool is_pierced_by_arm(const model::Cloth& cloth, const garment::Wearer& wearer) {
  const Box3 box = mesh::bounding_box(cloth.start);
  const mesh::TriangleGrid grid(cloth.sheet.triangles, cloth.start, box.diagonal().maxCoeff() / kCellsPerSide);
  const auto crosses = [&](const Vec3& from, const Vec3& to) {
    return grid.find_first_crossing(from, to, [](Index) { return true; }).triangle >= 0;
  };
  for (const auto& arm : {wearer.left_arm, wearer.right_arm})
    for (std::size_t k = 0; arm && k + 1 < arm->size(); ++k) {
      const Vec3 from = wearer.to_world * (*arm)[k], to = wearer.to_world * (*arm)[k + 1];
      if (crosses(from, to) || crosses(to, from)) return true;  // a search finds only crossings from the front
    }
  return false;
}

/// The index of the character that wears a garment. Absent if the garment is not from a pattern or not untangled, if it
/// names no wearer and there are several characters, or if the character has no bones or no `dressing`, or would still
/// grow at frame 0.
std::optional<std::size_t> wearer_of(const scene::Scene& scene, const scene::Cloth& cloth) {
  if (cloth.shape != scene::ClothShape::pattern || !scene::starts_untangled(cloth)) return std::nullopt;
  for (std::size_t c = 0; c < scene.characters.size(); ++c) {
    const scene::Character& character = scene.characters[c];
    if (cloth.wearer.empty() ? scene.characters.size() > 1 : character.name != cloth.wearer) continue;
    if (scene::skeleton_motion_of(character) == nullptr || !(character.dressing > 0)) continue;
    if (kGrowingFraction * character.dressing > scene.time.preroll) continue;
    return c;
  }
  return std::nullopt;
}

/// A function that returns the body of a wearer. Its first call makes the body, which takes time.
using Measure = std::function<const garment::Wearer&()>;

/// Calls visit(cloth, index of its wearer, Measure of the wearer's body) for each garment that has a wearer
/// (wearer_of).
template <class Visit>
void for_each_worn(const scene::Scene& scene, const Environment& environment, const Visit& visit) {
  Wearers wearers(scene);
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const model::Cloth& cloth = environment.model.cloths[c];
    const auto number = wearer_of(scene, scene.cloths[c]);
    if (number)
      visit(cloth, *number,
            [&]() -> const garment::Wearer& { return wearers.of(scene.characters[*number].name, cloth.source); });
  }
}

}  // namespace

std::optional<scene::Scene> pose_arms_for_sleeves(const scene::Scene& scene, const Environment& environment) {
  std::optional<scene::Scene> posed;
  for_each_worn(scene, environment, [&](const model::Cloth& cloth, std::size_t number, const Measure& measure) {
    const scene::Character& character = scene.characters[number];
    if (scene::skeleton_motion_of(character)->stance_arms || !(character.blend > 0)) return;
    const garment::Wearer& body = measure();
    if (!is_pierced_by_arm(cloth, body)) return;
    const std::optional<double> of_sleeves = angle_of_sleeves(cloth, body);
    // If another garment has already set the angle of the arms, only a garment with sleeves changes it, because arms
    // must point into sleeves.
    if (posed && scene::skeleton_motion_of(posed->characters[number])->stance_arms && !of_sleeves) return;
    if (!posed) posed = scene;
    const double angle = std::round(of_sleeves.value_or(kAngleBesideSkirt));
    scene::skeleton_motion_of(posed->characters[number])->stance_arms = angle;
    log::note(
        fmt::format("{}: the arms of '{}' would go through it at the start; while it is put on, they are {:g} "
                    "degrees from hanging, as with stance_arms = {:g}",
                    cloth.source, character.name, angle, angle));
  });
  return posed;
}

std::optional<scene::Scene> let_wearers_grow(const scene::Scene& scene, const Environment& environment,
                                             std::vector<std::string>& notes) {
  std::optional<scene::Scene> growing;
  for_each_worn(scene, environment, [&](const model::Cloth& cloth, std::size_t number, const Measure& measure) {
    if (scene.characters[number].grow > 0) return;
    if (!growing) growing = scene;
    scene::Character& grown = growing->characters[number];
    grown.grow = kGrowingFraction * grown.dressing;
    std::optional<double>& arms = scene::skeleton_motion_of(grown)->stance_arms;
    if (!arms && grown.blend > 0) arms = angle_of_sleeves(cloth, measure());
    notes.push_back(fmt::format(
        "{}: it cannot be moved out of '{}' at full size; so the body grows into it in the first {:g} "
        "s of dressing, as with grow = {:g}{}",
        cloth.source, grown.name, grown.grow, grown.grow, arms ? fmt::format(" and stance_arms = {:.0f}", *arms) : ""));
  });
  return growing;
}

}  // namespace weft::environment
