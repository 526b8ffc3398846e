#include "film/scene/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <string>

#include "core/grading.hpp"
#include "core/input_file.hpp"
#include "film/image/picture.hpp"
#include "film/scene/following.hpp"
#include "film/scene/layers.hpp"
#include "film/scene/reader.hpp"
#include "film/scene/rope_checks.hpp"
#include "film/scene/sequence_files.hpp"

namespace weft::scene {

namespace {

// Maximum number of particles of all rectangles of cloth together. Their data fit into the memory of a workstation.
constexpr long kMaxParticles = 4'000'000;

/// The names of all entries of the lists, one list after the other.
template <class... Lists>
std::vector<std::string> names_of(const Lists&... lists) {
  std::vector<std::string> names;
  const auto add = [&](const auto& list) {
    for (const auto& entry : list) names.push_back(entry.name);
  };
  (add(lists), ...);
  return names;
}

std::vector<std::string> names_of_all(const Scene& scene) {
  return names_of(scene.cloths, scene.obstacles, scene.characters);
}

/// Reports `name`, the value of `key`, unless it is in `names` or empty. `kind`: the named objects in the message, such
/// as "a cloth".
void check_reference(const std::string& name, const std::vector<std::string>& names, const std::string& kind,
                     const std::string& key, Findings& findings) {
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return;
  findings.report(key,
                  fmt::format("expected the name of {}, got {}{}", kind, in_quotes(name), suggestion(name, names)));
}

template <class Key>
void check_times(const std::vector<Key>& keys, const std::string& path, Findings& findings) {
  double latest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string key = fmt::format("{}.keys.{}.time", path, i);
    if (!findings.has(key) || findings.has_mistake(key)) continue;
    if (keys[i].time <= latest) {
      findings.report(key, fmt::format("expected > {} s, later than the keys before, got {}", latest, keys[i].time));
    } else if (keys[i].time - latest < model::kMinStep) {
      findings.report(key, fmt::format("expected at least {:g} s after the key before, at {} s, got {}",
                                       model::kMinStep, latest, keys[i].time));
    }
    latest = std::max(latest, keys[i].time);
  }
}

/// Reports each key frame in which several angles change, at least one of them by more than half a turn, because such a
/// change does not define an axis of rotation.
template <class Key>
void check_rotation_changes(const std::vector<Key>& keys, const std::string& path, Findings& findings) {
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const std::string key = fmt::format("{}.keys.{}.rotation", path, i);
    if (!findings.has(key) || findings.has_mistake(key)) continue;
    const auto change = change_of_angles(keys[i - 1].pose, keys[i].pose);
    if (!change || (change->array() != 0).count() < 2 || change->cwiseAbs().maxCoeff() <= 180) continue;
    findings.report(key, fmt::format("expected that since the key before only one angle changes, or none by more than "
                                     "180 degrees; got changes of [{:g}, {:g}, {:g}] degrees",
                                     change->x(), change->y(), change->z()));
  }
}

/// Reports a picture that cannot be decoded, because users must see all mistakes of a scene before a run begins.
void check_image(const std::optional<std::filesystem::path>& image, const std::string& key, Findings& findings) {
  if (!image || !findings.has(key) || findings.has_mistake(key)) return;
  try {
    image::decode_picture(read_bytes(*image, image::kMaxPictureBytes));
  } catch (const std::exception& error) {
    findings.report(key, fmt::format("expected a picture (PNG, JPEG or TGA), got {}: {}", in_quotes(image->string()),
                                     error.what()));
  }
}

void check_part(const Cloth& cloth, const ClothPart& part, const std::string& path, Findings& findings) {
  for (int axis = 0; axis < 2; ++axis) {
    if (part.low[axis] <= part.high[axis]) continue;
    findings.report(path + ".high",
                    fmt::format("expected >= {}, the low end, got {}", part.low[axis], part.high[axis]));
    return;
  }
  if (part.at && !cloth.rope)
    findings.report(path + ".at", "expected none for a cloth that is not a rope; give the part by low and high");
  for (const auto& [key, is_given] :
       {std::pair(".low", part.low != Vec2(0, 0)), std::pair(".high", part.high != Vec2(1, 1)),
        std::pair(".mask", part.mask.has_value())})
    if (part.at && cloth.rope && is_given) findings.report(path + key, "expected none beside at, which gives the part");
  if (part.at && part.at->x() > part.at->y())
    findings.report(path + ".at",
                    fmt::format("expected the lower end first, got {} before {}", part.at->x(), part.at->y()));
  for (const auto& [key, name] : {std::pair(".panel", &part.panel), std::pair(".edge", &part.edge)}) {
    if (name->empty() || cloth.shape == ClothShape::pattern) continue;
    findings.report(path + key, "expected none for a cloth that is not shape = \"pattern\", got " + in_quotes(*name));
    return;
  }
  check_image(part.mask, path + ".mask", findings);
  if (cloth.shape != ClothShape::mesh) {
    if (part.vertex_color != VertexColor::none)
      findings.report(path + ".vertex_color", "expected none for a cloth that is not shape = \"mesh\", got one");
    if (!part.vertex_group.empty())
      findings.report(path + ".vertex_group",
                      "expected none for a cloth that is not shape = \"mesh\", got " + in_quotes(part.vertex_group));
  }
  // Other shapes have no rows of particles; crossed_triangles also has particles between the rows.
  if (rectangle_particles(cloth) == 0 || cloth.shape == ClothShape::crossed_triangles) return;
  // Report a part that lies between two rows of particles, and thus contains no particle. The lambda returns nothing if
  // the part contains a row along an axis, else the position of the nearest row, as a fraction of the size of the
  // cloth.
  const auto nearest_missed_row = [](double low, double high, int count, double grading) {
    std::optional<double> nearest;
    const auto distance = [&](double at) { return std::max({low - at, at - high, 0.0}); };
    for (int i = 0; i < count; ++i) {
      const double at = graded_fraction(i, count, grading);
      ClothPart along;
      along.low.x() = low;
      along.high.x() = high;
      if (along.holds(at, 0)) return std::optional<double>();
      if (!nearest || distance(at) < distance(*nearest)) nearest = at;
    }
    return nearest;
  };
  std::string rows;
  const auto look_along = [&](const char* axis, const std::optional<double>& row) {
    if (row) rows += fmt::format("; the nearest along {} is at {:.6g}", axis, *row);
  };
  look_along("weft", nearest_missed_row(part.low.x(), part.high.x(), cloth.particles_weft, cloth.grading.x()));
  look_along("warp", nearest_missed_row(part.low.y(), part.high.y(), cloth.particles_warp, cloth.grading.y()));
  if (!rows.empty())
    findings.report(path, "expected a part that holds at least one particle, got one between two rows" + rows);
}

void check_pin(const Scene& scene, const Cloth& cloth, const Pin& pin, const std::string& path, Findings& findings) {
  check_times(pin.motion.keys, path, findings);
  check_rotation_changes(pin.motion.keys, path, findings);
  const Followed followed = scene::followed(pin.follow);
  // A text such as ".head" names a part but no body.
  check_reference(followed.body.empty() ? pin.follow : followed.body, names_of(scene.obstacles, scene.characters),
                  "an obstacle or character", path + ".follow", findings);
  for (const Obstacle& obstacle : scene.obstacles)
    if (obstacle.name == followed.body && is_dynamic(obstacle))
      findings.report(
          path + ".follow",
          fmt::format("expected a body that keys move, got {}, which has a mass; [[attach]] ties cloth to it",
                      in_quotes(obstacle.name)));
  if (!followed.part.empty() && !findings.has_mistake(path + ".follow"))
    check_reference(followed.body, names_of(scene.characters), "a character before the part", path + ".follow",
                    findings);
  if (pin.fade > 0 && !pin.strength)
    findings.report(
        path + ".fade",
        fmt::format("expected a strength beside it, got {} m and none; to hold the part exactly and pull the cloth "
                    "around it, write two pins: one without strength, and one with strength and fade",
                    pin.fade));
  check_part(cloth, pin, path, findings);
}

void check_friction_pairs(const Scene& scene, Findings& findings) {
  const std::vector<std::string> names = names_of_all(scene), bodies = names_of(scene.obstacles, scene.characters);
  for (std::size_t i = 0; i < scene.contact.pairs.size(); ++i) {
    const FrictionPair& pair = scene.contact.pairs[i];
    const std::string path = fmt::format("contact.pair.{}", i);
    check_reference(pair.first, names, "a cloth, rope, obstacle or character", path + ".first", findings);
    check_reference(pair.second, names, "a cloth, rope, obstacle or character", path + ".second", findings);
    const auto is_cloth = [&](const std::string& name) { return !std::ranges::count(bodies, name); };
    if (!findings.has_mistake(path + ".first") && !findings.has_mistake(path + ".second") && !is_cloth(pair.first) &&
        !is_cloth(pair.second))
      findings.report(path + ".second", fmt::format("expected a cloth or rope as one of the two, since two bodies "
                                                    "always use their own coefficients; got {} and {}",
                                                    in_quotes(pair.first), in_quotes(pair.second)));
    if (pair.static_friction && *pair.static_friction < pair.friction)
      findings.report(path + ".static_friction",
                      fmt::format("expected >= {}, that of sliding, got {}", pair.friction, *pair.static_friction));
  }
}

void check_attachments(const Scene& scene, Findings& findings) {
  const std::vector<std::string> cloths = names_of(scene.cloths), all = names_of_all(scene);
  for (std::size_t i = 0; i < scene.attachments.size(); ++i) {
    const Attachment& attachment = scene.attachments[i];
    const std::string& path = findings.entry("attach", i);
    check_reference(attachment.cloth, cloths, "a cloth or rope", path + ".cloth", findings);
    check_reference(attachment.to, all, "a cloth, rope, obstacle or character", path + ".to", findings);
    if (attachment.cloth == attachment.to && !attachment.to.empty())
      findings.report(path + ".to",
                      fmt::format("expected another object than the cloth itself, got {}", in_quotes(attachment.to)));
    if (attachment.release >= 0 && attachment.release <= attachment.begin)
      findings.report(path + ".release",
                      fmt::format("expected > {} s, when it begins, got {}", attachment.begin, attachment.release));
    for (const Cloth& cloth : scene.cloths)
      if (cloth.name == attachment.cloth) check_part(cloth, attachment, path, findings);
  }
}

/// Reports each `over` that does not name a cloth. Also reports the `over` of the first cloth that is worn over itself,
/// directly or through other cloths.
void check_layers(const Scene& scene, Findings& findings) {
  const std::vector<std::string> names = names_of(scene.cloths);
  for (std::size_t i = 0; i < scene.cloths.size(); ++i)
    for (const std::string& name : scene.cloths[i].over)
      check_reference(name, names, "a cloth", entry_of_cloth(scene, i, findings) + ".over", findings);
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    const Cloth& cloth = scene.cloths[i];
    const auto cycle_entry = std::ranges::find_if(
        cloth.over, [&](const std::string& name) { return name == cloth.name || worn_over(scene, name, cloth.name); });
    if (cycle_entry == cloth.over.end()) continue;
    findings.report(entry_of_cloth(scene, i, findings) + ".over",
                    fmt::format("expected cloth that is put on before this one, got {}{}", in_quotes(*cycle_entry),
                                *cycle_entry == cloth.name ? ", which it is itself" : ", which is worn over this one"));
    return;
  }
}

void check_look(const Cloth& cloth, const std::string& path, Findings& findings) {
  check_image(cloth.look.image, path + ".look.image", findings);
  for (std::size_t p = 0; p < cloth.look.panels.size(); ++p) {
    const std::string& entry = findings.entry(path + ".look.panel", p);
    check_image(cloth.look.panels[p].image, entry + ".image", findings);
    if (cloth.shape != ClothShape::pattern)
      findings.report(entry, "expected none for a cloth that is not shape = \"pattern\"");
  }
}

void check_cloths(const Scene& scene, Findings& findings) {
  long particles = 0;
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    const Cloth& cloth = scene.cloths[i];
    const std::string& path = entry_of_cloth(scene, i, findings);
    particles += rectangle_particles(cloth);
    if (particles > kMaxParticles) {
      findings.report(path + ".particles",
                      fmt::format("expected at most {} in all cloths together, got {}", kMaxParticles, particles));
    }
    check_reference(cloth.wearer, names_of(scene.characters), "a character", path + ".wearer", findings);
    if (cloth.rest == ClothRest::mesh && cloth.uv_scale)
      findings.report(path + ".uv_scale", "expected none beside rest = \"mesh\", got one");
    check_look(cloth, path, findings);
    check_times(cloth.pressure.keys, path + ".pressure", findings);
    for (std::size_t p = 0; p < cloth.pins.size(); ++p) {
      check_pin(scene, cloth, cloth.pins[p], findings.entry(path + ".pin", p), findings);
    }
    for (std::size_t w = 0; w < cloth.weights.size(); ++w) {
      check_part(cloth, cloth.weights[w], findings.entry(path + ".weight", w), findings);
    }
  }
}

void check_shape(const Shape& shape, const std::string& path, Findings& findings) {
  if (const auto* torus = std::get_if<Torus>(&shape); torus && torus->tube_radius >= torus->radius) {
    findings.report(path + ".tube_radius",
                    fmt::format("expected < {} m, the radius, got {}", torus->radius, torus->tube_radius));
  }
  if (const auto* box = std::get_if<BoxShape>(&shape); box && 2 * box->bevel >= box->size.minCoeff()) {
    findings.report(path + ".bevel", fmt::format("expected < {} m, half the shortest edge, got {}",
                                                 box->size.minCoeff() / 2, box->bevel));
  }
}

// Forces move obstacles that have a mass or density. For these, reports keys that contradict such motion; for all other
// obstacles, reports keys that need a mass or density.
void check_dynamics(const Scene& scene, const Obstacle& obstacle, const std::string& path, Findings& findings) {
  if (!is_dynamic(obstacle)) {
    for (const auto& [key, is_given] :
         {std::pair("velocity", obstacle.velocity != Vec3::Zero()), std::pair("spin", obstacle.spin != Vec3::Zero()),
          std::pair("release", obstacle.release.value_or(0) > 0)})
      if (is_given)
        findings.report(fmt::format("{}.{}", path, key),
                        "expected a mass or density beside it, got none; without, only keys move an obstacle");
    return;
  }
  if (obstacle.mass > 0 && obstacle.density > 0)
    findings.report(path + ".density",
                    fmt::format("expected none beside a mass of {} kg, got {}", obstacle.mass, obstacle.density));
  if (!obstacle.follow.empty())
    findings.report(path + ".follow", fmt::format("expected none beside a mass, which lets forces move it, got {}",
                                                  in_quotes(obstacle.follow)));
  if (std::holds_alternative<Plane>(obstacle.shape))
    findings.report(path + ".shape", "expected a closed shape for a body with a mass, got \"plane\"");
  if (scene.contact.response == Response::velocity_constraints)
    findings.report(
        "contact.response",
        fmt::format("expected \"springs\", as {} has a mass, got \"velocity_constraints\"", in_quotes(obstacle.name)));
  if (obstacle.motion.keys.size() < 2) return;
  for (const auto& [key, value] : {std::pair("velocity", obstacle.velocity), std::pair("spin", obstacle.spin)})
    if (value != Vec3::Zero())
      findings.report(fmt::format("{}.{}", path, key),
                      "expected none beside keys, which give its velocity at the release");
  if (!obstacle.release || *obstacle.release <= scene.start_time())
    findings.report(path + ".release",
                    fmt::format("expected > {:g} s beside keys, which move it until then, got {}", scene.start_time(),
                                obstacle.release ? fmt::format("{:g}", *obstacle.release) : "none"));
}

void check_obstacles(const Scene& scene, Findings& findings) {
  const std::vector<std::string> cloths = names_of(scene.cloths);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const Obstacle& obstacle = scene.obstacles[i];
    const std::string& path = findings.entry("obstacle", i);
    check_shape(obstacle.shape, path, findings);
    check_image(obstacle.look.image, path + ".look.image", findings);
    check_times(obstacle.motion.keys, path, findings);
    check_rotation_changes(obstacle.motion.keys, path, findings);
    check_dynamics(scene, obstacle, path, findings);
    // Names must be unique, because they identify objects in pictures, statistics and mesh files.
    if (!obstacle.name.empty() && std::find(cloths.begin(), cloths.end(), obstacle.name) != cloths.end()) {
      findings.report(path + ".name", fmt::format("expected a name used once, got {}, which a cloth or rope has",
                                                  in_quotes(obstacle.name)));
    }
  }
}

void check_characters(const Scene& scene, Findings& findings) {
  const std::vector<std::string> others = names_of(scene.cloths, scene.obstacles);
  for (std::size_t i = 0; i < scene.characters.size(); ++i) {
    const Character& character = scene.characters[i];
    const std::string& path = findings.entry("character", i);
    if (!character.name.empty() && std::find(others.begin(), others.end(), character.name) != others.end())
      findings.report(path + ".name",
                      fmt::format("expected a name used once, got {}, which a cloth, rope or obstacle has",
                                  in_quotes(character.name)));
    if (const SkeletonMotion* skeleton_motion = skeleton_motion_of(character);
        skeleton_motion != nullptr && (skeleton_motion->stance == Stance::rest || skeleton_motion->stance_arms) &&
        character.blend <= 0)
      findings.report(path + ".blend",
                      fmt::format("expected > 0 s to get from the {} to the clip, got {}",
                                  skeleton_motion->stance_arms ? "stance" : "rest pose", character.blend));
    if (character.grow > character.dressing)
      findings.report(path + ".grow", fmt::format("expected at most the {} s of dressing, in which it stands, got {}",
                                                  character.dressing, character.grow));
    if (const auto* mannequin = std::get_if<Mannequin>(&character.source);
        mannequin != nullptr && mannequin->motion && mannequin->walk > 0)
      findings.report(path + ".walk",
                      fmt::format("expected 0 beside a motion, which moves the mannequin, got {}", mannequin->walk));
    const auto* sequence = std::get_if<MeshSequence>(&character.source);
    if (sequence == nullptr || sequence->files.empty()) continue;
    if (!is_utf8(sequence->files))
      findings.report(
          path + ".files",
          "expected files in a folder whose path is UTF-8, as the effective scene must be, got another path; "
          "rename the scene's folder");
    if (const std::size_t count = sequence_files(sequence->files).size(); count < 2)
      findings.report(path + ".files",
                      fmt::format("expected a folder, or a file name with a *, of at least 2 files, got "
                                  "{}: {} there",
                                  in_quotes(sequence->files), count));
  }
}

/// Reports key frames with a focal length if the first one has a field of view, and the reverse, because a camera
/// cannot change between the two. Also reports `sensor_width` without `focal_length`, and `follow_rotation` without
/// `follow`.
void check_lens(const Camera& camera, const std::string& path, Findings& findings) {
  const bool by_focal_length = has_focal_length(camera);
  if (!by_focal_length && findings.has(path + ".sensor_width"))
    findings.report(path + ".sensor_width", "expected a focal_length beside it, got none");
  if (camera.follow.empty() && findings.has(path + ".follow_rotation"))
    findings.report(path + ".follow_rotation", "expected a follow beside it, got none");
  const std::string wrong = by_focal_length ? "field_of_view" : "focal_length";
  for (std::size_t k = 0; k < camera.keys.size(); ++k) {
    const std::string key = fmt::format("{}.keys.{}.{}", path, k, wrong);
    if (findings.has(key) && !findings.has_mistake(key))
      findings.report(key, fmt::format("expected {} as in the keys before, got {}",
                                       by_focal_length ? "focal_length" : "field_of_view", wrong));
  }
}

void check_cameras(const Scene& scene, Findings& findings) {
  const std::vector<std::string> objects = names_of_all(scene);
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    const std::string& path = findings.entry("camera", i);
    check_times(camera.keys, path, findings);
    check_lens(camera, path, findings);
    for (const std::string& name : camera.subjects)
      check_reference(name, objects, "a cloth, rope, obstacle or character", path + ".subject", findings);
    if (camera.kind == CameraKind::file && camera.aperture > 0 && camera.focus <= 0)
      findings.report(path + ".aperture", "expected focus beside it, in m, since a camera of a file has no target");
    if (camera.kind != CameraKind::placed) continue;
    for (std::size_t k = 0; k < camera.keys.size(); ++k) {
      if (camera.keys[k].position != camera.keys[k].target) continue;
      const std::string in_key = fmt::format("{}.keys.{}", path, k);
      const std::string& where = findings.has(in_key) ? in_key : path;
      if (!findings.has_mistake(path + ".position") && !findings.has_mistake(path + ".target")) {
        findings.report(where + ".target", "expected a point away from position, got the same");
      }
    }
  }
  check_reference(scene.render.camera, names_of(scene.cameras), "a camera", "render.camera", findings);
}

}  // namespace

const std::string& entry_of_cloth(const Scene& scene, std::size_t cloth, const Findings& findings) {
  const std::size_t sheets = scene.cloths.size() - scene.ropes.size();
  return cloth < sheets ? findings.entry("cloth", cloth) : findings.entry("rope", cloth - sheets);
}

void check(const Scene& scene, Findings& findings) {
  const bool empty = scene.cloths.empty() && scene.obstacles.empty() && scene.characters.empty();
  if (empty && !findings.has("cloth") && !findings.has("obstacle") && !findings.has("character") &&
      !findings.has("rope")) {
    findings.report("", "expected at least one [[cloth]], [[rope]], [[obstacle]] or [[character]], got none");
  }
  if (const double frames = scene.time.duration * scene.time.fps; frames > kMaxFrames) {
    findings.report("time.duration",
                    fmt::format("expected at most {} frames (duration * fps), got {:.0f}", kMaxFrames, frames));
  }
  if (const double steps = 1 / (scene.time.fps * scene.time.step); steps > model::kMaxStepsInFrame) {
    findings.report("time.step", fmt::format("expected at most {:g} steps in a frame (1 / (fps * step)), got {:.3g}",
                                             model::kMaxStepsInFrame, steps));
  }
  check_times(scene.physics.keys, "physics", findings);
  for (std::size_t i = 0; i < scene.ropes.size(); ++i)
    check_times(scene.ropes[i].keys, findings.entry("rope", i), findings);
  for (std::size_t i = 0; i < scene.fans.size(); ++i)
    check_times(scene.fans[i].keys, findings.entry("fan", i), findings);
  check_cloths(scene, findings);
  check_ropes(scene, findings);
  check_layers(scene, findings);
  check_attachments(scene, findings);
  check_friction_pairs(scene, findings);
  check_obstacles(scene, findings);
  check_following(scene, findings);
  check_characters(scene, findings);
  check_cameras(scene, findings);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    check_times(scene.lights[i].keys, findings.entry("light", i), findings);
  }
}

}  // namespace weft::scene
