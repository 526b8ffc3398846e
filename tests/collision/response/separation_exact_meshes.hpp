// Compares separating planes with exact decisions for meshes: pairs with a common vertex, in each vertex star, and the
// results of corrections.
#pragma once

#include <numbers>
#include <set>
#include <utility>

#include "collision/response/separation_exact.hpp"

namespace weft::collision {

/// One surface in linear motion.
struct MovingMesh {
  std::vector<Triangle> triangles;
  std::vector<Vec3> x_t0, x_t1;
  std::vector<std::uint8_t> movable;

  struct Pair {
    TrianglePair triangles;
    int corner_a = -1, corner_b = -1;  ///< number of the common vertex among the corners of each; −1: none
  };

  const Triangle& at(Index triangle) const { return triangles[triangle]; }
  /// All pairs with at most one common vertex.
  std::vector<Pair> pairs() const {
    std::vector<Pair> list;
    for (Index a = 0; a < static_cast<Index>(triangles.size()); ++a) {
      for (Index b = a + 1; b < static_cast<Index>(triangles.size()); ++b) {
        Pair pair{{a, b}};
        int common = 0;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            if (at(a)[i] != at(b)[j]) continue;
            ++common;
            pair.corner_a = i;
            pair.corner_b = j;
          }
        }
        if (common < 2) list.push_back(pair);
      }
    }
    return list;
  }
  std::vector<TrianglePair> pairs_apart() const {
    std::vector<TrianglePair> list;
    for (const Pair& pair : pairs())
      if (pair.corner_a < 0) list.push_back(pair.triangles);
    return list;
  }
  Separation separation() const {
    const Surface surface{triangles, 0, 0, static_cast<Index>(x_t0.size())};
    return {triangles, std::span(&surface, 1)};
  }
  support::MovingSimplex moving(Index triangle) const {
    support::MovingSimplex s;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(at(triangle)[k]);
      s.t0[k] = x_t0[v];
      s.t1[k] = x_t1[v];
    }
    return s;
  }
  support::Contact contact(const Pair& pair) const {
    const support::MovingSimplex a = moving(pair.triangles.a), b = moving(pair.triangles.b);
    return pair.corner_a < 0 ? support::find_contact(a, b)
                             : support::find_contact_beside_shared(a, pair.corner_a, b, pair.corner_b);
  }
  std::vector<Vec3> mixed(double t) const {
    std::vector<Vec3> x;
    for (std::size_t v = 0; v < x_t0.size(); ++v) x.push_back((1 - t) * x_t0[v] + t * x_t1[v]);
    return x;
  }
};

// --- Vertex stars ----------------------------------------------------------------------------------------------------

enum class StarKind {
  calm,         ///< closed and nearly flat, motions up to 1e-3 of its size: all pairs must be certified
  closed,       ///< the triangles go once around the centre; flat, conical or wavy; every vertex moves on its own
  inverted,     ///< a cone or saddle that is turned inside out
  turned,       ///< rotated by up to half a turn about any axis; the vertices move on straight lines
  open,         ///< at a border; the triangles go up to 1.8 times around, as a spiral staircase
  collapsing,   ///< a spiral staircase whose ends pass through each other
  around_twice  ///< the triangles go twice around, with the same orientation: they intersect at the start
};
inline constexpr std::array kStarKinds = {StarKind::calm, StarKind::closed,     StarKind::inverted,    StarKind::turned,
                                          StarKind::open, StarKind::collapsing, StarKind::around_twice};
inline const char* name(StarKind kind) {
  constexpr const char* kNames[] = {"calm", "closed", "inverted", "turned", "open", "collapsing", "around twice"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// Makes a vertex star of size 1; vertex 0 is its centre.
inline MovingMesh make_star_of_size_one(StarKind kind, std::mt19937& engine) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const auto vector = [&](double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return Vec3(x, y, z);
  };
  const bool open = kind == StarKind::open || kind == StarKind::collapsing;
  const int count =
      kind == StarKind::around_twice ? 5 + static_cast<int>(engine() % 6) : 3 + static_cast<int>(engine() % 6);
  std::vector<double> angles{0};
  for (int k = 0; k < count; ++k)
    angles.push_back(angles.back() + (kind == StarKind::calm ? 1 : std::pow(10.0, between(-1.5, 0))));
  const double total = open ? between(0.5, 3.6) : kind == StarKind::around_twice ? 4 : 2;
  for (double& angle : angles) angle *= total * std::numbers::pi / (open ? angles.back() : angles[count]);

  const double cone = kind == StarKind::calm ? 0 : between(-1, 1),
               wave = kind == StarKind::calm ? 0.05 : between(-1, 1);
  const double pitch = kind == StarKind::collapsing ? 0.1 : open ? between(0.02, 0.3) : 0;
  MovingMesh mesh;
  mesh.x_t0.push_back(Vec3::Zero());
  const int ring = open ? count + 1 : count;
  for (int k = 0; k < ring; ++k) {
    const double angle = angles[k], r = between(0.5, 1);
    const double twice = kind == StarKind::around_twice ? 0.3 * std::sin(angle / 2) : 0;
    mesh.x_t0.push_back({r * std::cos(angle), r * std::sin(angle),
                         r * (cone + wave * std::sin(2 * angle)) * (open ? 0.2 : 1) + pitch * angle + twice});
  }
  for (Index k = 0; k < count; ++k) mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % ring});

  mesh.x_t1 = mesh.x_t0;
  const double motion = kind == StarKind::calm ? 1e-3 : std::pow(10.0, between(-4, 0.3));
  const double fraction = between(0, 1), turn = between(0, 1) * std::numbers::pi;
  const Eigen::AngleAxisd rotation(turn, vector(1).normalized());
  for (std::size_t v = 0; v < mesh.x_t1.size(); ++v) {
    Vec3& x = mesh.x_t1[v];
    if (kind == StarKind::inverted) x.z() *= 1 - 2 * fraction;
    if (kind == StarKind::turned) x = (rotation * x).eval();
    if (kind == StarKind::collapsing && v > 0) x.z() -= 2 * fraction * pitch * angles[v - 1];
    x += vector(kind == StarKind::closed || kind == StarKind::calm || kind == StarKind::open ? motion : 0.01 * motion);
  }
  return mesh;
}

/// Makes a vertex star of random size (1 µm to 1 km), orientation and place.
inline MovingMesh make_fan(StarKind kind, std::mt19937& engine) {
  MovingMesh mesh = make_star_of_size_one(kind, engine);
  std::uniform_real_distribution<double> number(-1, 1);
  const double size = std::pow(10.0, -1.5 + 4.5 * number(engine));
  const Eigen::AngleAxisd rotation(3 * number(engine), Vec3(number(engine), number(engine), 0.1).normalized());
  const double away = engine() % 2 == 0 ? 0 : std::pow(10.0, -1.5 + 4.5 * number(engine));
  const Vec3 shift = away * Vec3(number(engine), number(engine), number(engine));
  for (auto* positions : {&mesh.x_t0, &mesh.x_t1})
    for (Vec3& x : *positions) x = (shift + size * (rotation * x)).eval();
  return mesh;
}

struct StarTally {
  int fans = 0, queries = 0, meeting = 0, certified = 0, missed = 0, refused_apart = 0;
};

/// Makes one query for each side of each pair with a common vertex: the edge opposite to this vertex against the other
/// triangle.
inline void test_star(const MovingMesh& mesh, Watched watched, StarTally& tally) {
  // An edge against a triangle, both as sets of vertices.
  using Key = std::pair<std::set<Index>, std::set<Index>>;
  const auto key = [](const Triangle& a, const Triangle& b) { return Key{{a.begin(), a.end()}, {b.begin(), b.end()}}; };
  Separation separation = mesh.separation();
  separation.watch(mesh.pairs_apart(),
                   watched == Watched::at_start ? mesh.x_t0 : mesh.mixed(watched == Watched::elsewhere ? -0.1 : 0.5));
  if (watched == Watched::on_the_way) separation.find_failing(mesh.x_t0, mesh.mixed(0.25));
  std::set<Key> refused;
  for (const CornerPair& pair : separation.find_failing(mesh.x_t0, mesh.x_t1)) refused.insert(key(pair.a, pair.b));

  ++tally.fans;
  const auto test_edge = [&](Index edge_of, int opposite, Index face) {
    const Triangle& t = mesh.at(edge_of);
    const Index p = t[static_cast<std::size_t>(opposite + 1) % 3], q = t[static_cast<std::size_t>(opposite + 2) % 3];
    const bool is_refused = refused.contains(key({p, q, q}, mesh.at(face)));
    const support::Contact contact =
        support::find_contact(mesh.moving(edge_of).edge_opposite(opposite), mesh.moving(face));
    ++tally.queries;
    tally.meeting += contact.found;
    tally.certified += !is_refused;
    tally.refused_apart += is_refused && !contact.found;
    if (!contact.found || is_refused || ++tally.missed > 3) return;
    ADD_FAILURE() << "certified, but edge " << p << "-" << q << " meets a triangle of its fan at t = " << contact.time;
  };
  for (const MovingMesh::Pair& pair : mesh.pairs()) {
    if (pair.corner_a < 0) continue;
    test_edge(pair.triangles.a, pair.corner_a, pair.triangles.b);
    test_edge(pair.triangles.b, pair.corner_b, pair.triangles.a);
  }
}

inline void expect_nothing_missed_in_fans(int fans_per_kind, unsigned seed) {
  std::printf("%-14s %8s %8s %8s %9s %7s %s\n", "fans", "fans", "queries", "meeting", "certified", "missed",
              "apart, but refused");
  for (StarKind kind : kStarKinds) {
    SCOPED_TRACE(name(kind));
    std::mt19937 engine(seed + static_cast<unsigned>(kind));
    const std::clock_t begin = std::clock();
    StarTally tally;
    for (int k = 0; k < fans_per_kind; ++k) test_star(make_fan(kind, engine), static_cast<Watched>(k % 3), tally);
    std::printf("%-14s %8d %8d %8d %9d %7d %d  %.1f s\n", name(kind), tally.fans, tally.queries, tally.meeting,
                tally.certified, tally.missed, tally.refused_apart,
                static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    EXPECT_EQ(tally.missed, 0);
    if (kind == StarKind::calm) {
      EXPECT_EQ(tally.meeting, 0);
      EXPECT_EQ(tally.refused_apart, 0);
    } else {
      EXPECT_GT(tally.meeting, tally.queries / 1000);
      EXPECT_GT(tally.certified, tally.queries / 100);
    }
  }
}

// --- Corrections -----------------------------------------------------------------------------------------------------

/// Adds triangles at rest, unless one of them is closer than 1e-5 m to another triangle, because pairs closer than
/// 1e-6 m cannot be certified. Returns whether they were added.
inline bool add_component(MovingMesh& mesh, const std::vector<Vec3>& x, const std::vector<Triangle>& triangles) {
  MovingMesh larger = mesh;
  const auto first = static_cast<Index>(mesh.x_t0.size());
  larger.x_t0.insert(larger.x_t0.end(), x.begin(), x.end());
  larger.x_t1 = larger.x_t0;
  for (const Triangle& t : triangles) larger.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const auto old_count = static_cast<Index>(mesh.triangles.size());
  for (const MovingMesh::Pair& pair : larger.pairs()) {
    if (pair.triangles.b < old_count) continue;
    if (larger.contact(pair).found) return false;
    const support::MovingSimplex a = larger.moving(pair.triangles.a), b = larger.moving(pair.triangles.b);
    if (pair.corner_a < 0 ? support::distance_at(a, b, 0) < 1e-5
                          : support::distance_at(a.edge_opposite(pair.corner_a), b, 0) < 1e-5 ||
                                support::distance_at(a, b.edge_opposite(pair.corner_b), 0) < 1e-5)
      return false;
  }
  mesh = std::move(larger);
  return true;
}

/// Two to five triangles, quads and vertex stars in a box of 0.1 m, which move by up to `motion` [m].
inline MovingMesh make_cluster(std::mt19937& engine, double motion) {
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&](double size) {
    const double x = number(engine), y = number(engine), z = number(engine);
    return Vec3(size * x, size * y, size * z);
  };
  MovingMesh cluster;
  for (int parts = 2 + static_cast<int>(engine() % 4); parts > 0;) {
    const Vec3 place = vector(0.05);
    std::vector<Vec3> x;
    std::vector<Triangle> triangles{{0, 1, 2}};
    if (engine() % 3 == 0) {
      const MovingMesh fan = make_star_of_size_one(StarKind::closed, engine);
      for (const Vec3& corner : fan.x_t0) x.push_back(place + 0.04 * corner);
      triangles = fan.triangles;
    } else {
      const bool quad = engine() % 2 == 0;
      for (int k = quad ? 4 : 3; k > 0; --k) x.push_back(place + vector(0.04));
      if (quad) triangles.push_back({2, 1, 3});
    }
    parts -= add_component(cluster, x, triangles);
  }
  for (Vec3& x : cluster.x_t1) x += vector(motion);
  cluster.movable.assign(cluster.x_t0.size(), 1);
  return cluster;
}

/// Expects that after enforce(), no pair of a cluster meets at any time of the step.
inline void expect_nothing_meets_after_enforcement(int count, unsigned seed) {
  std::mt19937 engine(seed);
  int would_meet = 0, queries = 0, with_vertex = 0, given_up = 0;
  for (int k = 0; k < count; ++k) {
    MovingMesh cluster = make_cluster(engine, std::pow(10.0, -4 + 4.0 * k / count));
    // Of three clusters, one is free, one has a moving obstacle (its first triangle), and one has held vertices.
    const bool obstacle = k % 3 == 1, held = k % 3 == 2;
    for (Index v : cluster.triangles[0])
      if (obstacle) cluster.movable[v] = 0;
    for (std::size_t v = 0; v < cluster.x_t0.size(); ++v) {
      if (!held || engine() % 4 != 0) continue;
      cluster.movable[v] = 0;
      cluster.x_t1[v] = cluster.x_t0[v];
    }
    const std::vector<Vec3> wanted = cluster.x_t1;
    const std::vector<MovingMesh::Pair> pairs = cluster.pairs();
    queries += static_cast<int>(pairs.size());
    for (const MovingMesh::Pair& pair : pairs) {
      if (!cluster.contact(pair).found) continue;
      ++would_meet;
      with_vertex += pair.corner_a >= 0;
    }

    Separation separation = cluster.separation();
    separation.watch(cluster.pairs_apart(), cluster.x_t0);
    const SeparationReport report = separation.enforce(cluster.x_t0, cluster.x_t1, cluster.movable);
    for (std::size_t v = 0; v < wanted.size(); ++v) {
      if (!cluster.movable[v]) {
        EXPECT_EQ(cluster.x_t1[v], wanted[v]);
      }
    }
    // An obstacle may leave no clearance. Without obstacles, pairs that start apart can always return to the start.
    if (!obstacle) {
      EXPECT_TRUE(report.separated) << "cluster " << k;
    }
    given_up += !report.separated;
    if (!report.separated) continue;
    for (const MovingMesh::Pair& pair : pairs) {
      const support::Contact contact = cluster.contact(pair);
      ASSERT_FALSE(contact.found) << "cluster " << k << ": triangles " << pair.triangles.a << " and "
                                  << pair.triangles.b << " meet at t = " << contact.time;
    }
  }
  std::printf("%d clusters with %d pairs, %d of which would meet, %d of these with a common vertex; %d given up\n",
              count, queries, would_meet, with_vertex, given_up);
  EXPECT_GT(would_meet, queries / 20);
  EXPECT_GT(with_vertex, queries / 200);
  EXPECT_LT(given_up, count / 20);
}

}  // namespace weft::collision
