// Compares the separating planes of Separation with exact decisions, for each family of queries.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

#include "physics/collision/response/separation.hpp"
#include "support/exact_motion_queries.hpp"

namespace weft::collision {

/// Results of the queries of one family. A pair is certified if it has a separating plane, else refused.
struct SeparationTally {
  int queries = 0, meeting = 0, certified = 0, in_integers = 0;
  int missed = 0;             ///< certified pairs that meet
  int touching = 0;           ///< certified pairs that meet only at the start, where they touch within rounding errors
  int needless_refusals = 0;  ///< pairs that are benign, but refused
  int benign = 0;  ///< pairs that start at least 1e-5 m apart, move by at most 0.8 of this distance, and do not meet
  // Pairs that do not meet (`apart`), and the refused ones among them, by distance at the start [m]: below 1e-8, 1e-7,
  // …, 1e-2, above.
  std::array<int, 8> apart{}, refused{};
};

/// Positions from which the search for separating planes of a step begins.
enum class Watched {
  at_start,    ///< from the start of this step
  on_the_way,  ///< from the middle of the step, after a test of its first quarter
  elsewhere    ///< from other positions, as in an earlier step
};

/// Several pairs, each with six vertices of its own: pair p has triangles 2p and 2p + 1.
struct SeparationBatch {
  std::vector<Triangle> triangles;
  std::vector<TrianglePair> pairs;
  std::vector<Vec3> x_t0, x_t1;

  void add(const support::MotionQuery& query) {
    const auto p = static_cast<Index>(pairs.size());
    pairs.push_back({2 * p, 2 * p + 1});
    for (const support::MovingSimplex* s : {&query.a, &query.b}) {
      const auto first = static_cast<Index>(x_t0.size());
      triangles.push_back({first, first + 1, first + 2});
      x_t0.insert(x_t0.end(), s->t0.begin(), s->t0.end());
      x_t1.insert(x_t1.end(), s->t1.begin(), s->t1.end());
    }
  }
  /// One flag per pair; 1: no separating plane was found.
  std::vector<char> refused(Watched watched) const {
    const auto mixed = [&](double t) {
      std::vector<Vec3> x;
      for (std::size_t v = 0; v < x_t0.size(); ++v) x.push_back((1 - t) * x_t0[v] + t * x_t1[v]);
      return x;
    };
    Separation separation(triangles, {});
    separation.watch(pairs, watched == Watched::at_start ? x_t0 : mixed(watched == Watched::elsewhere ? -0.1 : 0.5));
    if (watched == Watched::on_the_way) separation.find_failing(x_t0, mixed(0.25));
    std::vector<char> flags(pairs.size(), 0);
    for (const CornerPair& pair : separation.find_failing(x_t0, x_t1)) flags[pair.a[0] / 6] = 1;
    return flags;
  }
};

/// Maximum motion of a corner of one triangle relative to a corner of the other [m].
inline double relative_motion(const support::MotionQuery& q) {
  double max_motion = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      max_motion = std::max(max_motion, ((q.a.t1[i] - q.a.t0[i]) - (q.b.t1[j] - q.b.t0[j])).norm());
  return max_motion;
}

/// Decides a query exactly, and adds the result to `tally`.
inline void tally_query(const support::MotionQuery& query, bool refused, SeparationTally& tally) {
  const support::Contact contact = support::find_contact(query.a, query.b);
  ++tally.queries;
  tally.certified += !refused;
  tally.in_integers += contact.integers_used;
  if (contact.found) {
    ++tally.meeting;
    if (refused) return;
    // Below the rounding error of a dot product, 1e-15 of the coordinates, triangles count as touching.
    const double largest = std::max(query.a.t0[0].norm(), relative_motion(query));
    if (contact.time < 1e-9 && support::distance_at(query.a, query.b, 0) <= 1e-15 * largest) {
      ++tally.touching;
      return;
    }
    if (++tally.missed > 3) return;
    ADD_FAILURE() << "certified, but they meet at t = " << contact.time << "; distance at the start "
                  << support::distance_at(query.a, query.b, 0) << " m, first corner at " << query.a.t0[0].transpose();
    return;
  }
  const double distance = support::distance_at(query.a, query.b, 0);
  const int bin = static_cast<int>(std::clamp(std::floor(std::log10(distance)) + 9, 0.0, 7.0));
  ++tally.apart[bin];
  tally.refused[bin] += refused;
  if (distance >= 1e-5 && relative_motion(query) <= 0.8 * distance) {
    ++tally.benign;
    tally.needless_refusals += refused;
  }
}

/// Tests `count` queries of a family. The same seed gives the same queries.
inline SeparationTally test_family(support::QueryFamily family, int count, unsigned seed) {
  std::mt19937 engine(seed);
  SeparationTally tally;
  int batches = 0;
  while (tally.queries < count) {
    // Batch sizes differ, because watch() tests eight pairs at once, with rounding errors that depend on the largest
    // coordinate of the eight.
    const int size = std::array{1, 8, 3, 12}[batches / 3 % 4];
    const auto watched = static_cast<Watched>(batches++ % 3);
    std::vector<support::MotionQuery> queries;
    SeparationBatch batch;
    for (int k = std::min(size, count - tally.queries); k > 0; --k) {
      queries.push_back(support::make_query(family, engine));
      batch.add(queries.back());
    }
    const std::vector<char> refused = batch.refused(watched);
    for (std::size_t k = 0; k < queries.size(); ++k) tally_query(queries[k], refused[k], tally);
  }
  return tally;
}

/// Tests every family, prints a table, and expects that nothing is missed.
inline void expect_nothing_missed(int count_per_family, unsigned seed) {
  std::printf("%-18s %8s %8s %9s %8s %6s %6s | refused of those that stay apart, by distance at the start [m]\n",
              "family", "queries", "meeting", "certified", "integers", "missed", "at t0");
  std::printf("%69s | %15s %15s %15s %15s %15s %15s %15s %15s\n", "", "< 1e-8", "< 1e-7", "< 1e-6", "< 1e-5", "< 1e-4",
              "< 1e-3", "< 1e-2", "above");
  int queries = 0, benign = 0;
  for (support::QueryFamily family : support::kQueryFamilies) {
    SCOPED_TRACE(support::name(family));
    const std::clock_t begin = std::clock();
    const SeparationTally tally = test_family(family, count_per_family, seed + static_cast<unsigned>(family));
    std::printf("%-18s %8d %8d %9d %8d %6d %6d |", support::name(family), tally.queries, tally.meeting, tally.certified,
                tally.in_integers, tally.missed, tally.touching);
    for (std::size_t k = 0; k < tally.apart.size(); ++k) std::printf(" %7d/%7d", tally.refused[k], tally.apart[k]);
    std::printf("  %.1f s\n", static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);

    EXPECT_EQ(tally.missed, 0);
    EXPECT_EQ(tally.touching, 0);
    EXPECT_EQ(tally.needless_refusals, 0) << "of " << tally.benign;
    EXPECT_GT(tally.meeting, count_per_family / 100);
    if (family == support::QueryFamily::touching) {
      EXPECT_EQ(tally.meeting, tally.queries);
    } else if (family != support::QueryFamily::nearly_touching) {
      EXPECT_GT(tally.certified, count_per_family / 100);
    }
    queries += tally.queries;
    benign += tally.benign;
  }
  std::printf("%d queries, %d of them benign\n", queries, benign);
  EXPECT_GT(benign, queries / 1000);
}

}  // namespace weft::collision
