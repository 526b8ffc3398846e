#include "film/environment/actor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "film/assets/character_file.hpp"
#include "film/assets/sequence_file.hpp"
#include "film/assets/source.hpp"
#include "film/character/dressing.hpp"
#include "film/character/gait.hpp"
#include "film/character/joints.hpp"
#include "film/character/limb_clearance.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/parts.hpp"
#include "film/character/performance.hpp"
#include "film/character/retarget.hpp"
#include "film/character/travel.hpp"
#include "film/environment/body_parts.hpp"
#include "film/environment/character_context.hpp"
#include "film/environment/clearance.hpp"
#include "film/environment/plausibility.hpp"
#include "film/environment/soles.hpp"
#include "film/scene/sequence_files.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::environment {
namespace {

/// Limits of the rate of key frames, for scenes that do not set it [1/s].
constexpr double kMinKeyRate = 10, kMaxKeyRate = 120;

/// Minimum rate of key frames of a body that grows or lowers its arms, if the scene sets no rate [1/s].
constexpr double kDressingRate = 25;

/// Maximum size of the key frames of one character [bytes]. A larger one suggests a mistyped rate.
constexpr std::size_t kMaxKeyFrameBytes = std::size_t{8} << 30;

/// Maximum jump of a vertex from the end of a loop to its start without a warning [m].
constexpr double kMaxInvisibleGap = 1e-3;

/// Maximum slip speed of feet without a warning, relative to their own speed: 5 cm in a step of 0.7 m.
constexpr double kMaxFootSlide = 0.07;

/// Minimum vertical component of the mean unit vector along the trunk of a body that stands upright.
constexpr double kMinUprightness = 0.7;

/// Loads a motion file. A BVH file does not state its up axis. If the scene does not state it either, it is z if the
/// body in the file stands along z, else y.
assets::LoadedCharacter load_upright(const CharacterContext& context, const scene::SkeletonMotion& skeleton_motion,
                                     std::vector<std::string>& warnings) {
  const auto load = [&](scene::FileUp up) {
    return assets::load_motion(*skeleton_motion.motion, {{}, up, context.scene.up}, context.where);
  };
  assets::LoadedCharacter motion = load(skeleton_motion.motion_up);
  if (skeleton_motion.motion_up != scene::FileUp::as_file || !assets::is_bvh(*skeleton_motion.motion)) return motion;
  const auto joints = joints_of(context, skeleton_motion.joints, &scene::JointNames::motion, motion.character,
                                skeleton_motion.motion->string());
  const character::Clip& clip =
      choose_clip(context, skeleton_motion.clip, motion.character.clips, skeleton_motion.motion->string());
  const Vec3 trunk = character::mean_trunk({motion.character, joints}, clip);
  const Mat3 from_y = assets::rotation_to_scene_axes(1, context.scene.up),
             from_z = assets::rotation_to_scene_axes(2, context.scene.up);
  const double along_y = trunk.dot(context.up()), along_z = (from_z * from_y.transpose() * trunk).dot(context.up());
  if (along_z < kMinUprightness || along_y > along_z) return motion;
  warnings.push_back(
      fmt::format("{}: motion file {}: bodies stand along z, which is taken to be up; if y is, write "
                  "motion_up = \"y\"",
                  context.where, skeleton_motion.motion->string()));
  return load(scene::FileUp::z);
}

/// Returns the clip with the travel that the scene sets. `size`: of the body / of the clip's skeleton
/// (character::size_ratio).
character::Clip travel(const CharacterContext& context, const scene::SkeletonMotion& skeleton_motion,
                       const character::Rig& rig, const character::Clip& clip, double size,
                       std::vector<std::string>& warnings) {
  if (skeleton_motion.travel.kind == scene::Travel::Kind::file || clip.duration <= 0) return clip;
  if (skeleton_motion.travel.kind == scene::Travel::Kind::none)
    return character::remove_travel(rig, clip, context.up());
  const double to_scene = size * context.settings.speed, speed = skeleton_motion.travel.speed;
  character::TravelResult traveled = character::set_travel_speed(rig, clip, speed / to_scene, context.up());
  const double feet = to_scene * traveled.feet;
  if (feet == 0) {
    warnings.push_back(
        fmt::format("{}: travel: clip \"{}\" takes no steps: feet slide at {:g} m/s", context.where, clip.name, speed));
  } else if (std::abs(feet - speed) > kMaxFootSlide * feet) {
    warnings.push_back(
        fmt::format("{}: travel: feet of clip \"{}\" go at {:.3g} m/s and slide at {:g} m/s; speed = {:.3g} would make "
                    "them fit",
                    context.where, clip.name, feet, speed, context.settings.speed * speed / feet));
  }
  return std::move(traveled.clip);
}

character::Clip retarget_motion(const CharacterContext& context, const scene::SkeletonMotion& skeleton_motion,
                                Body& body) {
  const std::string file = skeleton_motion.motion->string();
  assets::LoadedCharacter motion = load_upright(context, skeleton_motion, body.warnings);
  body.warnings.insert(body.warnings.end(), motion.warnings.begin(), motion.warnings.end());
  const std::vector<Index>& ours = body.joints;
  const auto theirs = joints_of(context, skeleton_motion.joints, &scene::JointNames::motion, motion.character, file);
  check_hips(context, ours, body.character.nodes, body.source);
  check_hips(context, theirs, motion.character.nodes, file);
  std::vector<std::string> still;
  for (std::size_t j = 0; j < ours.size(); ++j)
    if (ours[j] >= 0 && theirs[j] < 0) still.push_back(character::joint_names()[j]);
  if (!still.empty())
    body.warnings.push_back(
        fmt::format("{}: motion file {}: nothing that moves {}", context.where, file, fmt::join(still, ", ")));
  put_on_floor(context, body);
  const character::Rig from{motion.character, theirs}, to{body.character, ours};
  const character::Clip& chosen = choose_clip(context, skeleton_motion.clip, motion.character.clips, file);
  const character::Skeleton our_skeleton(to), their_skeleton(from);
  const double size =
      character::size_ratio(our_skeleton, our_skeleton.at(character::rest_pose(body.character)), their_skeleton,
                            their_skeleton.at(character::pose_at(motion.character, chosen, 0)));
  const character::Clip clip = travel(context, skeleton_motion, from, chosen, size, body.warnings);
  character::Retargeted result = character::retarget(to, from, clip, context.up());
  for (const std::string& warning : result.warnings)
    body.warnings.push_back(fmt::format("{}: motion file {}: {}", context.where, file, warning));
  return std::move(result.clip);
}

/// Objects of the file that cloths of the scene use. The body does not include them.
std::vector<std::string> find_objects_of_cloths(const CharacterContext& context, const std::filesystem::path& file) {
  std::vector<std::string> objects;
  std::error_code ignored;
  for (const scene::Cloth& cloth : context.scene.cloths)
    if (cloth.shape == scene::ClothShape::mesh && !cloth.object.empty() &&
        std::filesystem::equivalent(cloth.file, file, ignored))
      objects.push_back(cloth.object);
  return objects;
}

/// Makes the body in a file, without the objects that cloths use.
Body make_body(const CharacterContext& context, const scene::CharacterFile& source) {
  assets::LoadedCharacter loaded =
      assets::load_character(source.path, context.axes(), context.where,
                             {source.meshes, source.without, find_objects_of_cloths(context, source.path)});
  return {source.path.string(), std::move(loaded.character), {}, std::move(loaded.warnings), loaded.scale};
}

Body make_body(const CharacterContext& context, const scene::Mannequin& source) {
  Body body{"the mannequin",
            character::make_mannequin({source.height, source.girth, source.masculinity, source.edge_length}),
            {},
            {}};
  if (source.walk > 0)
    body.character.clips.push_back(character::make_walk(
        body.character,
        {.speed = source.pace, .distance = source.walk, .turn_back = source.turn_back, .arms_out = source.arms_out}));
  // The same rotation as in rotate_to_up_axis() (orientation.cpp).
  const Mat3 z_to_y{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  if (context.scene.up == scene::UpAxis::y) assets::transform(body.character, 1, z_to_y);
  return body;
}

template <class Source>
Body make_playing_body(const CharacterContext& context, const Source& source) {
  Body body = make_body(context, source);
  body.joints = joints_of(context, source.joints, &scene::JointNames::body, body.character, body.source);
  if (source.motion) {
    body.clip = retarget_motion(context, source, body);
  } else if (source.clip || !body.character.clips.empty()) {
    body.clip = travel(context, source, {body.character, body.joints},
                       choose_clip(context, source.clip, body.character.clips, body.source), 1, body.warnings);
  } else if (source.travel.kind == scene::Travel::Kind::speed) {
    body.warnings.push_back(
        fmt::format("{}: travel: {} has no clip that could travel; it stands still", context.where, body.source));
  }
  if (body.clip)
    if (const auto warning = warn_of_missing_skin(body.character, *body.clip))
      body.warnings.push_back(fmt::format("{}: {} {}", context.where, body.source, *warning));
  if (body.clip && !source.loop) check_start(context, fmt::format("clip \"{}\"", body.clip->name), body.clip->duration);
  return body;
}

/// Adds the points of `pin` to a body with `vertices` vertices of its own. `start`: pose at the start of the run.
void add_follower_points(const CharacterContext& context, const FollowerPoints& pin, const std::vector<Part>& parts,
                         const character::Pose& start, std::size_t vertices, character::Character& body) {
  character::VertexMask mask(vertices, 1);
  if (!pin.part.empty()) mask = std::ranges::find(parts, pin.part, &Part::name)->vertices;
  const scene::Pose& pose = context.settings.pose;
  std::vector<Vec3> places;
  for (const Vec3& place : pin.places) places.push_back(pose.rotation.conjugate() * (place - pose.position));
  character::add_followers(body, start, mask, places);
}

/// Times of the key frames of a character: k / rate for `count` integers k from `first` on.
struct KeyTimes {
  double rate = kMinKeyRate;  // [1/s]
  long first = 0;
  std::size_t count = 1;

  std::size_t bytes(std::size_t vertices, scene::Interpolation interpolation) const {
    const std::size_t stored = interpolation == scene::Interpolation::cubic && count > 1 ? 2 : 1;
    return count * vertices * stored * sizeof(Vec3);
  }
};

/// Chooses the times of the key frames. `clip_rate`: keys per second of the clip; 0: no clip. `changes_stance`: whether
/// the body leaves a stance after `dressing`.
KeyTimes key_times(const CharacterContext& context, double clip_rate, bool changes_stance) {
  const scene::Character& settings = context.settings;
  KeyTimes times;
  const double duration = context.scene.time.duration, begin = context.begin();
  const bool grows = settings.grow > 0, moves = (clip_rate > 0 || changes_stance) && duration > context.motion_start();
  if (!grows && !moves) return times;
  times.rate = settings.keys_per_second.value_or(std::clamp(clip_rate * settings.speed, kMinKeyRate, kMaxKeyRate));
  if (!settings.keys_per_second && (grows || changes_stance)) times.rate = std::max(times.rate, kDressingRate);
  times.first = static_cast<long>(std::floor((grows ? begin : context.motion_start()) * times.rate));
  // A body stands still from its last key on. The last key must therefore be after the end of its motion.
  const double end = moves ? duration : begin + settings.grow;
  times.count = static_cast<std::size_t>(static_cast<long>(std::ceil(end * times.rate)) + 2 - times.first);
  return times;
}

template <class Source>
KeyTimes key_times(const CharacterContext& context, const Source& source, const Body& body) {
  const double rate = body.clip ? character::key_rate(*body.clip) : 0;
  const bool leaves_rest = body.clip && source.stance == scene::Stance::rest;
  return key_times(context, rate, source.stance_arms || (leaves_rest && rate == 0));
}

void check_memory(const CharacterContext& context, const KeyTimes& times, std::size_t vertices) {
  const std::size_t bytes = times.bytes(vertices, context.settings.interpolation);
  if (bytes > kMaxKeyFrameBytes)
    context.fail("keys_per_second", fmt::format("expected at most {} bytes of key frames, got {}: {} of {} vertices",
                                                kMaxKeyFrameBytes, bytes, times.count, vertices));
}

/// Samples a body at the times of its key frames. `vertices_at`(t, x): writes the positions of its vertices at the time
/// t of the scene [s] to x, in the coordinates of the body [m].
KeyFrames sample(const CharacterContext& context, const KeyTimes& times, std::size_t vertices,
                 const std::function<void(double, std::vector<Vec3>&)>& vertices_at) {
  check_memory(context, times, vertices);
  const scene::Pose& pose = context.settings.pose;
  std::vector<std::vector<Vec3>> keys(times.count, std::vector<Vec3>(vertices));
  for (std::size_t k = 0; k < times.count; ++k) {
    const double t = static_cast<double>(times.first + static_cast<long>(k)) / times.rate;
    vertices_at(t, keys[k]);
    for (std::size_t v = 0; v < vertices; ++v) {
      Vec3& x = keys[k][v];
      x = pose.position + pose.rotation * x;
      if (!(x.cwiseAbs().maxCoeff() < assets::kMaxCoordinate))
        throw Error(ExitCode::asset_unreadable,
                    "{}: expected coordinates below {:g} m, got ({:g}, {:g}, {:g}) for vertex {} at {:g} s",
                    context.where, assets::kMaxCoordinate, x.x(), x.y(), x.z(), v, t);
    }
  }
  return {context.settings.interpolation, static_cast<double>(times.first) / times.rate, 1 / times.rate,
          std::move(keys), context.settings.dressing > 0};
}

/// Warns of a body whose size suggests a wrong unit of its file.
void check_size(const CharacterContext& context, const scene::CharacterFile& source, Body& body) {
  std::vector<Vec3> x(body.character.mesh.positions.size());
  character::skin(body.character, character::rest_pose(body.character), x);
  if (const auto warning = warn_of_height(x, context.up(), body.scale, context.settings.scale.has_value()))
    body.warnings.push_back(fmt::format("{}: {} {}", context.where, source.path.string(), *warning));
}

void check_size(const CharacterContext&, const scene::Mannequin&, Body&) {}

/// The motion of a body. The body and the clip must outlive the result.
template <class Source>
character::Performance performance_of(const CharacterContext& context, const Source& source, const Body& body,
                                      const character::Clip& clip) {
  character::Playing playing{context.timing(), source.loop, source.crossfade, {}};
  if (source.stance == scene::Stance::rest && body.clip) playing.stance = character::rest_pose(body.character);
  if (source.stance_arms) {
    const character::Pose stance =
        character::Performance(body.character, clip, playing, context.up()).at(context.begin());
    playing.stance = character::raise_arms({body.character, body.joints}, stance, *source.stance_arms, context.up());
  }
  return {body.character, clip, playing, context.up()};
}

template <class Source>
StandingBody make_standing(const CharacterContext& context, const Source& source, const std::string& /*where*/) {
  const Body body = make_playing_body(context, source);
  const character::Character& character = body.character;
  const character::Clip still;
  const character::Pose pose =
      performance_of(context, source, body, body.clip ? *body.clip : still).at(context.begin());
  const scene::Pose& placed = context.settings.pose;
  StandingBody standing;
  standing.mesh = character.mesh;
  character::skin(character, pose, standing.mesh.positions);
  for (Vec3& x : standing.mesh.positions) x = placed.position + placed.rotation * x;
  const std::vector<character::Affine> globals = character::global_transforms(character, pose);
  for (const Index node : body.joints) {
    auto& joint = standing.joints.emplace_back();
    if (node >= 0) joint = placed.position + placed.rotation * globals[node].translation();
  }
  standing.limbs = character::limbs_of(character, body.joints);
  return standing;
}

StandingBody make_standing(const CharacterContext& context, const scene::MeshSequence& /*source*/,
                           const std::string& where) {
  throw Error(ExitCode::scene_invalid,
              "{}: expected a wearer with bones, around which the panels of the pattern start; got '{}', a sequence of "
              "meshes",
              where, context.settings.name);
}

/// Makes the LimbClearance for cloth; none if there is no clip, no clearance or no cloth near the body.
std::optional<character::LimbClearance> limb_clearance_of(const CharacterContext& context, const Body& body,
                                                          const character::Performance& performance,
                                                          const std::vector<Part>& parts,
                                                          std::span<const ClothAtStart> cloths) {
  const double clearance = clearance_between_limbs(context);
  if (clearance == 0 || !body.clip) return std::nullopt;
  std::vector<float> near_cloth = nearness_of_cloths(context, body.character, performance, cloths);
  if (std::ranges::all_of(near_cloth, [](float near) { return near <= 0; })) return std::nullopt;
  character::VertexMask touched(body.character.mesh.positions.size(), 1);
  for (const Part& part : parts)
    for (std::size_t v = 0; v < part.vertices.size(); ++v)
      if (!part.collide && part.vertices[v] != 0) touched[v] = 0;
  return character::LimbClearance({body.character, body.joints}, touched, std::move(near_cloth), clearance,
                                  static_grounds(context));
}

/// The largest displacement of a vertex of the skin over all keys, with its time and its place.
struct MaxDisplacement {
  character::LargestDisplacement moved;
  double time = 0;      // [s]
  Vec3 place{0, 0, 0};  // position of the vertex in the coordinates of the body [m]

  void add(const character::LargestDisplacement& now, double t, std::span<const Vec3> x) {
    if (now.distance <= moved.distance) return;
    moved = now, time = t, place = x[now.vertex];
  }
};

/// Minimum displacement of skin that is reported [m]. Smaller displacements are not visible.
constexpr double kMinReportedDisplacement = 1e-3;

std::optional<std::string> describe(const CharacterContext& context, const MaxDisplacement& most) {
  if (most.moved.distance < kMinReportedDisplacement) return std::nullopt;
  const Vec3 x = context.settings.pose.position + context.settings.pose.rotation * most.place;
  return fmt::format(
      "{}: room: skin of the {} moves by up to {:.3g} mm, at ({:.3g}, {:.3g}, {:.3g}) m and {:.3g} s, to leave space "
      "for cloth beside the {}; room = 0 prevents this",
      context.where, most.moved.limb, 1e3 * most.moved.distance, x.x(), x.y(), x.z(), most.time, most.moved.away_from);
}

template <class Source>
Actor make_actor_of(const CharacterContext& context, const Source& source, std::span<const FollowerPoints> following,
                    std::span<const ClothAtStart> cloths) {
  Body body = make_playing_body(context, source);
  check_size(context, source, body);
  const character::Clip still;
  const character::Clip& clip = body.clip ? *body.clip : still;
  const character::Performance performance = performance_of(context, source, body, clip);
  if (const double gap = performance.gap(); gap > kMaxInvisibleGap)
    body.warnings.push_back(
        fmt::format("{}: clip \"{}\" does not close: its end and its beginning are {:.3g} m apart; "
                    "a crossfade would join them",
                    context.where, clip.name, gap));
  std::vector<Part> parts = parts_of(context, following, body);
  const std::size_t vertices = body.character.mesh.positions.size();
  const std::optional<character::LimbClearance> clearance =
      limb_clearance_of(context, body, performance, parts, cloths);
  MaxDisplacement moved;
  std::vector<Index> limbs = shells_of_limbs(body);
  const character::Pose start = performance.at(context.begin());
  for (const FollowerPoints& pin : following) add_follower_points(context, pin, parts, start, vertices, body.character);
  const KeyTimes times = key_times(context, source, body);
  std::vector<Vec3> bones;  // per vertex of the body, without followers: the point from which it grows [m]
  if (context.settings.grow > 0) bones = character::growth_start_positions(body.character, start);
  bones.resize(std::min(bones.size(), vertices));
  const std::vector<character::Ground> grounds = static_grounds(context);
  std::vector<double> lowest;  // height of the lowest vertex over the floor at each key [m]
  KeyFrames keys = sample(context, times, body.character.mesh.positions.size(), [&](double t, std::vector<Vec3>& x) {
    const character::Pose pose = performance.at(t);
    character::skin(body.character, pose, x);
    if (grounds.size() == 1) lowest.push_back(height_over(grounds[0], std::span(x).first(vertices)));
    if (clearance) moved.add(clearance->move_skin(pose, x), t, x);
    const double since = t - context.begin();
    if (since >= context.settings.grow) return;
    for (std::size_t v = 0; v < bones.size(); ++v)
      x[v] = bones[v] + character::growth_fraction(since, context.settings.grow) * (x[v] - bones[v]);
  });
  if (const auto warning =
          warn_of_speed(keys, static_cast<double>(times.first) / times.rate, times.rate, times.count, vertices))
    body.warnings.push_back(fmt::format("{}: {}", context.where, *warning));
  if (const auto warning = warn_of_floor_distance(std::move(lowest), context.scene.obstacles.size() == 1))
    body.warnings.push_back(fmt::format("{}: {}", context.where, *warning));
  std::vector<std::string> notes;
  if (auto note = describe(context, moved)) notes.push_back(*std::move(note));
  mesh::Mesh mesh = std::move(body.character.mesh);
  mesh.positions.resize(vertices);
  keys.at(0, mesh.positions);
  std::shared_ptr<const character::Coloring> coloring;
  if (!body.character.coloring.material_of_triangle.empty())
    coloring = std::make_shared<const character::Coloring>(std::move(body.character.coloring));
  return {std::move(mesh),          std::move(keys),  std::move(parts),   std::move(limbs),
          std::move(body.warnings), std::move(notes), std::move(coloring)};
}

Actor make_actor_of(const CharacterContext& context, const scene::MeshSequence& source,
                    std::span<const FollowerPoints> following, std::span<const ClothAtStart> /*cloths*/) {
  assets::LoadedSequence loaded =
      assets::load_sequence(scene::sequence_files(source.files), context.axes(), context.where);
  const std::size_t vertices = loaded.mesh.positions.size();
  check_start(context, "its files", static_cast<double>(loaded.positions.size() - 1) / source.fps);
  if (!context.settings.parts.empty() ||
      !std::ranges::all_of(following, [](const auto& pin) { return pin.part.empty(); }))
    context.fail("part", "expected none of a body from a sequence of meshes, which has no bones");
  if (context.settings.grow > 0)
    context.fail("grow", "expected 0 of a body from a sequence of meshes, which has no bones");
  const KeyFrames files(context.settings.interpolation, 0, 1 / source.fps, std::move(loaded.positions), false);
  KeyFrames keys =
      sample(context, key_times(context, source.fps, false), vertices,
             [&](double t, std::vector<Vec3>& x) { files.at(character::clip_time(context.timing(), t), x); });
  keys.at(0, loaded.mesh.positions);
  std::vector<Index> limbs = mesh::components(loaded.mesh.topology.triangles, vertices);
  return {std::move(loaded.mesh), std::move(keys), {}, std::move(limbs), {}, {}};
}

KeyFrameCount count(const CharacterContext& context, const KeyTimes& times, std::size_t vertices) {
  return {times.count, vertices, times.bytes(vertices, context.settings.interpolation)};
}

template <class Source>
KeyFrameCount count(const CharacterContext& context, const Source& source) {
  Body body = make_playing_body(context, source);
  KeyFrameCount counted = count(context, key_times(context, source, body), body.character.mesh.positions.size());
  for (const Part& part : parts_of(context, {}, body))
    if (!part.collide) counted.left_out.emplace_back(part.name, std::ranges::count(part.vertices, 1));
  return counted;
}

KeyFrameCount count(const CharacterContext& context, const scene::MeshSequence& source) {
  // The number of vertices after merging depends on all files.
  const auto loaded = assets::load_sequence(scene::sequence_files(source.files), context.axes(), context.where);
  check_start(context, "its files", static_cast<double>(loaded.positions.size() - 1) / source.fps);
  return count(context, key_times(context, source.fps, false), loaded.mesh.positions.size());
}

}  // namespace

Actor make_actor(const scene::Scene& scene, const scene::Character& character,
                 std::span<const FollowerPoints> following, std::span<const ClothAtStart> cloths) {
  const CharacterContext context = make_character_context(scene, character);
  return std::visit([&](const auto& source) { return make_actor_of(context, source, following, cloths); },
                    character.source);
}

StandingBody make_standing_body(const scene::Scene& scene, const scene::Character& character,
                                const std::string& where) {
  const CharacterContext context = make_character_context(scene, character);
  return std::visit([&](const auto& source) { return make_standing(context, source, where); }, character.source);
}

Vec3 offset_in_file(const scene::Scene& scene, const scene::Character& character) {
  const auto* file = std::get_if<scene::CharacterFile>(&character.source);
  if (file == nullptr || !file->motion) return Vec3::Zero();
  const CharacterContext context = make_character_context(scene, character);
  return floor_offset(context, make_body(context, *file).character);
}

KeyFrameCount count_key_frames(const scene::Scene& scene, const scene::Character& character) {
  const CharacterContext context = make_character_context(scene, character);
  return std::visit([&](const auto& source) { return count(context, source); }, character.source);
}

}  // namespace weft::environment
