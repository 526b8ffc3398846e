#include "physics/motion/key_frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/parallel.hpp"
#include "physics/motion/spline.hpp"

namespace weft::motion {
namespace {

constexpr double kFirst = 0.7, kInterval = 0.04;  // [s]

/// Random key positions of some vertices [m].
std::vector<std::vector<Vec3>> random_keys(std::size_t count, std::size_t vertices) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<std::vector<Vec3>> keys(count);
  for (auto& key : keys)
    for (std::size_t v = 0; v < vertices; ++v) key.emplace_back(number(random), number(random), number(random));
  return keys;
}

struct Motion {
  std::vector<Vec3> positions, velocities, accelerations;
};

Motion at(const KeyFrames& keys, std::size_t vertices, double t) {
  Motion motion{std::vector<Vec3>(vertices), {}, {}};
  keys.at(t, motion.positions);
  for (std::size_t v = 0; v < vertices; ++v) {
    const VertexMotion vertex = keys.at(t, v);
    EXPECT_EQ(vertex.position, motion.positions[v]);
    motion.velocities.push_back(vertex.velocity);
    motion.accelerations.push_back(vertex.acceleration);
  }
  return motion;
}

/// The natural cubic spline. Spline differs from it where the natural spline leaves the range of the neighbouring keys.
Spline<3>::Sample natural_at(const std::vector<double>& times, const std::vector<Vec3>& values, double t) {
  std::vector<double> lengths;
  std::vector<Vec3> chords;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    lengths.push_back(times[i + 1] - times[i]);
    chords.push_back((values[i + 1] - values[i]) / lengths[i]);
  }
  const std::vector<Vec3> m = natural_second_derivatives<Vec3>(lengths, chords);
  if (t < times.front() || t >= times.back()) return {t < times.front() ? values.front() : values.back()};
  const std::size_t i = find_segment(times, t);
  const double s = t - times[i];
  const Vec3 slope = chords[i] - lengths[i] / 6 * (2 * m[i] + m[i + 1]), jerk = (m[i + 1] - m[i]) / lengths[i];
  return {values[i] + s * (slope + s * (m[i] / 2 + s / 6 * jerk)), slope + s * (m[i] + s / 2 * jerk), m[i] + s * jerk};
}

TEST(KeyFrames, AreTheNaturalSplineOfEachVertex) {
  const auto keys = random_keys(12, 5);
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    const bool cubic = interpolation == Interpolation::cubic;
    const KeyFrames frames(interpolation, kFirst, kInterval, keys, false);
    for (std::size_t v = 0; v < 5; ++v) {
      std::vector<double> times;
      std::vector<Vec3> values;
      for (std::size_t k = 0; k < keys.size(); ++k) {
        times.push_back(kFirst + static_cast<double>(k) * kInterval);
        values.push_back(keys[k][v]);
      }
      const Spline<3> straight(Interpolation::linear, times, values);
      for (double t = 0.6; t < 1.3; t += 0.0173) {
        const Motion motion = at(frames, 5, t);
        const auto expected = cubic ? natural_at(times, values, t) : straight.at(t);
        // Tolerances: rounding errors of positions of 1 m, velocities of 50 m/s and accelerations of 5000 m/s².
        EXPECT_LT((motion.positions[v] - expected.value).norm(), 1e-12) << t;
        EXPECT_LT((motion.velocities[v] - expected.first_derivative).norm(), 1e-10) << t;
        EXPECT_LT((motion.accelerations[v] - expected.second_derivative).norm(), 1e-8) << t;
      }
    }
  }
}

TEST(KeyFrames, HaveTheVelocityAndAccelerationOfCentralDifferences) {
  const auto keys = random_keys(12, 3);
  constexpr double kStep = 1e-5;
  for (const bool from_rest : {false, true}) {
    const KeyFrames frames(Interpolation::cubic, kFirst, kInterval, keys, from_rest);
    for (double t = kFirst + 0.003; t < kFirst + 10.9 * kInterval; t += 0.0131) {
      const Motion now = at(frames, 3, t), before = at(frames, 3, t - kStep), after = at(frames, 3, t + kStep);
      for (std::size_t v = 0; v < 3; ++v) {
        // Tolerance of velocities: a central difference of a cubic has an error of kStep² / 6 times its third
        // derivative, about 1e5 m/s³.
        EXPECT_LT((now.velocities[v] - (after.positions[v] - before.positions[v]) / (2 * kStep)).norm(), 1e-4);
        EXPECT_LT((now.accelerations[v] - (after.velocities[v] - before.velocities[v]) / (2 * kStep)).norm(), 10);
      }
    }
  }
}

TEST(KeyFrames, FromRestBeginWithoutVelocityAndAreTwiceDifferentiable) {
  const auto keys = random_keys(6, 2);
  const KeyFrames frames(Interpolation::cubic, kFirst, kInterval, keys, true);
  EXPECT_LT(at(frames, 2, kFirst).velocities[0].norm(), 1e-12);
  for (int k = 1; k < 5; ++k) {
    const double t = kFirst + k * kInterval;
    const Motion before = at(frames, 2, t - 1e-9), after = at(frames, 2, t + 1e-9);
    EXPECT_LT((after.velocities[1] - before.velocities[1]).norm(), 1e-4);
    EXPECT_LT((after.accelerations[1] - before.accelerations[1]).norm(), 1e-2);
  }
}

TEST(KeyFrames, StandBeforeTheFirstAndAfterTheLast) {
  const auto keys = random_keys(4, 2);
  const KeyFrames frames(Interpolation::cubic, kFirst, kInterval, keys, false);
  for (const auto& [t, key] : {std::pair{0.0, 0}, {5.0, 3}}) {
    const Motion motion = at(frames, 2, t);
    EXPECT_EQ(motion.positions, keys[key]);
    EXPECT_EQ(motion.velocities[0], Vec3(0, 0, 0));
    EXPECT_EQ(motion.accelerations[1], Vec3(0, 0, 0));
  }
}

TEST(KeyFrames, HaveTheSameBitsForAnyNumberOfThreads) {
  const auto keys = random_keys(5, 9000);
  const auto run = [&](int threads) {
    set_thread_count(threads);
    return at(KeyFrames(Interpolation::cubic, kFirst, kInterval, keys, true), 9000, kFirst + 0.055);
  };
  EXPECT_EQ(run(1).positions, run(0).positions);
}

TEST(KeyFrames, TakeTwiceTheirPositionsWhereCubic) {
  EXPECT_EQ(KeyFrames(Interpolation::linear, 0, 1, random_keys(4, 10), false).bytes(), 4u * 10 * 24);
  EXPECT_EQ(KeyFrames(Interpolation::cubic, 0, 1, random_keys(4, 10), false).bytes(), 2u * 4 * 10 * 24);
  EXPECT_FALSE(KeyFrames(Interpolation::cubic, 0, 1, random_keys(1, 10), false).is_moving());
}

}  // namespace
}  // namespace weft::motion
