#include "film/environment/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/near_points.hpp"
#include "core/parallel.hpp"
#include "film/character/pose.hpp"

namespace weft::environment {
namespace {

/// Number of layers of cloth that must fit between two limbs. Several are needed where an arm presses on the folds of a
/// shirt: with space for 4 layers, cloth is pinched in 13 of 51 frames of such a film.
constexpr double kLayersBetweenLimbs = 8;

/// Skin counts as near cloth up to this distance [m]. character::LimbClearance moves two limbs apart only if cloth is
/// near one of them.
constexpr double kNearCloth = 0.05;

/// Maximum distance between samples on cloth [m], except on edges longer than kMaxEdgeSamples times this distance.
constexpr double kSampleDistance = 0.02;

/// Maximum number of intervals between samples along an edge of a triangle. Limits the cost of large triangles.
constexpr int kMaxEdgeSamples = 64;

/// Vertices per parallel task.
constexpr std::size_t kNearnessGrain = 512;

void add_samples(const std::array<Vec3, 3>& corners, NearPoints& places) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).norm());
  const int count = static_cast<int>(std::clamp(std::ceil(longest / kSampleDistance), 1.0, double{kMaxEdgeSamples}));
  for (int i = 0; i <= count; ++i)
    for (int j = 0; i + j <= count; ++j)
      places.add(corners[0] + (i * (corners[1] - corners[0]) + j * (corners[2] - corners[0])) / count);
}

}  // namespace

std::vector<character::Ground> static_grounds(const CharacterContext& context) {
  const scene::Pose& pose = context.settings.pose;
  std::vector<character::Ground> grounds;
  for (const scene::Obstacle& obstacle : context.scene.obstacles) {
    const auto* plane = std::get_if<scene::Plane>(&obstacle.shape);
    if (plane == nullptr || !plane->infinite || !obstacle.collide || !obstacle.motion.keys.empty() ||
        !obstacle.follow.empty())
      continue;
    const Vec3 up = obstacle.pose.rotation * context.up();
    grounds.push_back({pose.rotation.conjugate() * up, up.dot(obstacle.pose.position - pose.position)});
  }
  return grounds;
}

double height_over(const character::Ground& ground, std::span<const Vec3> x) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& v : x) least = std::min(least, ground.up.dot(v) - ground.height);
  return least;
}

double clearance_between_limbs(const CharacterContext& context) {
  if (context.settings.clearance) return *context.settings.clearance;
  const auto* mannequin = std::get_if<scene::Mannequin>(&context.settings.source);
  if (!context.settings.collide || (mannequin != nullptr && !mannequin->motion)) return 0;
  double thickest = 0;
  for (const scene::Cloth& cloth : context.scene.cloths) thickest = std::max(thickest, cloth.material.thickness);
  return kLayersBetweenLimbs * thickest;
}

std::vector<float> nearness_of_cloth(std::span<const Vec3> skin, const ClothAtStart& cloth) {
  NearPoints places(kNearCloth);
  for (const Vec3& x : cloth.x) places.add(x);
  for (const mesh::Triangle& t : cloth.triangles) add_samples({cloth.x[t[0]], cloth.x[t[1]], cloth.x[t[2]]}, places);
  std::vector<float> nearness(skin.size());
  parallel_for(skin.size(), kNearnessGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      nearness[v] =
          static_cast<float>(std::clamp(2 - 2 * std::sqrt(places.nearest(skin[v]).distance_sq) / kNearCloth, 0.0, 1.0));
  });
  return nearness;
}

std::vector<float> nearness_of_cloths(const CharacterContext& context, const character::Character& body,
                                      const character::Performance& performance, std::span<const ClothAtStart> cloths) {
  const scene::Pose& pose = context.settings.pose;
  std::vector<float> nearness(body.mesh.positions.size(), 0);
  std::vector<Vec3> x(nearness.size());
  for (const ClothAtStart& cloth : cloths) {
    character::skin(body, performance.at(context.begin() + cloth.put_on), x);
    for (Vec3& v : x) v = pose.position + pose.rotation * v;
    const std::vector<float> here = nearness_of_cloth(x, cloth);
    for (std::size_t v = 0; v < here.size(); ++v) nearness[v] = std::max(nearness[v], here[v]);
  }
  return nearness;
}

}  // namespace weft::environment
