#include "film/scene/following.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "film/scene/reader.hpp"

namespace weft::scene {
namespace {

const Obstacle* obstacle_named(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.obstacles, name, &Obstacle::name);
  return name.empty() || found == scene.obstacles.end() ? nullptr : &*found;
}

/// The chain of followed obstacles: the obstacle that `obstacle` follows, the one that this obstacle follows, and so
/// on, each at most once. If the chain returns to `obstacle`, this is the last entry.
std::vector<const Obstacle*> parents_of(const Scene& scene, const Obstacle& obstacle) {
  std::vector<const Obstacle*> chain;
  const Obstacle* parent = obstacle_named(scene, obstacle.follow);
  while (parent != nullptr && std::ranges::find(chain, parent) == chain.end()) {
    chain.push_back(parent);
    parent = obstacle_named(scene, parent->follow);
  }
  return chain;
}

void check_followed(const Scene& scene, const std::string& follow, const std::string& key, Findings& findings) {
  if (follow.empty()) return;
  const Followed followed = scene::followed(follow);
  if (std::ranges::find(scene.characters, followed.body, &Character::name) != scene.characters.end()) {
    if (followed.part.empty())
      findings.report(key, fmt::format("expected a part of the character, such as \"{}.torso\" or \"{}.head\", got {}",
                                       followed.body, followed.body, in_quotes(follow)));
    return;
  }
  if (obstacle_named(scene, follow) != nullptr) return;
  std::vector<std::string> bodies;
  for (const Obstacle& each : scene.obstacles) bodies.push_back(each.name);
  for (const Character& each : scene.characters) bodies.push_back(each.name);
  findings.report(key, fmt::format("expected the name of an obstacle, or a part of a character, got {}{}",
                                   in_quotes(follow), suggestion(followed.body, bodies)));
}

}  // namespace

bool has_prescribed_motion(const Scene& scene, const Obstacle& obstacle) {
  const auto moves_itself = [](const Obstacle& each) {
    return each.motion.keys.size() > 1 || each.follow.find('.') != std::string::npos;
  };
  return moves_itself(obstacle) ||
         std::ranges::any_of(parents_of(scene, obstacle), [&](const Obstacle* each) { return moves_itself(*each); });
}

void check_following(const Scene& scene, Findings& findings) {
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    check_followed(scene, scene.cameras[i].follow, findings.entry("camera", i) + ".follow", findings);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const std::string key = findings.entry("obstacle", i) + ".follow", &follow = scene.obstacles[i].follow;
    check_followed(scene, follow, key, findings);
    if (const Obstacle* followed = obstacle_named(scene, follow); followed != nullptr && is_dynamic(*followed))
      findings.report(key, fmt::format("expected a body that keys move, got {}, which has a mass", in_quotes(follow)));
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const Obstacle& obstacle = scene.obstacles[i];
    const std::vector<const Obstacle*> parents = parents_of(scene, obstacle);
    if (std::ranges::find(parents, &obstacle) == parents.end()) continue;
    const bool itself = obstacle.follow == obstacle.name;
    findings.report(findings.entry("obstacle", i) + ".follow",
                    fmt::format("expected an obstacle that does not follow this one, got {}, which {}",
                                in_quotes(obstacle.follow), itself ? "it is itself" : "follows it"));
    return;
  }
}

}  // namespace weft::scene
