// Tests of Planes: which separating planes are kept, and that saving and restoring loses none.
#include "physics/collision/response/planes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/archive.hpp"

namespace weft::collision {
namespace {

/// Pairs of random triangles of about 0.1 m that have a separating plane; different pairs are 1 m apart.
struct RandomPairs {
  std::vector<Triangle> triangles;
  std::vector<TrianglePair> pairs;
  std::vector<Vec3> x;

  explicit RandomPairs(int count) {
    for (Index p = 0; p < count; ++p) {
      const Vec3 apart = vector(0.08);
      for (int k = 0; k < 6; ++k) x.push_back(Vec3(p, 0, 0) + vector(0.05) + (k < 3 ? Vec3(Vec3::Zero()) : apart));
      triangles.push_back({6 * p, 6 * p + 1, 6 * p + 2});
      triangles.push_back({6 * p + 3, 6 * p + 4, 6 * p + 5});
      if (find_separating_plane({triangles[2 * p], triangles[2 * p + 1]}, x, x)) pairs.push_back({2 * p, 2 * p + 1});
    }
  }
  std::vector<Vec3> moved(double by) {
    std::vector<Vec3> end = x;
    for (Vec3& place : end) place += vector(by);
    return end;
  }

 private:
  Vec3 vector(double size) {
    std::uniform_real_distribution<double> number(-size, size);
    const double a = number(generator), b = number(generator), c = number(generator);
    return {a, b, c};
  }
  std::mt19937 generator{7};
};

std::vector<CornerPair> failing(Planes& planes, const RandomPairs& of, std::span<const Vec3> x_t0,
                                std::span<const Vec3> x_t1, PlaneKinds which = PlaneKinds::all) {
  const std::vector<float> moved(of.x.size(), 1e9F);  // so large that no pair is separated by its gap alone
  const std::vector<std::uint8_t> changed(of.x.size(), 1);
  std::vector<CornerPair> found;
  planes.find_failing(of.x, x_t0, x_t1, moved, changed, found, nullptr, which);
  return found;
}

std::string saved(Planes& planes, const RandomPairs& of) {
  ByteWriter writer;
  planes.serialize(writer, of.x);
  return writer.bytes;
}

TEST(Planes, AStoredPlaneIsTriedBeforeASearch) {
  RandomPairs pairs(3000);
  Planes planes(pairs.triangles);
  planes.watch(pairs.pairs, pairs.x);
  PairList near;  // pairs that may be closer than 1e-4 m; watch() finds no plane for some of them
  planes.set_moved(std::vector<float>(pairs.x.size(), 0.0F));
  planes.append_closer(1e-4, 0, planes.size(), near);
  std::erase_if(pairs.pairs, [&](const TrianglePair& pair) { return std::ranges::find(near, pair) != near.end(); });
  planes.watch(pairs.pairs, pairs.x);
  const std::string of_watching = saved(planes, pairs);
  EXPECT_TRUE(failing(planes, pairs, pairs.x, pairs.x).empty());
  EXPECT_EQ(saved(planes, pairs), of_watching) << "a search would have found others";
  failing(planes, pairs, pairs.x, pairs.moved(0.03));
  EXPECT_NE(saved(planes, pairs), of_watching);
}

TEST(Planes, UnchangedPairsNeedNoCheck) {
  RandomPairs pairs(1000);
  Planes all(pairs.triangles), changed_only(pairs.triangles);
  for (Planes* planes : {&all, &changed_only}) planes->watch(pairs.pairs, pairs.x);
  const std::vector<float> moved(pairs.x.size(), 1e9F);
  std::vector<std::uint8_t> changed(pairs.x.size(), 1);
  std::vector<Vec3> end = pairs.moved(0.03);
  std::size_t max_count = 0;
  for (std::size_t trial = 0; trial < 20; ++trial) {
    std::vector<CornerPair> found;
    changed_only.find_failing(pairs.x, pairs.x, end, moved, changed, found);
    EXPECT_EQ(found, failing(all, pairs, pairs.x, end)) << "look " << trial;
    max_count = std::max(max_count, found.size());
    const std::vector<Vec3> next = pairs.moved(0.03);
    std::ranges::fill(changed, 0);
    for (std::size_t v = trial; v < end.size(); v += 7) end[v] = next[v], changed[v] = 1;
  }
  EXPECT_GT(max_count, 0U);
  EXPECT_EQ(saved(changed_only, pairs), saved(all, pairs));
}

TEST(Planes, SavingKeepsEveryPlaneThatDiffersFromThoseOfWatching) {
  RandomPairs pairs(3000);
  Planes original(pairs.triangles), restored(pairs.triangles), fresh(pairs.triangles);
  for (Planes* planes : {&original, &restored, &fresh}) planes->watch(pairs.pairs, pairs.x);
  const std::string of_fresh = saved(original, pairs);
  EXPECT_EQ(of_fresh.size(), sizeof(std::size_t));  // only the number of planes, 0
  const std::vector<Vec3> first = pairs.moved(0.03), second = pairs.moved(0.03);
  failing(original, pairs, pairs.x, first);
  const std::string bytes = saved(original, pairs);
  const std::size_t each = sizeof(std::uint32_t) + 4 * sizeof(float);  // number of the pair, normal, gap
  EXPECT_GT(bytes.size(), of_fresh.size());
  EXPECT_EQ((bytes.size() - of_fresh.size()) % each, 0U);

  ByteReader reader{bytes};
  restored.serialize(reader, pairs.x);
  EXPECT_TRUE(reader.bytes.empty());
  EXPECT_EQ(saved(restored, pairs), bytes);
  EXPECT_EQ(failing(restored, pairs, pairs.x, second), failing(original, pairs, pairs.x, second));
}

TEST(Planes, APlaneOfAPairThatIsNotWatchedIsRefused) {
  RandomPairs pairs(10);
  Planes planes(pairs.triangles);
  planes.watch(pairs.pairs, pairs.x);
  ByteWriter writer;
  std::vector<std::uint32_t> changed{static_cast<std::uint32_t>(pairs.pairs.size())};
  serialize_plain(writer, changed);
  writer.bytes.append(16, '\0');
  ByteReader reader{writer.bytes};
  EXPECT_THROW(planes.serialize(reader, pairs.x), std::runtime_error);
}

// For the expected end of a step (PlaneKinds::turning), pairs of cloth are tested with planes for the whole step only;
// pairs with obstacles, also with planes for parts of the step.
TEST(Planes, AFirstGuessTestsPairsOfClothWithTurningPlanesOnly) {
  RandomPairs pairs(3000);
  const auto vertices = static_cast<Index>(pairs.x.size());
  Planes all(pairs.triangles, vertices), of_cloth(pairs.triangles, vertices), of_obstacles(pairs.triangles, 0);
  for (Planes* planes : {&all, &of_cloth, &of_obstacles}) planes->watch(pairs.pairs, pairs.x);
  const std::vector<Vec3> end = pairs.moved(0.05);
  const std::size_t without_any = failing(all, pairs, pairs.x, end).size();
  EXPECT_GT(without_any, 0U);
  EXPECT_GT(failing(of_cloth, pairs, pairs.x, end, PlaneKinds::turning).size(), without_any);
  EXPECT_EQ(failing(of_obstacles, pairs, pairs.x, end, PlaneKinds::turning).size(), without_any);
}

// The gap must be a lower bound of the distance, because pairs that move by less than their gap are not tested.
TEST(Planes, TheGapOfAPlaneIsNoMoreThanTheDistance) {
  RandomPairs pairs(500);
  Planes planes(pairs.triangles);
  planes.watch(pairs.pairs, pairs.x);
  planes.set_moved(std::vector<float>(pairs.x.size(), 0.0F));
  for (double radius : {0.005, 0.02, 0.05}) {
    PairList closer;
    planes.append_closer(radius, 0, 100, closer);
    planes.append_closer(radius, 100, planes.size(), closer);
    std::size_t within = 0;
    for (const TrianglePair& pair : pairs.pairs) {
      const CornerPair corners{pairs.triangles[pair.a], pairs.triangles[pair.b]};
      if (closest_features(corners, pairs.x).points.distance_sq >= radius * radius) continue;
      ++within;
      EXPECT_NE(std::ranges::find(closer, pair), closer.end());
    }
    EXPECT_GT(within, 0U);
    EXPECT_LT(closer.size(), pairs.pairs.size());
  }
}

}  // namespace
}  // namespace weft::collision
