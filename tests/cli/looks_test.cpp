// Keys that the rules mark as not simulated. The simulation must not depend on them in any bit, and a cached frame with
// new looks must equal the frame of the changed scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "film/cache/codec.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/scene/loader.hpp"
#include "film/scene/rule.hpp"

namespace weft::cli {
namespace {

constexpr const char* kSceneWithLooks = R"(
title = "before"
time = { duration = 0.2, fps = 10, step = 0.05 }
render = { heat = "strain", camera = "v" }
[[cloth]]
name = "c"
size = [0.3, 0.3]
particles = [5, 5]
position = [0, 0, 0.12]
[[obstacle]]
name = "o"
shape = "sphere"
radius = 0.1
segments = 8
[[camera]]
name = "v"
target = [0, 0, 0]
keys = [{ time = 0, position = [1, 2, 3] }, { time = 1, position = [3, 2, 1] }]
[[camera]]
name = "w"
position = [1, 1, 1]
target = [0, 0, 0]
[[light]]
name = "l"
)";

/// Calls `visit` for each key below `table` that has a value: with its path, its rule, and whether it is simulated.
void each_change(const scene::Table& table, const std::string& path, bool simulated,
                 const std::function<void(const std::string&, const scene::Rule&, bool)>& visit) {
  const auto visit_rules = [&](const std::vector<scene::Rule>& rules) {
    for (const scene::Rule& rule : rules) {
      const bool counts = simulated && rule.simulated;
      if (rule.type == scene::Type::table)
        each_change(*rule.table, path + rule.key + ".", counts, visit);
      else if (rule.get && rule.type != scene::Type::name)
        visit(path + rule.key, rule, counts);
    }
  };
  visit_rules(table.rules);
  const auto start = table.make();
  if (const scene::Variant* variant = table.variant_of(start.get())) visit_rules(variant->rules);
}

/// A value different from that in kSceneWithLooks.
std::string other_value(const std::string& path, const scene::Rule& rule) {
  if (path == "render.camera") return "w";
  if (path == "time.duration") return "0.4";
  if (path.ends_with("interpolation")) return "linear";
  switch (rule.type) {
    case scene::Type::boolean:
      for (const char* on : {"visible", "image_repeat", "follow_rotation"})
        if (path.ends_with(on)) return "false";
      return "true";
    case scene::Type::file:
      return WEFT_SOURCE_DIR "/scenes/gallery/pictures/check.png";
    case scene::Type::choice:
      return rule.choices.back();
    case scene::Type::color:
      return "[0.3, 0.2, 0.1]";
    case scene::Type::number:
      break;
    default:
      return "other";
  }
  const auto number = [&](std::size_t i) {
    if (rule.whole) return fmt::format("{}", std::max(rule.range.low, 0.0) + 37);
    const double low = std::max(rule.range.low, 0.0), width = std::min(rule.range.high - low, 10.0);
    return fmt::format("{}", low + width * 0.037 * static_cast<double>(i + 1));
  };
  if (rule.components.empty()) return number(0);
  std::string text;
  for (std::size_t i = 0; i < rule.components.size(); ++i) text += (i > 0 ? ", " : "[") + number(i);
  return text + "]";
}

scene::Scene scene_with(const std::vector<std::string>& overrides) {
  scene::LoadResult loaded = scene::load_text(kSceneWithLooks, "s.toml", overrides);
  EXPECT_TRUE(loaded.ok()) << loaded.describe();
  return std::move(loaded.scene);
}

frame::SnapshotPtr third_frame(const scene::Scene& scene) {
  production::SceneSimulation simulation(scene);
  simulation.advance();
  simulation.advance();
  return simulation.snapshot();
}

/// Bytes of everything that is drawn of a frame.
std::string bytes_of(const frame::FrameSnapshot& snapshot) {
  const cache::Surfaces surfaces = cache::surfaces_of(snapshot);
  return cache::encode_surfaces(surfaces) + cache::encode_frame(snapshot, {}, surfaces);
}

void expect_not_simulated(const std::string& change, const scene::Scene& before, const frame::FrameSnapshot& kept) {
  // Some keys require another key.
  std::vector<std::string> changes{change};
  if (change.find("sensor_width") != std::string::npos) changes.emplace_back("camera.w.focal_length=40");
  if (change.find("follow_rotation") != std::string::npos) changes.emplace_back("camera.w.follow=o");
  const scene::Scene after = scene_with(changes);
  EXPECT_NE(after.hash, before.hash) << change;
  EXPECT_EQ(after.simulation_hash, before.simulation_hash) << change;
  EXPECT_TRUE(bytes_of(*third_frame(after)) == bytes_of(*production::SceneSimulation(after).with_looks(kept)))
      << change;
}

// The looks of a character also determine how its surface is divided. In a longer run, the ball moves farther.
TEST(Looks, OfACharacterAndOfALongerRunAreThoseOfAnUninterruptedRun) {
  const auto scene_with_model = [](const std::vector<std::string>& overrides) {
    scene::LoadResult loaded = scene::load_text(
        "[time]\nduration = 0.2\nfps = 10\n[[character]]\nname = \"model\"\nsource = \"mannequin\"\nedge_length = 0.1\n"
        "[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.1\nposition = [2, 0, 1]\n"
        "keys = [{ time = 0, position = [2, 0, 1] }, { time = 1, position = [7, 0, 1] }]\n",
        "s.toml", overrides);
    EXPECT_TRUE(loaded.ok()) << loaded.describe();
    return std::move(loaded.scene);
  };
  const frame::SnapshotPtr kept = third_frame(scene_with_model({}));
  for (const char* change :
       {"character.model.look.color=[1, 0, 0]", "character.model.look.roughness=0.2", "time.duration=0.9"}) {
    const scene::Scene after = scene_with_model({change});
    EXPECT_TRUE(bytes_of(*third_frame(after)) == bytes_of(*production::SceneSimulation(after).with_looks(*kept)))
        << change;
  }
}

TEST(Looks, AreAllThatTheRulesCallNotSimulatedAndNothingElse) {
  const scene::Scene before = scene_with({});
  const frame::SnapshotPtr kept = third_frame(before);
  int looks = 0, others = 0;
  const auto visit = [&](const std::string& path, const scene::Rule& rule, bool simulated) {
    if (path.ends_with("follow") || path.ends_with(".shape") || path.ends_with("kind")) return;
    const std::string change = path + "=" + other_value(path, rule);
    if (!simulated) {
      ++looks;
      return expect_not_simulated(change, before, *kept);
    }
    const scene::LoadResult after = scene::load_text(kSceneWithLooks, "s.toml", {change});
    if (!after.ok() || after.scene.hash == before.hash) return;  // the tests of the scene rules cover these
    ++others;
    EXPECT_NE(after.scene.simulation_hash, before.simulation_hash) << change;
  };
  const scene::Table& root = scene::scene_rules();
  each_change(root, "", true, visit);
  const auto entries = [&](const char* list, const char* name) {
    const scene::Rule& rule = *root.find(list);
    each_change(*rule.table, fmt::format("{}.{}.", list, name), rule.simulated, visit);
  };
  entries("cloth", "c");
  entries("obstacle", "o");
  entries("camera", "w");
  entries("light", "l");
  EXPECT_GE(looks, 25);
  EXPECT_GE(others, 40);
}

TEST(Looks, LengthOfTheFilmCountsWithACharacter) {
  const std::string who = "character=[{name='m',source='mannequin'}]";
  EXPECT_NE(scene_with({who}).simulation_hash, scene_with({who, "time.duration=0.4"}).simulation_hash);
}

}  // namespace
}  // namespace weft::cli
