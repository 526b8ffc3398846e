#include "environment/acting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "assets/character_file.hpp"
#include "assets/sequence_file.hpp"
#include "assets/source.hpp"
#include "character/gait.hpp"
#include "character/joints.hpp"
#include "character/mannequin.hpp"
#include "character/performance.hpp"
#include "character/retarget.hpp"
#include "core/error.hpp"
#include "core/nearest.hpp"
#include "scene/sequence_files.hpp"

namespace weft::environment {
namespace {

/// Clips with fewer or more keys a second than this are sampled at these rates [1/s].
constexpr double kLeastRate = 10, kMostRate = 120;

/// Key frames of one character [bytes]; more than that, and somebody has mistyped a rate.
constexpr std::size_t kMaxBytes = std::size_t{8} << 30;

/// Ends of a clip that are further apart do not close to the eye [m].
constexpr double kGap = 1e-3;

/// Makes the mannequin's z the y of the scene.
const Mat3 kZToY = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY()).toRotationMatrix();

/// What there is to be sampled.
struct Body {
  character::Character character;
  std::optional<character::Clip> clip;
  std::vector<std::string> warnings;
  scene::UpAxis up;  ///< of the character, before it is turned to the scene's
  std::string name;  ///< of where the joints are from, for messages

  Vec3 up_axis() const { return up == scene::UpAxis::z ? Vec3::UnitZ() : Vec3::UnitY(); }
};

/// A character of the scene, and how messages name it.
struct Cast {
  const scene::Scene& scene;
  const scene::Character& settings;
  std::string where;

  assets::FileAxes axes() const { return {settings.scale, settings.up, scene.up}; }
  character::Timing timing() const { return {settings.dressing, settings.blend, settings.start, settings.speed}; }

  [[noreturn]] void fail(const std::string& key, const std::string& why) const {
    throw Error(ExitCode::scene_invalid, "{}.{}: {}", where, key, why);
  }
};

Cast make_cast(const scene::Scene& scene, const scene::Character& settings) {
  return {scene, settings,
          fmt::format("{}:{}:{}: character.{}", scene.file.string(), settings.line, settings.column, settings.name)};
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
}

/// The clip that the scene names, or the first.
const character::Clip& choose_clip(const Cast& cast, const std::optional<std::string>& name,
                                   const std::vector<character::Clip>& clips, const std::filesystem::path& file) {
  if (!name) return clips.front();
  std::vector<std::string> names;
  for (const character::Clip& clip : clips) {
    if (clip.name == *name) return clip;
    names.push_back(clip.name);
  }
  if (names.empty())
    cast.fail("clip", fmt::format("expected an animation in {}, got none; leave the key out", file.string()));
  cast.fail("clip", fmt::format("expected one of the {} clips of {}, \"{}\", got \"{}\"{}", names.size(), file.string(),
                                fmt::join(names, "\", \""), *name, did_you_mean(*name, names)));
}

/// The node of a file that a [[character.joint]] names.
Index named_node(const Cast& cast, const std::string& key, const std::string& name,
                 const std::vector<character::Node>& nodes, const std::string& file) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].name == name) return static_cast<Index>(n);
    names.push_back(nodes[n].name);
  }
  cast.fail(key, fmt::format("expected the name of a node of {}, got \"{}\"{}", file, name, did_you_mean(name, names)));
}

/// The clip of another skeleton, on this one.
character::Clip take_over(const Cast& cast, const scene::Acting& source, Body& body) {
  using Member = std::optional<std::string> scene::JointNames::*;
  assets::LoadedCharacter motion =
      assets::load_motion(*source.motion, {{}, scene::FileUp::as_file, body.up}, cast.where);
  body.warnings.insert(body.warnings.end(), motion.warnings.begin(), motion.warnings.end());
  const auto joints_of = [&](const character::Character& character, Member given, const std::string& file) {
    std::vector<Index> joints = character::find_joints(character.nodes);
    for (const scene::JointNames& joint : source.joints) {
      const Index number = character::joint_number(joint.name);
      const std::string key = fmt::format("joint.{}", joint.name);
      if (number < 0)
        cast.fail(key + ".name", fmt::format("expected a joint of the body, got \"{}\"{}", joint.name,
                                             did_you_mean(joint.name, character::joint_names())));
      if (joint.*given)
        joints[static_cast<std::size_t>(number)] = named_node(cast, key, *(joint.*given), character.nodes, file);
    }
    if (joints[static_cast<std::size_t>(character::joint_number("Hips"))] < 0)
      cast.fail("joint", fmt::format("expected a node of {} that is known as the hips, got none; name it in a "
                                     "[[character.joint]] with name = \"Hips\"",
                                     file));
    return joints;
  };
  const std::vector<Index> ours = joints_of(body.character, &scene::JointNames::body, body.name);
  const std::vector<Index> theirs = joints_of(motion.character, &scene::JointNames::motion, source.motion->string());
  std::vector<std::string> still;
  for (std::size_t j = 0; j < ours.size(); ++j)
    if (ours[j] >= 0 && theirs[j] < 0) still.push_back(character::joint_names()[j]);
  if (!still.empty())
    body.warnings.push_back(fmt::format("{}: motion file {}: nothing that moves {}", cast.where,
                                        source.motion->string(), fmt::join(still, ", ")));
  const character::Clip& clip = choose_clip(cast, source.clip, motion.character.clips, *source.motion);
  return character::retarget({body.character, ours}, {motion.character, theirs}, clip, body.up_axis());
}

Body load_body(const Cast& cast, const scene::CharacterFile& source) {
  assets::LoadedCharacter loaded = assets::load_character(source.path, cast.axes(), cast.where);
  Body body{std::move(loaded.character), {}, std::move(loaded.warnings), cast.scene.up, source.path.string()};
  if (source.motion) {
    body.clip = take_over(cast, source, body);
  } else if (source.clip || !body.character.clips.empty()) {
    body.clip = choose_clip(cast, source.clip, body.character.clips, source.path);
  }
  if (body.clip && !source.loop && cast.settings.start > body.clip->duration)
    cast.fail("start", fmt::format("expected a time of clip \"{}\", at most {:g} s, got {:g}", body.clip->name,
                                   body.clip->duration, cast.settings.start));
  return body;
}

Body load_body(const Cast& cast, const scene::Mannequin& source) {
  Body body{character::make_mannequin({source.height, source.girth, source.masculinity, source.edge_length}),
            {},
            {},
            scene::UpAxis::z,
            "the mannequin"};
  if (source.motion) body.clip = take_over(cast, source, body);
  if (source.walk > 0)
    body.clip = character::make_walk(
        body.character,
        {.speed = source.pace, .distance = source.walk, .turn_back = source.turn_back, .arms_out = source.arms_out});
  return body;
}

/// Which key frames a character needs, k / rate for k from first on.
struct KeyTimes {
  double rate = kLeastRate;  // [1/s]
  std::size_t first = 0, count = 1;

  std::size_t bytes(std::size_t vertices, scene::Interpolation interpolation) const {
    const std::size_t stored = interpolation == scene::Interpolation::cubic && count > 1 ? 2 : 1;
    return count * vertices * stored * sizeof(Vec3);
  }
};

/// `clip_rate`: keys a second of what is sampled; 0 if it does not move.
KeyTimes key_times(const Cast& cast, double clip_rate) {
  const scene::Character& settings = cast.settings;
  KeyTimes times;
  const double duration = cast.scene.time.duration;
  if (clip_rate <= 0 || duration <= settings.dressing) return times;
  times.rate = settings.keys_per_second.value_or(std::clamp(clip_rate * settings.speed, kLeastRate, kMostRate));
  times.first = static_cast<std::size_t>(settings.dressing * times.rate);
  // One key past the end, so that the last moment still has its velocity.
  times.count = static_cast<std::size_t>(std::ceil(duration * times.rate)) + 2 - times.first;
  return times;
}

void check_memory(const Cast& cast, const KeyTimes& times, std::size_t vertices) {
  const std::size_t bytes = times.bytes(vertices, cast.settings.interpolation);
  if (bytes > kMaxBytes)
    cast.fail("keys_per_second", fmt::format("expected at most {} bytes of key frames, got {}: {} of {} vertices",
                                             kMaxBytes, bytes, times.count, vertices));
}

/// Samples a body: `vertices_at` writes where its vertices are at a time of the scene.
KeyFrames sample(const Cast& cast, const KeyTimes& times, std::size_t vertices,
                 const std::function<void(double, std::vector<Vec3>&)>& vertices_at) {
  check_memory(cast, times, vertices);
  const scene::Pose& pose = cast.settings.pose;
  std::vector<std::vector<Vec3>> keys(times.count, std::vector<Vec3>(vertices));
  for (std::size_t k = 0; k < times.count; ++k) {
    const double t = static_cast<double>(times.first + k) / times.rate;
    vertices_at(t, keys[k]);
    for (std::size_t v = 0; v < vertices; ++v) {
      Vec3& x = keys[k][v];
      x = pose.position + pose.rotation * x;
      if (!(x.cwiseAbs().maxCoeff() < assets::kMaxCoordinate))
        throw Error(ExitCode::asset_unreadable,
                    "{}: expected coordinates below {:g} m, got ({:g}, {:g}, {:g}) for vertex {} at {:g} s", cast.where,
                    assets::kMaxCoordinate, x.x(), x.y(), x.z(), v, t);
    }
  }
  return {cast.settings.interpolation, static_cast<double>(times.first) / times.rate, 1 / times.rate, std::move(keys),
          times.first > 0};
}

/// The mesh at the start; a fold of triangles is told from the surface by its faces alone.
mesh::Mesh at_start(mesh::Mesh mesh, const KeyFrames& keys) {
  const std::vector<Vec3> zero(mesh.positions.size(), Vec3::Zero());
  Motion motion{zero, zero, zero};
  keys.at(0, motion);
  mesh.positions = std::move(motion.positions);
  return mesh;
}

template <class Source>  // with joints
Actor act(const Cast& cast, const Source& source) {
  Body body = load_body(cast, source);
  const character::Clip still;
  const character::Clip& clip = body.clip ? *body.clip : still;
  const character::Performance performance(
      body.character, clip,
      {cast.timing(), source.loop, source.crossfade, source.stance == scene::Stance::rest && body.clip},
      body.up_axis());
  if (const double gap = performance.gap(); gap > kGap)
    body.warnings.push_back(
        fmt::format("{}: clip \"{}\" does not close: its end and its beginning are {:.3g} m apart; "
                    "a crossfade would join them",
                    cast.where, clip.name, gap));
  KeyFrames keys = sample(cast, key_times(cast, character::key_rate(clip)), body.character.mesh.positions.size(),
                          [&](double t, std::vector<Vec3>& x) {
                            character::skin(body.character, performance.at(t), x);
                            if (body.up != cast.scene.up)
                              for (Vec3& vertex : x) vertex = kZToY * vertex;
                          });
  mesh::Mesh mesh = at_start(std::move(body.character.mesh), keys);
  return {std::move(mesh), std::move(keys), std::move(body.warnings)};
}

Actor act(const Cast& cast, const scene::MeshSequence& source) {
  assets::LoadedSequence loaded = assets::load_sequence(scene::sequence_files(source.files), cast.axes(), cast.where);
  const std::size_t vertices = loaded.mesh.positions.size();
  const std::vector<Vec3> zero(vertices, Vec3::Zero());
  Motion motion{zero, zero, zero};
  const KeyFrames files(cast.settings.interpolation, 0, 1 / source.fps, std::move(loaded.positions), false);
  KeyFrames keys = sample(cast, key_times(cast, source.fps), vertices, [&](double t, std::vector<Vec3>& x) {
    files.at(character::clip_time(cast.timing(), t), motion);
    x = motion.positions;
  });
  mesh::Mesh mesh = at_start(std::move(loaded.mesh), keys);
  return {std::move(mesh), std::move(keys), {}};
}

}  // namespace

Actor make_actor(const scene::Scene& scene, const scene::Character& character) {
  const Cast cast = make_cast(scene, character);
  return std::visit([&](const auto& source) { return act(cast, source); }, character.source);
}

KeyFrameCount count_key_frames(const scene::Scene& scene, const scene::Character& character) {
  const Cast cast = make_cast(scene, character);
  KeyTimes times;
  std::size_t vertices = 0;
  if (const auto* sequence = std::get_if<scene::MeshSequence>(&character.source)) {
    const std::vector<std::filesystem::path> files = scene::sequence_files(sequence->files);
    times = key_times(cast, sequence->fps);
    vertices = assets::load_sequence(std::span(files).first(1), cast.axes(), cast.where).mesh.positions.size();
  } else {
    const auto* file = std::get_if<scene::CharacterFile>(&character.source);
    const Body body =
        file != nullptr ? load_body(cast, *file) : load_body(cast, std::get<scene::Mannequin>(character.source));
    times = key_times(cast, body.clip ? character::key_rate(*body.clip) : 0);
    vertices = body.character.mesh.positions.size();
  }
  return {times.count, vertices, times.bytes(vertices, character.interpolation)};
}

}  // namespace weft::environment
