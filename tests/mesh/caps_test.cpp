#include "physics/mesh/caps.hpp"

#include <gtest/gtest.h>

#include "physics/mesh/shapes.hpp"
#include "support/mesh_measures.hpp"

namespace weft::mesh {
namespace {

/// Triangles with at least one corner that passes the test.
template <class Test>
std::vector<Triangle> kept_of(const Mesh& mesh, Test test) {
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.topology.triangles)
    if (test(mesh.positions[t[0]]) || test(mesh.positions[t[1]]) || test(mesh.positions[t[2]])) kept.push_back(t);
  return kept;
}

TEST(Caps, CloseASphereThatWasCutTwice) {
  const Mesh sphere = make_sphere(1, 48);
  std::vector<Triangle> kept = kept_of(sphere, [](const Vec3& x) { return std::abs(x.z()) < 0.5; });
  ASSERT_FALSE(inspect(kept, sphere.positions.size()).border.empty());
  close_cuts(sphere.topology.triangles, sphere.positions, kept);
  const TopologyReport report = inspect(kept, sphere.positions.size());
  EXPECT_TRUE(support::watertight(report));
  // The volume of a unit sphere between z = -h and h is 2 π (h - h³/3). The cuts are ragged: h is between 0.5 and 0.61,
  // one row of triangles (7.5 degrees) higher. Tolerance: 48 segments reduce the volume by 1 %.
  const double volume = support::enclosed_volume(kept, sphere.positions);
  EXPECT_GT(volume, 0.98 * 2 * 3.1416 * (0.5 - 0.125 / 3));
  EXPECT_LT(volume, 2 * 3.1416 * (0.61 - 0.61 * 0.61 * 0.61 / 3));
}

TEST(Caps, LeaveBordersOfTheWholeOpen) {
  const Mesh plane = make_plane({2, 2});
  std::vector<Triangle> kept{plane.topology.triangles.front()};
  close_cuts(plane.topology.triangles, plane.positions, kept);
  EXPECT_EQ(kept.size(), 1u) << "a cut from border to border encloses nothing";
}

TEST(Caps, AddNothingWhereNothingWasCut) {
  const Mesh sphere = make_sphere(1, 12);
  std::vector<Triangle> kept = sphere.topology.triangles;
  close_cuts(sphere.topology.triangles, sphere.positions, kept);
  EXPECT_EQ(kept, sphere.topology.triangles);
  kept.clear();
  close_cuts(sphere.topology.triangles, sphere.positions, kept);
  EXPECT_TRUE(kept.empty());
}

// Two openings touch in a vertex. Both loops of this figure eight must be closed separately.
TEST(Caps, CloseRingsThatMeetInAVertex) {
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  // A square pyramid with apex 5, whose base is split at vertex 0. Two opposite faces at the apex are missing.
  const std::vector<Triangle> whole{{1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 1, 5},
                                    {2, 1, 0}, {3, 2, 0}, {4, 3, 0}, {1, 4, 0}};
  std::vector<Triangle> kept{whole[1], whole[3], whole[4], whole[5], whole[6], whole[7]};
  close_cuts(whole, x, kept);
  EXPECT_EQ(kept.size(), 8u);
  EXPECT_TRUE(inspect(kept, x.size()).border.empty());
}

}  // namespace
}  // namespace weft::mesh
