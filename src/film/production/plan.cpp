#include "film/production/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "film/environment/actor.hpp"
#include "film/environment/environment.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/production/pin_warnings.hpp"
#include "film/scene/following.hpp"
#include "film/scene/layers.hpp"

namespace weft::production {
namespace {

using scene::Cloth;
using scene::Scene;

constexpr const char* kNoCloth = "no cloth";

// Such as "1 key" or "2 keys".
std::string counted(auto count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// Item for a part that some cloths use. Its reason is, for example, "2 of 3 cloths"; or `absent` if no cloth uses the
// part.
template <class Test>
PlanItem cloth_item(std::string part, const Scene& scene, Test needs, std::string_view absent) {
  const auto count = std::count_if(scene.cloths.begin(), scene.cloths.end(), needs);
  if (count == 0) return {std::move(part), false, std::string(scene.cloths.empty() ? kNoCloth : absent)};
  return {std::move(part), true, fmt::format("{} of {}", count, counted(scene.cloths.size(), "cloth"))};
}

PlanItem item_if(std::string part, bool used, std::string present, std::string absent) {
  return {std::move(part), used, used ? std::move(present) : std::move(absent)};
}

bool air_acts(const Scene& scene) {
  return scene.physics.air_density > 0 &&
         std::ranges::any_of(scene.cloths, [](const Cloth& cloth) { return cloth.material.drag > 0; });
}

void plan_forces(const Scene& scene, std::vector<PlanItem>& items) {
  const double gravity = scene.physics.largest_gravity();
  const bool has_keys = !scene.physics.keys.empty();
  items.push_back(item_if("force: gravity", gravity > 0,
                          fmt::format("{}{:.4g} m/s²", has_keys ? "at most " : "", gravity),
                          has_keys ? "gravity of physics.keys is zero" : "physics.gravity is zero"));
  items.push_back(cloth_item(
      "force: stretch", scene, [](const Cloth& c) { return !c.rope; }, kNoCloth));
  items.push_back(cloth_item(
      "force: shear", scene, [](const Cloth& c) { return c.material.shear > 0 || c.material.shear_viscosity > 0; },
      "shear and shear_viscosity are zero"));
  items.push_back(cloth_item(
      "force: limit to stretch", scene, [](const Cloth& c) { return c.material.has_strain_limit(); },
      "max_stretch and max_shear are zero"));
  items.push_back(cloth_item(
      "force: bending", scene, [](const Cloth& c) { return c.material.resists_bending(); }, "bend is zero"));
  items.push_back(cloth_item(
      "force: viscosity", scene,
      [](const Cloth& c) {
        const scene::Material& m = c.material;
        return m.stretch_viscosity > 0 || m.shear_viscosity > 0 || (m.resists_bending() && m.bend_viscosity > 0);
      },
      "all viscosities of what is built are zero"));
  items.push_back(cloth_item(
      "force: bending friction", scene,
      [](const Cloth& c) { return c.material.resists_bending() && c.material.bend_friction > 0; },
      "bend or bend_friction is zero"));
  items.push_back(cloth_item(
      "force: air", scene, [&](const Cloth& c) { return scene.physics.air_density > 0 && c.material.drag > 0; },
      "air_density or drag is zero"));
  items.push_back(
      item_if("force: gusts", scene.physics.gusts.speed > 0 && air_acts(scene),
              fmt::format("{:g} m/s, eddies of {:g} m", scene.physics.gusts.speed, scene.physics.gusts.size),
              "physics.gusts.speed, air_density or drag is zero"));
}

// Adds the parts that the plan lists only if the scene has them.
void plan_named(const Scene& scene, std::vector<PlanItem>& items) {
  if (const auto count = std::ranges::count_if(scene.cloths, [](const Cloth& c) { return c.pressure.has_effect(); }))
    items.push_back({"force: pressure of enclosed air", true,
                     fmt::format("{} of {}", count, counted(scene.cloths.size(), "cloth"))});
  if (!scene.ropes.empty())
    items.push_back({"force: stretch and bending of ropes", true, counted(scene.ropes.size(), "rope")});
  if (!scene.attachments.empty())
    items.push_back({"force: attachments", true, counted(scene.attachments.size(), "attachment")});
  if (const auto count = std::ranges::count_if(scene.obstacles, [](const auto& o) { return scene::is_dynamic(o); }))
    items.push_back(
        {"motion: rigid bodies", true, fmt::format("{} of {}", count, counted(scene.obstacles.size(), "obstacle"))});
  if (const auto count = std::ranges::count_if(scene.obstacles, [](const auto& o) { return !o.follow.empty(); }))
    items.push_back({"motion: obstacles that follow", true, counted(count, "obstacle")});
  if (!scene.physics.keys.empty())
    items.push_back({"force: keyed gravity and wind", true, counted(scene.physics.keys.size(), "key")});
  if (!scene.fans.empty()) {
    const bool acts = air_acts(scene);
    items.push_back({"force: fans", acts, acts ? counted(scene.fans.size(), "fan") : "air_density or drag is zero"});
  }
}

void plan_constraints(const Scene& scene, std::vector<PlanItem>& items) {
  std::size_t pins = 0;
  std::ptrdiff_t fading = 0;
  for (const Cloth& cloth : scene.cloths) {
    pins += cloth.pins.size();
    fading += std::ranges::count_if(cloth.pins, [](const scene::Pin& pin) { return pin.fade > 0; });
  }
  items.push_back(item_if("constraint: pins", pins > 0, counted(pins, "group"), "no pin"));
  items.push_back(
      item_if("force: springs that fade around pins", fading > 0, counted(fading, "group"), "no pin has a fade"));
}

// The bounding volume hierarchy, and the parts of collision detection that a scene can switch on and off.
void plan_search(const scene::Search& search, bool any, std::vector<PlanItem>& items) {
  constexpr std::array kBounds{"boxes", "18-DOPs", "26-DOPs"};
  constexpr std::array kTrees{"binary trees", "quadtrees", "octrees"};
  const auto part = [&](std::string name, bool on, std::string what) {
    items.push_back(item_if("search: " + std::move(name), any && on, std::move(what),
                            any ? "off in contact.search" : "nothing collides"));
  };
  part("bounding volume hierarchy", true,
       fmt::format("{} of {}, {} to a leaf", kTrees[static_cast<std::size_t>(search.tree)],
                   kBounds[static_cast<std::size_t>(search.bounds)], counted(search.leaf, "triangle")));
  part("reuse of candidates and features", search.reuse, "while nothing has moved far");
  part("separation lists", search.separation_lists, "walks go on where the last one stopped");
  part("velocity cones", search.velocity_cones, "slow bounds are left as they are");
  part("coherence", search.coherence, "closest points are kept while surfaces hardly move relative to each other");
  part("normal cones", search.normal_cones, "flat regions are skipped");
}

bool collides_with_obstacles(const Scene& scene) {
  const auto collides = [](const auto& body) { return body.collide; };
  const bool any_collides =
      std::ranges::any_of(scene.obstacles, collides) || std::ranges::any_of(scene.characters, collides);
  const bool any_moved = !scene.cloths.empty() || std::ranges::any_of(scene.obstacles, [](const auto& o) {
    return scene::is_dynamic(o) && o.collide;
  });
  return scene.contact.obstacles && any_collides && any_moved;
}

bool collides_with_itself(const Scene& scene) {
  return scene.contact.self && !scene.cloths.empty();
}

void plan_collisions(const Scene& scene, std::vector<PlanItem>& items) {
  const auto obstacles =
      std::count_if(scene.obstacles.begin(), scene.obstacles.end(), [](const scene::Obstacle& o) { return o.collide; });
  const auto characters = std::ranges::count_if(scene.characters, [](const scene::Character& c) { return c.collide; });
  const auto moving = std::count_if(scene.obstacles.begin(), scene.obstacles.end(),
                                    [&](const scene::Obstacle& o) { return scene::has_prescribed_motion(scene, o); });
  const bool with_obstacles = collides_with_obstacles(scene);
  std::string bodies = counted(obstacles, "obstacle");
  if (characters > 0) bodies += ", " + counted(characters, "character");
  const bool self = collides_with_itself(scene);
  const char* without_obstacles = obstacles + characters == 0 ? "no obstacle collides"
                                  : !scene.contact.obstacles  ? "contact.obstacles is false"
                                                              : "no cloth, and forces move no obstacle that collides";
  items.push_back(item_if("collision: cloth and obstacles", with_obstacles, bodies, without_obstacles));
  items.push_back(item_if("collision: cloth and cloth", self, "itself and others",
                          scene.cloths.empty() ? kNoCloth : "contact.self is false"));
  items.push_back(cloth_item(
      "collision: friction", scene, [&](const Cloth& c) { return (with_obstacles || self) && c.material.friction > 0; },
      "no collision, or friction is zero"));
  items.push_back(item_if("collision: velocity constraints",
                          with_obstacles && scene.contact.response == scene::Response::velocity_constraints,
                          "particles against obstacles",
                          with_obstacles ? "contact.response is springs" : without_obstacles));
  plan_search(scene.contact.search, with_obstacles || self, items);
  items.push_back(item_if("motion: key frames", moving > 0, counted(moving, "obstacle"), "no obstacle moves"));
}

// Adds an item with the source of the rest shape for each cloth from a mesh file, and an item with the fit for each
// fitted pattern. Builds these cloths to find both.
void plan_rest_shapes(const Scene& scene, std::vector<PlanItem>& items) {
  environment::Wearers wearers(scene);
  for (const Cloth& cloth : scene.cloths)
    if (cloth.shape == scene::ClothShape::mesh)
      items.push_back({fmt::format("preparation: rest shape of {}", cloth.name), true,
                       environment::make_cloth(scene, cloth, wearers).details.rest_from});
    else if (cloth.fit && cloth.shape == scene::ClothShape::pattern)
      items.push_back({fmt::format("preparation: fit of {}", cloth.name), true,
                       environment::make_cloth(scene, cloth, wearers).details.fitted});
}

void plan_preparation(const Scene& scene, std::vector<PlanItem>& items) {
  plan_rest_shapes(scene, items);
  items.push_back(cloth_item(
      "preparation: sewing", scene,
      [](const Cloth& c) {
        return c.shape == scene::ClothShape::pattern || (c.shape == scene::ClothShape::mesh && c.sewing > 0);
      },
      "no cloth is sewn from flat panels"));
  items.push_back(cloth_item(
      "preparation: untangling", scene, [](const Cloth& c) { return starts_untangled(c) || !c.over.empty(); },
      "every cloth starts as given"));
  const int frames = scene.preroll_frames();
  const std::vector<scene::Layer> layers = scene::list_layers(scene);
  std::string begins;
  for (const scene::Layer& layer : layers) begins += fmt::format("{}{}", begins.empty() ? "" : ", ", layer.first_frame);
  items.push_back(item_if("preparation: layers", layers.size() > 1,
                          fmt::format("{}, put on at frames {}", layers.size(), begins),
                          "no cloth is worn over another"));
  items.push_back(
      item_if("preparation: preroll", frames > 0, counted(frames, "frame") + " before the first", "time.preroll is 0"));
}

// Adds an item for each part of a character that does not collide, and one with the size of the key frames of each
// character. Reads the files of characters to find both.
void plan_characters(const Scene& scene, std::vector<PlanItem>& items) {
  if (scene.characters.empty()) items.push_back({"motion: characters", false, "no character"});
  for (const scene::Character& character : scene.characters) {
    const environment::KeyFrameCount count = environment::count_key_frames(scene, character);
    for (const auto& [part, vertices] : count.left_out)
      items.push_back({fmt::format("collision: {} of {}", part, character.name), false,
                       fmt::format("cloth passes through {} of {} vertices", vertices, count.vertices)});
    items.push_back({fmt::format("motion: character {}", character.name), true,
                     fmt::format("{} of {} vertices, {:.4g} MB, {}", counted(count.keys, "key frame"), count.vertices,
                                 static_cast<double>(count.bytes) / 1e6,
                                 character.interpolation == scene::Interpolation::cubic ? "cubic" : "linear")});
  }
}

// Whether forces move the obstacle, and it can roll (any shape except boxes and half pipes) or starts with a spin.
bool turns_freely(const scene::Obstacle& obstacle) {
  const bool is_round = !std::holds_alternative<scene::BoxShape>(obstacle.shape) &&
                        !std::holds_alternative<scene::HalfPipe>(obstacle.shape);
  return scene::is_dynamic(obstacle) && (is_round || obstacle.spin != Vec3::Zero());
}

}  // namespace

bool can_collide(const Scene& scene) {
  return collides_with_obstacles(scene) || collides_with_itself(scene);
}

std::vector<PlanItem> plan(const Scene& scene) {
  std::vector<PlanItem> items;
  plan_preparation(scene, items);
  plan_forces(scene, items);
  plan_named(scene, items);
  plan_constraints(scene, items);
  plan_collisions(scene, items);
  plan_characters(scene, items);

  const char* midpoint = can_collide(scene) ? "implicit midpoint, BDF2 where something is near" : "implicit midpoint";
  const char* method = scene.time.integrator == scene::Integrator::implicit_euler      ? "implicit Euler"
                       : scene.time.integrator == scene::Integrator::implicit_midpoint ? midpoint
                                                                                       : "BDF2";
  const std::string steps = scene.time.tolerance ? fmt::format("error of a step {:g} m", *scene.time.tolerance)
                                                 : fmt::format("step at most {:.4g} ms", 1e3 * scene.time.step);
  items.push_back({"integrator: " + std::string(method), true, fmt::format("{}, {} fps", steps, scene.time.fps)});
  items.push_back(item_if("render: heat colours", scene.render.heat != scene::HeatQuantity::none,
                          scene.render.heat == scene::HeatQuantity::strain ? "strain" : "speed",
                          "render.heat is none"));
  constexpr const char* kLooks[] = {"studio", "stage", "daylight", "clay", "wire", "strain"};
  items.push_back({fmt::format("render: look {}", kLooks[static_cast<int>(scene.render.look)]), true, "render.look"});
  items.push_back(item_if("render: motion blur", scene.render.motion_blur > 0,
                          fmt::format("{:.4g} degrees of shutter", scene.render.motion_blur),
                          "render.motion_blur is 0"));
  items.push_back(
      item_if("render: depth of field",
              std::ranges::any_of(scene.cameras, [](const scene::Camera& each) { return each.aperture > 0; }),
              "a camera has an aperture", "no camera has an aperture"));
  items.push_back(item_if("render: automatic framing", scene.cameras.empty(), "no camera named",
                          counted(scene.cameras.size(), "camera")));
  return items;
}

std::vector<std::string> find_undrawn(const scene::Scene& scene) {
  std::vector<std::string> found;
  const scene::Obstacle* drawn = nullptr;
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    const auto* plane = std::get_if<scene::Plane>(&obstacle.shape);
    if (plane == nullptr || !plane->infinite || !obstacle.look.visible) continue;
    if (drawn == nullptr)
      drawn = &obstacle;
    else
      found.push_back(fmt::format(
          "obstacle.{}: pictures show only one infinite plane, '{}', and not this one; set infinite = false "
          "in one of them, so that it is drawn within its size",
          obstacle.name, drawn->name));
  }
  for (std::size_t k = frame::kMaxLights; k < scene.lights.size(); ++k)
    found.push_back(fmt::format("light.{}: has no effect, as pictures show that of the first {} lights only",
                                scene.lights[k].name, frame::kMaxLights));
  return found;
}

std::vector<std::string> find_warnings(const scene::Scene& scene) {
  std::vector<std::string> found = find_undrawn(scene);
  if (scene.time.integrator == scene::Integrator::implicit_euler)
    for (const scene::Obstacle& obstacle : scene.obstacles)
      if (turns_freely(obstacle))
        found.push_back(
            fmt::format("obstacle.{}: implicit Euler slows down bodies that turn; time.integrator = "
                        "\"bdf2\" does not",
                        obstacle.name));
  if (!has_moving_pins(scene)) return found;
  const environment::Environment environment(scene);
  for (const auto& texts : {find_jumps(scene, environment), find_entries(scene, environment),
                            find_stretches(scene, environment), find_far_pins(scene, environment)})
    found.insert(found.end(), texts.begin(), texts.end());
  return found;
}

}  // namespace weft::production
