// Tubes that represent ropes in pictures.
#include "film/frame/cords.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace weft::frame {
namespace {

constexpr double kDiameter = 0.01, kPiece = 0.03;

// A rope of `count` particles on a helix, or on a circle if `closed`.
FrameSnapshot rope_of(int count, bool closed, double lay) {
  auto surface = std::make_shared<Surface>();
  surface->name = "rope";
  surface->kind = ObjectKind::rope;
  surface->appearance.thickness = kDiameter;
  surface->appearance.thread_spacing = lay;
  FrameSnapshot snapshot;
  SurfaceState state;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = kPiece * count / (2 * std::numbers::pi);
    state.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), closed ? 0 : 0.05 * angle);
    state.heat.push_back(static_cast<float>(i));
    surface->uv.emplace_back(kPiece * i, 0);
    if (closed || i + 1 < count) surface->triangles.push_back({i, (i + 1) % count, (i + 1) % count});
  }
  snapshot.surfaces.push_back(surface);
  snapshot.states.push_back(std::move(state));
  return snapshot;
}

void expect_closed_surface(const Surface& surface) {
  std::map<std::pair<Index, Index>, int> sides;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(sides.contains({side.second, side.first}));
  }
}

TEST(Cords, AreClosedSurfacesOfTheDiameterAroundTheChain) {
  for (const bool closed : {false, true})
    for (const double lay : {0.0, 3.2 * kDiameter}) {
      const FrameSnapshot chain = rope_of(24, closed, lay);
      Cords cords;
      const FrameSnapshot swept = cords.sweep(chain);
      const SurfaceState& tube = swept.states[0];
      expect_closed_surface(*swept.surfaces[0]);
      EXPECT_EQ(swept.surfaces[0]->uv.size(), tube.positions.size());
      EXPECT_EQ(tube.heat.size(), tube.positions.size());
      double volume = 0, farthest = 0;
      for (const auto& t : swept.surfaces[0]->triangles)
        volume += tube.positions[t[0]].dot(tube.positions[t[1]].cross(tube.positions[t[2]])) / 6;
      for (const Vec3& place : tube.positions) {
        double nearest = 1;
        for (const auto& t : chain.surfaces[0]->triangles) {
          const Vec3 &a = chain.states[0].positions[t[0]], &b = chain.states[0].positions[t[1]];
          const double s = std::clamp((place - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
          nearest = std::min(nearest, (place - a - s * (b - a)).norm());
        }
        farthest = std::max(farthest, nearest);
      }
      // Tolerance: the spline of the centre line is outside the chords by kPiece² / 8 R, 1 mm.
      EXPECT_NEAR(farthest, 0.5 * kDiameter, 1.1e-3);
      // Faces point outward, so the volume is positive. It is below that of a cylinder: furrows between strands remove
      // a fifth of the cross-section, ten sides instead of a circle a sixteenth, and twisted strands some more.
      const double length = kPiece * (closed ? 24 : 23);
      EXPECT_GT(volume, 0.65 * length * std::numbers::pi / 4 * kDiameter * kDiameter);
      EXPECT_LT(volume, 1.3 * length * std::numbers::pi / 4 * kDiameter * kDiameter);
    }
}

TEST(Cords, HaveTheSameFacesInAllFrames) {
  FrameSnapshot chain = rope_of(24, false, 3.2 * kDiameter);
  Cords cords;
  const FrameSnapshot first = cords.sweep(chain);
  for (Vec3& place : chain.states[0].positions) place.z() += 0.3 * place.x() * place.x();
  const FrameSnapshot second = cords.sweep(chain);
  EXPECT_EQ(first.surfaces[0], second.surfaces[0]);
  EXPECT_EQ(first.states[0].positions.size(), second.states[0].positions.size());
}

// A rope hangs from its start, or lies along an axis, and swings by some micrometres.
TEST(Cords, DoNotTurnAboutTheirAxisWhenTheySwing) {
  for (const Vec3& along : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, 1, 0)}) {
    FrameSnapshot chain = rope_of(24, false, 3.2 * kDiameter);
    Cords cords;
    const Vec3 aside = along.unitOrthogonal(), across = along.cross(aside);
    std::vector<Vec3> first;
    for (const double turn : {0.0, 0.1, 0.5, 0.8}) {
      const double angle = 2 * std::numbers::pi * turn;
      const Vec3 swing = 1e-6 * (std::cos(angle) * aside + std::sin(angle) * across);
      for (int i = 0; i < 24; ++i)
        chain.states[0].positions[static_cast<std::size_t>(i)] = i * (kPiece * along + swing);
      const std::vector<Vec3> positions = cords.sweep(chain).states[0].positions;
      if (first.empty()) first = positions;
      double farthest = 0;
      for (std::size_t v = 0; v < positions.size(); ++v)
        farthest = std::max(farthest, (positions[v] - first[v]).norm());
      EXPECT_LT(farthest, 1e-4) << along.transpose() << ", " << turn;
    }
  }
}

TEST(Cords, LeaveSnapshotsWithoutRopesAsTheyAre) {
  FrameSnapshot snapshot;
  snapshot.surfaces.push_back(std::make_shared<Surface>());
  snapshot.states.emplace_back();
  const auto shared = std::make_shared<const FrameSnapshot>(snapshot);
  Cords cords;
  EXPECT_EQ(cords.sweep(shared), shared);
}

}  // namespace
}  // namespace weft::frame
