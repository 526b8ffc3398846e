// Thousands of damaged scenes. Each loads, or is refused with messages that point to existing places in the file. None
// may crash the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "film/scene/loader.hpp"
#include "scene/folder.hpp"
#include "support/test_folder.hpp"

namespace weft::scene {
namespace {

/// Damages a text in a few places, like typing errors, bad merges and disk errors.
std::string damage_text(std::string text, std::mt19937& random) {
  using namespace std::string_literals;
  static const std::string kBytes = "[]{}=.,\"'#\n\0\xff-+e0159 \t_nan"s;
  const auto below = [&](std::size_t count) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(1, count));
  };
  for (std::size_t times = 1 + below(3); times > 0; --times) {
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(random() & 0xFF);
        break;
      case 1:
        text[at] = kBytes[below(kBytes.size())];
        break;
      case 2:
        text.insert(at, 1, kBytes[below(kBytes.size())]);
        break;
      case 3:
        text.erase(at, 1 + below(20));
        break;
      case 4: {
        // Replaces a digit in a number. The syntax stays valid, so that rules and checks are tested too.
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(10));
        break;
      }
      default:
        text.insert(at, text.substr(below(text.size()), below(60)));
    }
    if (text.empty()) text = "x";
  }
  return text;
}

/// An accepted scene can be built: all its values are within the limits on which memory and arithmetic depend.
void expect_buildable(const Scene& scene) {
  long particles = 0;
  for (const Cloth& cloth : scene.cloths) {
    particles += static_cast<long>(cloth.particles_weft) * cloth.particles_warp;
    EXPECT_GE(std::min(cloth.particles_weft, cloth.particles_warp), 2);
    EXPECT_GT(cloth.size.minCoeff(), 0);
    EXPECT_TRUE(cloth.pose.position.allFinite() && cloth.size.allFinite());
    EXPECT_NEAR(cloth.pose.rotation.norm(), 1, 1e-12);  // normalised in double precision: error of a few 1e-16
    EXPECT_GT(cloth.material.density, 0);
    EXPECT_TRUE(std::isfinite(cloth.material.density));
  }
  EXPECT_LE(particles, 4'000'000);
  EXPECT_LE(scene.frame_count(), 100'001);
  for (const Obstacle& obstacle : scene.obstacles) {
    for (std::size_t k = 1; k < obstacle.motion.keys.size(); ++k) {
      EXPECT_GT(obstacle.motion.keys[k].time, obstacle.motion.keys[k - 1].time);
    }
  }
}

TEST(DamagedScenes, LoadOrAreRefusedAtAPlaceThatExists) {
  const std::string good = support::read_bytes(kFolder + "every_key.toml");
  ASSERT_FALSE(good.empty());
  std::mt19937 random(20010901);  // fixed seed, so that a failure can be reproduced
  int loaded = 0, misread = 0;
  constexpr int kScenes = 4000;
  for (int i = 0; i < kScenes; ++i) {
    const std::string text = damage_text(good, random);
    const LoadResult result = load_text(text, kFolder + "damaged.toml");
    const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
    for (const Mistake& mistake : result.mistakes) {
      EXPECT_FALSE(mistake.text.empty());
      EXPECT_GE(mistake.line, 0);
      EXPECT_LE(mistake.line, lines);
      EXPECT_EQ(mistake.line > 0, mistake.column > 0);
      if (!mistake.key.empty()) {
        EXPECT_GT(mistake.line, 0) << mistake.key << ": " << mistake.text;
      }
    }
    EXPECT_TRUE(std::is_sorted(result.mistakes.begin(), result.mistakes.end(), [](const Mistake& a, const Mistake& b) {
      return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    }));
    if (result.ok()) {
      ++loaded;
      expect_buildable(result.scene);
      const LoadResult again = load_text(effective_scene(result.scene), kFolder + "again.toml");
      EXPECT_EQ(again.describe(), "") << text;
      EXPECT_EQ(again.scene.hash, result.scene.hash) << text;
    } else if (!result.mistakes.front().key.empty()) {
      ++misread;
    }
    if (testing::Test::HasFailure()) break;
  }
  // The amount of damage is suitable: some scenes still load, and in others the rules find mistakes.
  EXPECT_GT(loaded, kScenes / 20);
  EXPECT_GT(misread, kScenes / 20);
}

TEST(DamagedScenes, WithDamagedOverridesDoNotCrash) {
  const std::string good = support::read_bytes(kFolder + "every_key.toml");
  std::mt19937 random(20010902);
  for (int i = 0; i < 1000; ++i) {
    const std::string text = damage_text("cloth.sheet.material.stretch=[1e3, 2.5]", random);
    const LoadResult result = load_text(good, kFolder + "s.toml", {text});
    if (result.ok()) expect_buildable(result.scene);
    for (const Mistake& mistake : result.mistakes) EXPECT_FALSE(mistake.text.empty());
  }
}

TEST(DamagedScenes, CutOffAnywhereDoNotCrash) {
  const std::string good = support::read_bytes(kFolder + "every_key.toml");
  for (std::size_t size = 0; size < good.size(); size += 3) {
    const LoadResult result = load_text(std::string_view(good).substr(0, size), kFolder + "s.toml");
    EXPECT_EQ(result.ok(), result.describe().empty());
  }
}

}  // namespace
}  // namespace weft::scene
