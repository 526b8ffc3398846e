#include "film/cache/codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/archive.hpp"
#include "core/names.hpp"

namespace weft::cache {
namespace {

// Serialises an enumeration or boolean as one byte. Throws std::runtime_error if the byte exceeds `last`, the largest
// value of the type.
template <class Archive, class Value>
void serialize_byte(Archive& archive, Value& value, Value last) {
  auto byte = static_cast<std::uint8_t>(value);
  archive.value(byte);
  if (byte > static_cast<std::uint8_t>(last))
    throw std::runtime_error(
        fmt::format("a choice has the number {}, where {} is the largest; simulate the scene again", byte,
                    static_cast<std::uint8_t>(last)));
  value = static_cast<Value>(byte);
}

template <class Archive>
void serialize_flag(Archive& archive, bool& flag) {
  serialize_byte(archive, flag, true);
}

// Maximum magnitude of a coordinate [m]. Pictures are drawn in single precision, in which products of four coordinates
// must be finite. For comparison: an object that falls for an hour is 6.4e7 m away.
constexpr double kFarthest = 1e9;

// Throws if a number is not finite or its magnitude exceeds kFarthest. Reading checks all floating-point numbers this
// way, also angles, fractions and intensities, with two exceptions: (u, v) and heat need only be finite, and the
// numbers of the report are not checked.
void check_finite(double number) {
  if (!(std::abs(number) <= kFarthest))
    throw std::runtime_error(fmt::format("a number is not finite, or beyond {:g}", kFarthest));
}

template <class Archive>
void serialize_finite(Archive& archive, double& number) {
  archive.value(number);
  if constexpr (Archive::kReads) check_finite(number);
}

template <class Archive>
void serialize_finite(Archive& archive, Vec3& vector) {
  for (double& number : vector) serialize_finite(archive, number);
}

template <class Archive>
void serialize_finite(Archive& archive, Box3& box) {
  serialize_finite(archive, box.min());
  serialize_finite(archive, box.max());
}

template <class Archive, class Value>
void serialize_optional(Archive& archive, std::optional<Value>& value) {
  bool given = value.has_value();
  serialize_flag(archive, given);
  if (!given) return value.reset();
  if (!value) value.emplace();
  serialize_finite(archive, *value);
}

// Serialises the entries of a list as byte planes (codec.hpp), without their number. For reading, the list must already
// have its final size.
template <class Entry>
void serialize_planes(ByteWriter& archive, std::vector<Entry>& list) {
  const std::size_t count = list.size(), start = archive.bytes.size();
  archive.bytes.resize(start + count * sizeof(Entry));
  char* to = archive.bytes.data() + start;
  const char* from = reinterpret_cast<const char*>(list.data());
  for (std::size_t plane = 0; plane < sizeof(Entry); ++plane)
    for (std::size_t i = 0; i < count; ++i) *to++ = from[i * sizeof(Entry) + plane];
}

template <class Entry>
void serialize_planes(ByteReader& archive, std::vector<Entry>& list) {
  const std::size_t count = list.size();
  if (archive.bytes.size() / sizeof(Entry) < count) throw std::runtime_error("the data was cut short");
  const char* from = archive.bytes.data();
  char* to = reinterpret_cast<char*>(list.data());
  for (std::size_t plane = 0; plane < sizeof(Entry); ++plane)
    for (std::size_t i = 0; i < count; ++i) to[i * sizeof(Entry) + plane] = *from++;
  archive.bytes.remove_prefix(count * sizeof(Entry));
}

void check_finite(const std::vector<Vec3>& positions) {
  for (const Vec3& position : positions)
    if (!(position.cwiseAbs().maxCoeff() <= kFarthest))
      throw std::runtime_error(fmt::format("a position is not finite, or beyond {:g} m", kFarthest));
}

void check_end(const ByteReader& reader) {
  if (!reader.bytes.empty()) throw std::runtime_error("there is something behind the last value");
}

template <class Archive>
void serialize(Archive& archive, frame::Stage& stage) {
  serialize_finite(archive, stage.up);
  serialize_byte(archive, stage.look, frame::Stage::Look::strain);
  serialize_optional(archive, stage.sky_color);
  serialize_optional(archive, stage.ground_color);
  serialize_optional(archive, stage.sky_intensity);
  serialize_finite(archive, stage.exposure);
  serialize_finite(archive, stage.motion_blur);
  serialize_byte(archive, stage.heat, frame::Stage::Heat::speed);
  serialize_finite(archive, stage.heat_max);
}

/// The textures of all surfaces, each once; paints refer to them by index.
using Textures = std::vector<std::shared_ptr<const frame::Texture>>;

Textures textures_of(const Surfaces& surfaces) {
  Textures list;
  const auto add = [&](const frame::Appearance& look) {
    if (look.paint.texture && std::ranges::find(list, look.paint.texture) == list.end())
      list.push_back(look.paint.texture);
  };
  for (const auto& surface : surfaces.surfaces) {
    add(surface->appearance);
    for (const frame::SurfacePart& part : surface->parts) add(part.appearance);
  }
  return list;
}

template <class Archive>
void serialize(Archive& archive, Textures& textures) {
  constexpr std::size_t kMinTextureBytes = 16;  // size of the smallest stored texture [bytes]
  serialize_each(
      archive, textures,
      [&](std::shared_ptr<const frame::Texture>& pointer) {
        frame::Texture texture = pointer ? *pointer : frame::Texture{};
        serialize_values(archive, texture.width, texture.height);
        serialize_plain(archive, texture.rgba);
        constexpr int kMaxTextureSide = 1 << 15;  // exclusive limit [pixels]
        const bool sized = texture.width > 0 && texture.height > 0 && texture.width < kMaxTextureSide &&
                           texture.height < kMaxTextureSide;
        if (!sized || texture.rgba.size() != 4 * static_cast<std::size_t>(texture.width) * texture.height)
          throw std::runtime_error("a picture has the wrong number of bytes");
        // Only reading sets the pointer. Writing must keep it, because paints find their textures by this pointer.
        if constexpr (Archive::kReads) pointer = std::make_shared<const frame::Texture>(std::move(texture));
      },
      kMinTextureBytes);
}

template <class Archive>
void serialize(Archive& archive, frame::Paint& paint, const Textures& textures) {
  std::int32_t number = -1;
  if constexpr (!Archive::kReads) {
    const auto found = std::ranges::find(textures, paint.texture);
    if (found != textures.end()) number = static_cast<std::int32_t>(found - textures.begin());
  }
  archive.value(number);
  if (number < -1 || number >= static_cast<std::int32_t>(textures.size()))
    throw std::runtime_error("a picture is not there");
  if (number >= 0) paint.texture = textures[static_cast<std::size_t>(number)];
  for (double& entry : paint.texture_from_uv.reshaped()) serialize_finite(archive, entry);
  serialize_byte(archive, paint.wrap_u, frame::Paint::Wrap::once);
  serialize_byte(archive, paint.wrap_v, frame::Paint::Wrap::once);
  serialize_byte(archive, paint.alpha, frame::Paint::Alpha::cutout);
}

template <class Archive>
void serialize(Archive& archive, frame::Appearance& look, const Textures& textures) {
  serialize_finite(archive, look.color);
  serialize_finite(archive, look.back_color);
  serialize_finite(archive, look.roughness);
  serialize_finite(archive, look.thread_spacing);
  for (double* number : {&look.finish.gloss, &look.finish.warp_fraction, &look.finish.fuzz, &look.finish.sheer})
    serialize_finite(archive, *number);
  serialize_byte(archive, look.finish.threads, Threads::none);
  serialize_finite(archive, look.metal);
  serialize_finite(archive, look.coat);
  serialize_finite(archive, look.thickness);
  serialize_finite(archive, look.hem);
  serialize_flag(archive, look.checker);
  serialize(archive, look.paint, textures);
  serialize_flag(archive, look.back_painted);
  serialize_finite(archive, look.back_paleness);
}

template <class Archive>
void serialize(Archive& archive, frame::Surface& surface, const Textures& textures) {
  constexpr std::size_t kMinPartBytes = 100;  // lower bound of the size of a stored part [bytes]
  serialize_plain(archive, surface.name);
  serialize_byte(archive, surface.kind, frame::ObjectKind::rope);
  serialize_flag(archive, surface.visible);
  serialize_flag(archive, surface.infinite_floor);
  serialize_plain(archive, surface.triangles);
  serialize_plain(archive, surface.quads);
  serialize_plain(archive, surface.uv);
  serialize_finite(archive, surface.crease_angle);
  serialize_optional(archive, surface.run_bounds);
  serialize(archive, surface.appearance, textures);
  serialize_each(
      archive, surface.parts,
      [&](frame::SurfacePart& part) {
        serialize_plain(archive, part.name);
        serialize(archive, part.appearance, textures);
      },
      kMinPartBytes);
  serialize_plain(archive, surface.passed_through);
  serialize_plain(archive, surface.part_of_triangle);
  serialize_plain(archive, surface.paint_uv);
  serialize_each(
      archive, surface.closures, [&](auto& pairs) { serialize_plain(archive, pairs); }, sizeof(std::size_t));
  serialize_finite(archive, surface.max_closed_gap);
}

template <class Archive>
void serialize(Archive& archive, frame::Camera& camera) {
  serialize_plain(archive, camera.name);
  serialize_finite(archive, camera.position);
  serialize_finite(archive, camera.target);
  serialize_finite(archive, camera.field_of_view);
  serialize_byte(archive, camera.kind, frame::Camera::Kind::track);
  serialize_each(
      archive, camera.subjects, [&](std::string& name) { serialize_plain(archive, name); }, sizeof(std::size_t));
  for (double* number :
       {&camera.azimuth, &camera.elevation, &camera.margin, &camera.smoothing, &camera.aperture, &camera.focus})
    serialize_finite(archive, *number);
  archive.value(camera.shot);
}

template <class Archive>
void serialize(Archive& archive, frame::Light& light) {
  serialize_plain(archive, light.name);
  serialize_byte(archive, light.kind, frame::Light::Kind::spot);
  serialize_finite(archive, light.direction);
  serialize_finite(archive, light.position);
  serialize_finite(archive, light.target);
  serialize_finite(archive, light.cone_angle);
  serialize_finite(archive, light.color);
  serialize_finite(archive, light.intensity);
  serialize_finite(archive, light.softness);
}

// The frame and time of the report are not stored here: Label has the frame, FrameHead the time. All members are named,
// so that a new member of FrameReport causes a compile error; serialise it and raise kFormatVersion.
template <class Archive>
void serialize(Archive& archive, simulation::FrameReport& report) {
  auto& [frame, time, simulate, collide, forces, preconditioner, linear, steps, rejected_steps, inexact_steps,
         error_estimate, solver_error, newton_iterations, linear_iterations, proximities, constraints, min_distance,
         max_strain, stretch_ratio, kinetic_energy, potential_energy, elastic_energy, air_energy, pin_work, solver_work,
         pinched_pairs, lagging_particles, enclosed, attachments, warnings] = report;
  for (StageTime* stage : {&simulate, &collide, &forces, &preconditioner, &linear})
    serialize_values(archive, stage->wall_s, stage->cpu_s);
  serialize_values(archive, error_estimate, solver_error, min_distance, max_strain, stretch_ratio, kinetic_energy,
                   potential_energy, elastic_energy, air_energy, pin_work, solver_work, steps, rejected_steps,
                   inexact_steps, newton_iterations, linear_iterations, proximities, constraints, pinched_pairs,
                   lagging_particles);
  serialize_each(
      archive, enclosed,
      [&](simulation::EnclosedAir& air) {
        serialize_plain(archive, air.cloth);
        serialize_values(archive, air.volume, air.pressure);
      },
      3 * sizeof(double));
  serialize_each(
      archive, attachments,
      [&](simulation::AttachmentLoad& attachment) {
        serialize_plain(archive, attachment.name);
        serialize_values(archive, attachment.load, attachment.holds);
      },
      2 * sizeof(double));
  serialize_each(
      archive, warnings, [&](std::string& text) { serialize_plain(archive, text); }, sizeof(std::size_t));
}

// Data of a frame without the positions of its surfaces.
struct FrameHead {
  double time = 0;
  std::vector<frame::Camera> cameras;
  std::vector<frame::Light> lights;
  simulation::FrameReport report;
};

template <class Archive>
void serialize(Archive& archive, FrameHead& head) {
  constexpr std::size_t kMinCameraBytes = 125, kMinLightBytes = 129;  // sizes with empty texts and lists [bytes]
  serialize_finite(archive, head.time);
  serialize_each(
      archive, head.cameras, [&](frame::Camera& camera) { serialize(archive, camera); }, kMinCameraBytes);
  serialize_each(
      archive, head.lights, [&](frame::Light& light) { serialize(archive, light); }, kMinLightBytes);
  serialize(archive, head.report);
}

void check(const frame::Surface& surface, std::size_t vertices) {
  const auto broken = [&](const char* what) {
    throw std::runtime_error(fmt::format("surface '{}': {}", surface.name, what));
  };
  if (!is_plain_name(surface.name)) throw std::runtime_error("the name of a surface is none");
  if (!surface.uv.empty() && surface.uv.size() != vertices) broken("there is not one (u, v) per vertex");
  for (const Vec2& uv : surface.uv)
    if (!uv.allFinite()) broken("a (u, v) is not finite");
  const auto inside = [&](const auto& faces) {
    for (const auto& face : faces)
      for (const Index vertex : face)
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices) broken("a face has a vertex that is not there");
  };
  if (!surface.passed_through.empty() && surface.passed_through.size() != surface.triangles.size())
    broken("there is not one flag per triangle");
  if (!surface.part_of_triangle.empty() && surface.part_of_triangle.size() != surface.triangles.size())
    broken("there is not one part per triangle");
  for (const std::int32_t part : surface.part_of_triangle)
    if (part < 0 || static_cast<std::size_t>(part) >= surface.parts.size()) broken("a part is not there");
  if (!surface.paint_uv.empty() && surface.paint_uv.size() != surface.triangles.size())
    broken("there is not one place of paint per triangle");
  for (const auto& corners : surface.paint_uv)
    for (const Vec2& uv : corners)
      if (!uv.allFinite()) broken("a place of paint is not finite");
  inside(surface.triangles);
  inside(surface.quads);
  for (const auto& pairs : surface.closures) inside(pairs);
}

}  // namespace

Surfaces surfaces_of(const frame::FrameSnapshot& first) {
  Surfaces surfaces{first.stage, first.surfaces, {}};
  for (const frame::SurfaceState& state : first.states) surfaces.positions.push_back(state.positions);
  return surfaces;
}

std::string encode_surfaces(const Surfaces& surfaces) {
  ByteWriter writer;
  frame::Stage stage = *surfaces.stage;
  serialize(writer, stage);
  Textures textures = textures_of(surfaces);
  serialize(writer, textures);
  writer.size(surfaces.surfaces);
  for (const auto& pointer : surfaces.surfaces) {
    frame::Surface surface = *pointer;
    serialize(writer, surface, textures);
  }
  for (std::vector<Vec3> positions : surfaces.positions) {
    writer.size(positions);
    serialize_planes(writer, positions);
  }
  return std::move(writer.bytes);
}

Surfaces decode_surfaces(std::string_view payload) {
  constexpr std::size_t kMinSurfaceBytes = 200;  // lower bound of the size with empty texts and lists [bytes]
  ByteReader reader{payload};
  frame::Stage stage;
  serialize(reader, stage);
  Textures textures;
  serialize(reader, textures);
  std::vector<frame::Surface> list;
  serialize_each(
      reader, list, [&](frame::Surface& surface) { serialize(reader, surface, textures); }, kMinSurfaceBytes);
  Surfaces surfaces{std::make_shared<const frame::Stage>(stage), {}, {}};
  for (frame::Surface& surface : list) {
    std::vector<Vec3>& positions = surfaces.positions.emplace_back();
    reader.size(positions, sizeof(Vec3));
    serialize_planes(reader, positions);
    check_finite(positions);
    check(surface, positions.size());
    surfaces.surfaces.push_back(std::make_shared<const frame::Surface>(std::move(surface)));
  }
  check_end(reader);
  return surfaces;
}

std::string encode_frame(const frame::FrameSnapshot& snapshot, const simulation::FrameReport& report,
                         const Surfaces& surfaces) {
  ByteWriter writer;
  FrameHead head{snapshot.time, snapshot.cameras, snapshot.lights, report};
  serialize(writer, head);
  for (std::size_t s = 0; s < snapshot.states.size(); ++s) {
    frame::SurfaceState state = snapshot.states[s];
    const std::vector<Vec3>& start = surfaces.positions.at(s);
    if (state.positions.size() != start.size()) throw std::logic_error("a surface has lost or gained vertices");
    // Compares bits: −0 and 0 would be equal as numbers.
    bool moved = std::memcmp(state.positions.data(), start.data(), start.size() * sizeof(Vec3)) != 0;
    serialize_flag(writer, moved);
    if (moved) serialize_planes(writer, state.positions);
    bool heated = !state.heat.empty();
    serialize_flag(writer, heated);
    if (heated) serialize_planes(writer, state.heat);
  }
  return std::move(writer.bytes);
}

CachedFrame decode_frame(std::string_view payload, int frame, const Surfaces& surfaces) {
  ByteReader reader{payload};
  FrameHead head;
  serialize(reader, head);
  head.report.frame = frame;
  head.report.time = head.time;
  auto snapshot = std::make_shared<frame::FrameSnapshot>();
  snapshot->frame = frame;
  snapshot->time = head.time;
  snapshot->stage = surfaces.stage;
  snapshot->surfaces = surfaces.surfaces;
  snapshot->cameras = std::move(head.cameras);
  snapshot->lights = std::move(head.lights);
  for (const std::vector<Vec3>& start : surfaces.positions) {
    frame::SurfaceState& state = snapshot->states.emplace_back();
    bool moved = false, heated = false;
    serialize_flag(reader, moved);
    state.positions = start;
    if (moved) {
      serialize_planes(reader, state.positions);
      check_finite(state.positions);
    }
    serialize_flag(reader, heated);
    if (!heated) continue;
    state.heat.resize(start.size());
    serialize_planes(reader, state.heat);
    for (const float heat : state.heat)
      if (!std::isfinite(heat)) throw std::runtime_error("heat is not finite");
  }
  check_end(reader);
  return {std::move(snapshot), std::move(head.report), 0};
}

}  // namespace weft::cache
