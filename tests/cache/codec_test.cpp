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

/// Expects that two structs have equal values of these members.
template <class Struct, class... Members>
void expect_same(const Struct& a, const Struct& b, Members... members) {
  int number = 0;
  const auto compare = [&](const auto& member) {
    ++number;
    EXPECT_EQ(a.*member, b.*member) << "member " << number;
  };
  (compare(members), ...);
}

void expect_same_paint(const frame::Appearance& a, const frame::Appearance& b) {
  using frame::Appearance, frame::Texture, frame::Paint;
  expect_same(a, b, &Appearance::thickness, &Appearance::hem, &Appearance::back_painted, &Appearance::back_paleness);
  ASSERT_EQ(a.paint.texture == nullptr, b.paint.texture == nullptr);
  if (!a.paint.texture) return;
  expect_same(*a.paint.texture, *b.paint.texture, &Texture::width, &Texture::height, &Texture::rgba);
  expect_same(a.paint, b.paint, &Paint::texture_from_uv, &Paint::wrap_u, &Paint::wrap_v, &Paint::alpha);
}

TEST(Codec, SurfacesComeBackAsTheyWere) {
  using frame::Stage, frame::Surface, frame::Appearance;
  const Sample sample;
  const Surfaces read = decode_surfaces(encode_surfaces(surfaces_of(*sample.snapshot(0))));
  expect_same(*read.stage, *sample.stage, &Stage::up, &Stage::sky_color, &Stage::ground_color, &Stage::sky_intensity,
              &Stage::heat, &Stage::heat_max);
  ASSERT_EQ(read.surfaces.size(), 2u);
  for (std::size_t s = 0; s < 2; ++s) {
    const Surface &a = *sample.surfaces[s], &b = *read.surfaces[s];
    expect_same(a, b, &Surface::name, &Surface::kind, &Surface::visible, &Surface::infinite_floor, &Surface::triangles,
                &Surface::quads, &Surface::uv, &Surface::crease_angle, &Surface::passed_through,
                &Surface::part_of_triangle, &Surface::paint_uv, &Surface::closures, &Surface::max_closed_gap);
    const auto corners = [](const std::optional<Box3>& box) {
      return box ? std::vector<Vec3>{box->min(), box->max()} : std::vector<Vec3>{};
    };
    EXPECT_EQ(corners(a.run_bounds), corners(b.run_bounds));
    expect_same(a.appearance, b.appearance, &Appearance::color, &Appearance::back_color, &Appearance::roughness,
                &Appearance::thread_spacing, &Appearance::checker);
    EXPECT_EQ(a.appearance.finish.threads, b.appearance.finish.threads);
    expect_same_paint(a.appearance, b.appearance);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t p = 0; p < a.parts.size(); ++p) {
      EXPECT_EQ(a.parts[p].name, b.parts[p].name);
      expect_same_paint(a.parts[p].appearance, b.parts[p].appearance);
    }
  }
}

TEST(Codec, FramesComeBackBitForBit) {
  using frame::Camera, frame::Light, simulation::FrameReport;
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
    expect_same(a->cameras[0], b.cameras[0], &Camera::name, &Camera::position, &Camera::target, &Camera::field_of_view,
                &Camera::kind, &Camera::subjects, &Camera::azimuth, &Camera::elevation, &Camera::margin,
                &Camera::smoothing, &Camera::shot);
    ASSERT_EQ(b.lights.size(), 1u);
    expect_same(a->lights[0], b.lights[0], &Light::name, &Light::kind, &Light::direction, &Light::position,
                &Light::target, &Light::cone_angle, &Light::color, &Light::intensity, &Light::softness);
    const FrameReport &before = sample.report(k), &after = cached.report;
    for (const auto stage : {&FrameReport::simulate, &FrameReport::collide, &FrameReport::forces,
                             &FrameReport::preconditioner, &FrameReport::linear})
      expect_same(before.*stage, after.*stage, &StageTime::wall_s, &StageTime::cpu_s);
    expect_same(before, after, &FrameReport::frame, &FrameReport::time, &FrameReport::error_estimate,
                &FrameReport::solver_error, &FrameReport::min_distance, &FrameReport::max_strain,
                &FrameReport::stretch_ratio, &FrameReport::kinetic_energy, &FrameReport::potential_energy,
                &FrameReport::elastic_energy, &FrameReport::pin_work, &FrameReport::solver_work, &FrameReport::steps,
                &FrameReport::rejected_steps, &FrameReport::inexact_steps, &FrameReport::newton_iterations,
                &FrameReport::linear_iterations, &FrameReport::proximities, &FrameReport::constraints,
                &FrameReport::pinched_pairs, &FrameReport::lagging_particles, &FrameReport::warnings);
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
