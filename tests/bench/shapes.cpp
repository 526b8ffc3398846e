// Measures building and refitting, a sheet wound around a ball, and single distances.
#include <array>
#include <numeric>

#include "bench/cgal_tree.hpp"
#include "bench/measure.hpp"
#include "collision/hierarchy/test_meshes.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/hierarchy/tree.hpp"
#include "physics/collision/proximity/closest_points.hpp"
#include "physics/collision/proximity/gjk.hpp"
#include "physics/collision/proximity/proximities.hpp"

namespace weft::bench {

namespace {

using namespace weft::collision;
using collision::testing::folded_sheet;
using collision::testing::random_vec;
using collision::testing::TestMesh;

/// A sheet wound four times around a ball of radius 0.2 m, from 60° below to 60° above the equator. Its turns are 2 mm
/// apart; it has 91,760 triangles with edges of 7 mm.
TestMesh wound_sheet() {
  constexpr int kAround = 741, kUp = 63;
  TestMesh mesh;
  for (int j = 0; j < kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double turns = 4.0 * i / (kAround - 1), angle = 2 * M_PI * turns;
      const double height = (j / (kUp - 1.0) - 0.5) * 2 * M_PI / 3, radius = 0.2 + 0.002 * turns;
      mesh.x.emplace_back(radius * std::cos(height) * std::cos(angle), radius * std::cos(height) * std::sin(angle),
                          radius * std::sin(height));
      if (i + 1 == kAround || j + 1 == kUp) continue;
      const Index corner = i + kAround * j;
      mesh.triangles.push_back({corner, corner + 1, corner + 1 + kAround});
      mesh.triangles.push_back({corner, corner + 1 + kAround, corner + kAround});
    }
  return mesh;
}

template <int K>
void build_row(const TestMesh& mesh, int children) {
  const int runs = mesh.triangles.size() > 200000 ? 3 : 7;
  Tree<K> tree;
  const double build = median_ms(runs, [&] { tree = Tree<K>(mesh.surface(), mesh.x, {.children = children}); });
  const double refit = median_ms(runs, [&] { tree.refit({mesh.x, mesh.x}, 0.001); });
  fmt::print("| {} | {} | {} | {:.2f} | {:.3f} |\n", mesh.triangles.size(), K, children, build, refit);
}

/// Minimum distance of two triangles that do not intersect, by the closed forms.
double closed_form(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  double least_sq = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    least_sq = std::min(least_sq, closest_vertex_face(a[i], b[0], b[1], b[2]).distance_sq);
    least_sq = std::min(least_sq, closest_vertex_face(b[i], a[0], a[1], a[2]).distance_sq);
    for (std::size_t j = 0; j < 3; ++j)
      least_sq = std::min(least_sq, closest_edge_edge(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).distance_sq);
  }
  return std::sqrt(least_sq);
}

}  // namespace

void build_and_refit() {
  fmt::print("| triangles | k | children | build | refit |\n|---|---|---|---|---|\n");
  for (const int n : {23, 72, 225, 708}) {
    const TestMesh mesh = folded_sheet(n, 4, 0.002);
    for (const int children : {2, 4, 8}) build_row<6>(mesh, children);
    build_row<18>(mesh, 8);
    build_row<26>(mesh, 8);
  }
}

void wrapped_ball() {
  constexpr double kReach = 0.003;
  const TestMesh mesh = wound_sheet();
  const Surface surface = mesh.surface();
  fmt::print("{} triangles, reach {} m; CPU ms\n\n", mesh.triangles.size(), kReach);
  fmt::print(
      "| | build | refit | pairs | proximities | pairs listed | proximities found |\n|---|---|---|---|---|---|---|\n");
  ProximityFinder finder(mesh.triangles, surface.vertex_count);
  for (const int k : {6, 18, 26})
    for (const int children : {2, 4, 8}) {
      if (k != 6 && children != 8) continue;
      for (const bool cones : {false, true}) {
        if (cones && (k != 6 || children != 8)) continue;
        BroadPhaseOptions options;
        options.directions = k;
        options.children = children;
        options.normal_cones = cones;
        BroadPhase broad_phase;
        const double build = median_ms(3, [&] { broad_phase = BroadPhase(std::span(&surface, 1), mesh.x, options); });
        const double refit = median_ms(5, [&] { broad_phase.refit(0, {mesh.x, mesh.x}, kReach / 2); });
        CandidatePairs candidates;
        const double pairs = median_ms(5, [&] {
          candidates.clear();
          broad_phase.self_pairs(0, candidates);
        });
        std::vector<Proximity> found;
        const double find =
            median_ms(3, [&] { finder.find(candidates, std::span(&surface, 1), mesh.x, kReach, found); });
        fmt::print("| k {}, {} children{} | {:.1f} | {:.2f} | {:.1f} | {:.1f} | {} | {} |\n", k, children,
                   cones ? ", normal cones" : "", build, refit, pairs, find,
                   candidates.apart.size() + candidates.one_shared.size(), found.size());
      }
    }
  const CgalCosts cgal = cgal_self_pairs(mesh.x, mesh.triangles, kReach);
  fmt::print("| CGAL AABB tree, a box query per triangle | {:.1f} | – | {:.1f} | – | {} | – |\n", cgal.build_ms,
             cgal.query_ms, cgal.pairs);
}

void distances() {
  constexpr std::size_t kPairs = 20000;
  fmt::print("| pairs of triangles | closed forms, ns | GJK, ns |\n|---|---|---|\n");
  for (const double away : {0.02, 0.3, 3.0}) {
    std::mt19937 generator(3);
    std::vector<std::array<std::array<Vec3, 3>, 2>> all(kPairs);
    for (auto& [a, b] : all) {
      // Two nearly parallel triangles with legs of length 1 at the distance `away`, as in two layers of cloth.
      const Vec3 shift{0.3, 0.2, away};
      const std::array<Vec3, 3> shape{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
      for (std::size_t c = 0; c < 3; ++c) {
        a[c] = shape[c] + 0.005 * random_vec(generator);
        b[c] = shape[c] + shift + 0.005 * random_vec(generator);
      }
    }
    double sum = 0;
    const double closed = median_ms(7, [&] {
      for (const auto& [a, b] : all) sum += closed_form(a, b);
    });
    const double gjk = median_ms(7, [&] {
      for (const auto& [a, b] : all) sum -= closest_convex(a, b).norm();
    });
    fmt::print("| two layers, {} of an edge apart | {:.0f} | {:.0f} |\n", away, 1e6 * closed / kPairs,
               1e6 * gjk / kPairs);
    if (std::abs(sum) > 1e-6) fmt::print("THEY DIFFER\n");
  }
}

}  // namespace weft::bench
