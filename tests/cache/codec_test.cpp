// Encodes frames to bytes and decodes them; tests bytes that are not a frame.
#include "film/cache/codec.hpp"

#include <gtest/gtest.h>
#include <xxhash.h>
#include <zstd.h>

#include "cache/sample.hpp"
#include "film/cache/container.hpp"

namespace weft::cache {
namespace {

void expect_broken(std::string_view words, const auto& action) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected: " << words;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string_view(error.what()).find(words), std::string_view::npos) << error.what();
  }
}

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

void expect_same_paint(const frame::Appearance& a, const frame::Appearance& b) {
  EXPECT_EQ(a.thickness, b.thickness);
  EXPECT_EQ(a.hem, b.hem);
  EXPECT_EQ(a.back_painted, b.back_painted);
  EXPECT_EQ(a.back_paleness, b.back_paleness);
  ASSERT_EQ(a.paint.texture == nullptr, b.paint.texture == nullptr);
  if (!a.paint.texture) return;
  EXPECT_EQ(a.paint.texture->width, b.paint.texture->width);
  EXPECT_EQ(a.paint.texture->height, b.paint.texture->height);
  EXPECT_EQ(a.paint.texture->rgba, b.paint.texture->rgba);
  EXPECT_EQ(a.paint.texture_from_uv, b.paint.texture_from_uv);
  EXPECT_EQ(a.paint.wrap_u, b.paint.wrap_u);
  EXPECT_EQ(a.paint.wrap_v, b.paint.wrap_v);
  EXPECT_EQ(a.paint.alpha, b.paint.alpha);
}

TEST(Codec, SurfacesComeBackAsTheyWere) {
  const Sample sample;
  const Surfaces read = decode_surfaces(encode_surfaces(surfaces_of(*sample.snapshot(0))));
  EXPECT_EQ(read.stage->up, sample.stage->up);
  EXPECT_EQ(read.stage->sky_color, sample.stage->sky_color);
  EXPECT_EQ(read.stage->ground_color, sample.stage->ground_color);
  EXPECT_EQ(read.stage->sky_intensity, sample.stage->sky_intensity);
  EXPECT_EQ(read.stage->heat, sample.stage->heat);
  EXPECT_EQ(read.stage->heat_max, sample.stage->heat_max);
  ASSERT_EQ(read.surfaces.size(), 2u);
  for (std::size_t s = 0; s < 2; ++s) {
    const frame::Surface &a = *sample.surfaces[s], &b = *read.surfaces[s];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.visible, b.visible);
    EXPECT_EQ(a.infinite_floor, b.infinite_floor);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.quads, b.quads);
    EXPECT_EQ(a.uv, b.uv);
    EXPECT_EQ(a.crease_angle, b.crease_angle);
    const auto corners = [](const std::optional<Box3>& box) {
      return box ? std::vector<Vec3>{box->min(), box->max()} : std::vector<Vec3>{};
    };
    EXPECT_EQ(corners(a.run_bounds), corners(b.run_bounds));
    EXPECT_EQ(a.appearance.color, b.appearance.color);
    EXPECT_EQ(a.appearance.back_color, b.appearance.back_color);
    EXPECT_EQ(a.appearance.roughness, b.appearance.roughness);
    EXPECT_EQ(a.appearance.thread_spacing, b.appearance.thread_spacing);
    EXPECT_EQ(a.appearance.finish.threads, b.appearance.finish.threads);
    EXPECT_EQ(a.appearance.checker, b.appearance.checker);
    expect_same_paint(a.appearance, b.appearance);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t p = 0; p < a.parts.size(); ++p) {
      EXPECT_EQ(a.parts[p].name, b.parts[p].name);
      expect_same_paint(a.parts[p].appearance, b.parts[p].appearance);
    }
    EXPECT_EQ(a.passed_through, b.passed_through);
    EXPECT_EQ(a.part_of_triangle, b.part_of_triangle);
    EXPECT_EQ(a.paint_uv, b.paint_uv);
    EXPECT_EQ(a.closures, b.closures);
    EXPECT_EQ(a.max_closed_gap, b.max_closed_gap);
  }
}

TEST(Codec, FramesComeBackBitForBit) {
  const Sample sample;
  const Surfaces surfaces = surfaces_of(*sample.snapshot(0));
  for (const int k : {0, 1, 2}) {
    const frame::SnapshotPtr a = sample.snapshot(k);
    const CachedFrame cached = decode_frame(encode_frame(*a, sample.report(k), surfaces), k, surfaces);
    const frame::FrameSnapshot& b = *cached.snapshot;
    EXPECT_EQ(b.frame, k);
    EXPECT_EQ(a->time, b.time);
    ASSERT_EQ(b.states.size(), 2u);
    for (std::size_t s = 0; s < 2; ++s) {
      EXPECT_TRUE(same_bits(a->states[s].positions, b.states[s].positions)) << s;
      EXPECT_TRUE(same_bits(a->states[s].heat, b.states[s].heat)) << s;
    }
    ASSERT_EQ(b.cameras.size(), 2u);
    EXPECT_EQ(a->cameras[0].name, b.cameras[0].name);
    EXPECT_EQ(a->cameras[0].position, b.cameras[0].position);
    EXPECT_EQ(a->cameras[0].target, b.cameras[0].target);
    EXPECT_EQ(a->cameras[0].field_of_view, b.cameras[0].field_of_view);
    EXPECT_EQ(a->cameras[0].kind, b.cameras[0].kind);
    EXPECT_EQ(a->cameras[0].subjects, b.cameras[0].subjects);
    EXPECT_EQ(a->cameras[0].azimuth, b.cameras[0].azimuth);
    EXPECT_EQ(a->cameras[0].elevation, b.cameras[0].elevation);
    EXPECT_EQ(a->cameras[0].margin, b.cameras[0].margin);
    EXPECT_EQ(a->cameras[0].smoothing, b.cameras[0].smoothing);
    EXPECT_EQ(a->cameras[0].shot, b.cameras[0].shot);
    ASSERT_EQ(b.lights.size(), 1u);
    EXPECT_EQ(a->lights[0].name, b.lights[0].name);
    EXPECT_EQ(a->lights[0].kind, b.lights[0].kind);
    EXPECT_EQ(a->lights[0].direction, b.lights[0].direction);
    EXPECT_EQ(a->lights[0].position, b.lights[0].position);
    EXPECT_EQ(a->lights[0].target, b.lights[0].target);
    EXPECT_EQ(a->lights[0].cone_angle, b.lights[0].cone_angle);
    EXPECT_EQ(a->lights[0].color, b.lights[0].color);
    EXPECT_EQ(a->lights[0].intensity, b.lights[0].intensity);
    EXPECT_EQ(a->lights[0].softness, b.lights[0].softness);
    const simulation::FrameReport &before = sample.report(k), &after = cached.report;
    EXPECT_EQ(before.frame, after.frame);
    EXPECT_EQ(before.time, after.time);
    for (const auto stage :
         {&simulation::FrameReport::simulate, &simulation::FrameReport::collide, &simulation::FrameReport::forces,
          &simulation::FrameReport::preconditioner, &simulation::FrameReport::linear}) {
      EXPECT_EQ((before.*stage).wall_s, (after.*stage).wall_s);
      EXPECT_EQ((before.*stage).cpu_s, (after.*stage).cpu_s);
    }
    for (const auto number : {&simulation::FrameReport::error_estimate, &simulation::FrameReport::solver_error,
                              &simulation::FrameReport::min_distance, &simulation::FrameReport::max_strain,
                              &simulation::FrameReport::stretch_ratio, &simulation::FrameReport::kinetic_energy,
                              &simulation::FrameReport::potential_energy, &simulation::FrameReport::elastic_energy,
                              &simulation::FrameReport::pin_work, &simulation::FrameReport::solver_work})
      EXPECT_EQ(before.*number, after.*number);
    for (const auto number : {&simulation::FrameReport::steps, &simulation::FrameReport::rejected_steps,
                              &simulation::FrameReport::inexact_steps, &simulation::FrameReport::newton_iterations,
                              &simulation::FrameReport::linear_iterations, &simulation::FrameReport::proximities,
                              &simulation::FrameReport::constraints, &simulation::FrameReport::pinched_pairs,
                              &simulation::FrameReport::lagging_particles})
      EXPECT_EQ(before.*number, after.*number);
    EXPECT_EQ(before.warnings, after.warnings);
  }
}

// The codec stores no positions of a surface if they have the same bits as in Surfaces.
TEST(Codec, WhatHasNotMovedTakesTwoBytes) {
  const Sample sample;
  frame::FrameSnapshot resting = *sample.snapshot(0);
  const Surfaces surfaces = surfaces_of(resting);
  const std::size_t still = encode_frame(resting, {}, surfaces).size();
  resting.states[1].positions[0].x() = -0.0;  // compares equal, but has other bits
  EXPECT_EQ(encode_frame(resting, {}, surfaces).size() - still, 3 * sizeof(Vec3));
  resting.states[0].positions[2].x() = 0.5;
  EXPECT_EQ(encode_frame(resting, {}, surfaces).size() - still, 7 * sizeof(Vec3));
}

TEST(Codec, PositionsAreStoredInPlanesOfEqualBytes) {
  const Sample sample;
  const frame::SnapshotPtr snapshot = sample.snapshot(2);
  const std::string payload = encode_frame(*snapshot, {}, surfaces_of(*sample.snapshot(0)));
  // The payload ends with the byte planes of the cloth's positions, a byte 1, the planes of its heat, and two bytes 0
  // for the floor.
  const std::string_view planes = std::string_view(payload).substr(payload.size() - 2 - 16 - 1 - 96, 96);
  const auto* bytes = reinterpret_cast<const char*>(snapshot->states[0].positions.data());
  for (std::size_t vertex = 0; vertex < 4; ++vertex)
    for (std::size_t byte = 0; byte < 24; ++byte) EXPECT_EQ(planes[byte * 4 + vertex], bytes[vertex * 24 + byte]);
}

TEST(Container, HeaderIsLaidOutAsDocumented) {
  std::string payload = "payload payload payload payload";
  const std::string bytes = pack({Kind::state, -7, kSampleHash}, payload);
  EXPECT_EQ(bytes.substr(0, 8), "\x89WEFT\r\n\x1A");
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 8), kFormatVersion);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 12), 3u);
  EXPECT_EQ(value_at<std::int32_t>(bytes, 16), -7);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 24), kSampleHash);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 32), payload.size());
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 40), bytes.size() - 56);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 48), [&] {
    const std::string checked = bytes.substr(0, 48) + bytes.substr(56);
    return XXH3_64bits(checked.data(), checked.size());
  }());
  std::string unpacked(payload.size(), ' ');
  EXPECT_EQ(ZSTD_decompress(unpacked.data(), unpacked.size(), bytes.data() + 56, bytes.size() - 56), payload.size());
  EXPECT_EQ(unpacked, payload);
  EXPECT_EQ(unpack(bytes).payload, payload);
  EXPECT_EQ(unpack(bytes).label.frame, -7);
  EXPECT_EQ(unpack(pack({}, "")).payload, "");
}

TEST(Container, EveryTruncationAndEveryFlippedBitIsFound) {
  const Sample sample;
  const std::string good = pack({Kind::surfaces, 0, kSampleHash}, encode_surfaces(surfaces_of(*sample.snapshot(0))));
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(unpack(std::string_view(good).substr(0, size)), std::runtime_error) << size;
  EXPECT_THROW(unpack(good + "x"), std::runtime_error);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_THROW(unpack(bad), std::runtime_error) << bit;
    EXPECT_THROW(verify(bad), std::runtime_error) << bit;
  }
}

// Header and checksum are valid, but the size that the header states is wrong.
TEST(Container, PromisedSizeIsNotBelieved) {
  for (const std::uint64_t size : {std::uint64_t{0}, std::uint64_t{4}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    std::string bytes = pack({}, "12345");
    std::memcpy(bytes.data() + 32, &size, 8);
    const std::string checked = bytes.substr(0, 48) + bytes.substr(56);
    const std::uint64_t checksum = XXH3_64bits(checked.data(), checked.size());
    std::memcpy(bytes.data() + 48, &checksum, 8);
    expect_broken("size of its content", [&] { unpack(bytes); });
  }
}

TEST(Codec, SurfacesThatMakeNoSenseAreRefused) {
  const Sample sample;
  const auto refuse = [&](const char* words, const auto& spoil) {
    Surfaces surfaces = surfaces_of(*sample.snapshot(0));
    auto surface = std::make_shared<frame::Surface>(*surfaces.surfaces[0]);
    spoil(*surface, surfaces.positions[0]);
    surfaces.surfaces[0] = surface;
    expect_broken(words, [&] { decode_surfaces(encode_surfaces(surfaces)); });
  };
  using Positions = std::vector<Vec3>;
  refuse("a vertex that is not there", [](frame::Surface& s, Positions&) { s.triangles[1][2] = 4; });
  refuse("a vertex that is not there", [](frame::Surface& s, Positions&) { s.triangles[1][0] = -1; });
  refuse("a vertex that is not there", [](frame::Surface& s, Positions&) { s.quads[0][3] = 4; });
  refuse("a vertex that is not there", [](frame::Surface& s, Positions&) { s.closures[0][1][1] = 4; });
  refuse("one (u, v) per vertex", [](frame::Surface& s, Positions&) { s.uv.pop_back(); });
  refuse("(u, v) is not finite", [](frame::Surface& s, Positions&) { s.uv[0].x() = NAN; });
  refuse("position is not finite", [](frame::Surface&, Positions& p) { p[0].x() = NAN; });
  refuse("not finite", [](frame::Surface& s, Positions&) { s.appearance.roughness = INFINITY; });
  refuse("name of a surface", [](frame::Surface& s, Positions&) { s.name = "../../etc/passwd"; });
  refuse("name of a surface", [](frame::Surface& s, Positions&) { s.name = ""; });
  refuse("a choice has the number 4, where 3 is the largest",
         [](frame::Surface& s, Positions&) { s.kind = static_cast<frame::ObjectKind>(4); });
}

// Bytes of the content are changed, with a valid checksum: only a faulty writer could make such a file. The decoder
// reads or refuses it and never crashes (the sanitizers run on this test).
TEST(Codec, NoBytesCrashTheDecoder) {
  const Sample sample;
  const Surfaces surfaces = surfaces_of(*sample.snapshot(0));
  const std::string first = encode_surfaces(surfaces),
                    second = encode_frame(*sample.snapshot(2), sample.report(2), surfaces);
  std::mt19937 random(6);
  int refused = 0;
  const auto attempt = [&](const auto& decode) {
    try {
      decode();
    } catch (const std::runtime_error&) {
      ++refused;
    }
  };
  for (std::size_t size = 0; size < first.size(); ++size) attempt([&] { decode_surfaces(first.substr(0, size)); });
  for (std::size_t size = 0; size < second.size(); ++size)
    attempt([&] { decode_frame(second.substr(0, size), 2, surfaces); });
  EXPECT_EQ(refused, static_cast<int>(first.size() + second.size())) << "a truncated payload was taken for whole";
  for (int round = 0; round < 50'000; ++round) {
    std::string a = first, b = second;
    for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips) {
      a[random() % a.size()] = static_cast<char>(random());
      b[random() % b.size()] = static_cast<char>(random());
    }
    attempt([&] { decode_surfaces(a); });
    attempt([&] { decode_frame(b, 2, surfaces); });
  }
}

}  // namespace
}  // namespace weft::cache
