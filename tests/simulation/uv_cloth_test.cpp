// Tests of garments from mesh files whose UV coordinates are their patterns.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "film/environment/environment.hpp"
#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"
#include "tools/export/obj.hpp"

namespace weft::simulation {
namespace {

// A sheet of 0.28 m by 0.12 m in seven pleats at 45°. Two UV islands meet in the middle; the right one is mirrored.
constexpr int kWide = 28, kHigh = 12;
constexpr double kCell = 0.01;  // [m]

class UvCloth : public support::TestFolder {
 protected:
  void write_sheet(bool with_uv) const {
    std::ofstream out(folder_ / "pleats.obj");
    out.precision(12);
    out << "o pleats\n";
    double x = 0, z = 0;
    for (int i = 0; i <= kWide; ++i) {
      for (int j = 0; j <= kHigh; ++j) out << "v " << x << ' ' << kCell * j << ' ' << z << '\n';
      const double slope = i / 2 % 2 == 0 ? 1 : -1;
      x += std::sqrt(0.5) * kCell, z += slope * std::sqrt(0.5) * kCell;
    }
    for (const bool right : {false, true})
      for (int i = 0; i <= kWide / 2; ++i)
        for (int j = 0; j <= kHigh; ++j)
          out << "vt " << (right ? 2 - kCell * i : kCell * i) << ' ' << kCell * j << '\n';
    for (int i = 0; i < kWide; ++i)
      for (int j = 0; j < kHigh; ++j) {
        const bool right = i >= kWide / 2;
        const auto corner = [&](int column, int row) {
          const int v = 1 + row + (kHigh + 1) * column;
          const int vt = right ? v + kHigh + 1 : v;  // the middle column has two UV vertices
          return with_uv ? fmt::format(" {}/{}", v, vt) : fmt::format(" {}", v);
        };
        out << 'f' << corner(i, j) << corner(i + 1, j) << corner(i + 1, j + 1) << '\n';
        out << 'f' << corner(i, j) << corner(i + 1, j + 1) << corner(i, j + 1) << '\n';
      }
  }
  scene::Scene scene(const std::string& keys) const {
    return support::scene_of_text(
        "[time]\nduration = 1\n[physics]\ngravity = [0, 0, 0]\nair_density = 0\n[contact]\nself = false\n"
        "[[cloth]]\nname = 'pleats'\nshape = 'mesh'\nmaterial = { fabric = 'cotton', bend_friction = 0 }\nfile = '" +
        (folder_ / "pleats.obj").string() + "'\n" + keys);
  }
  /// Width across the pleats at the end [m].
  double width(const std::string& keys) const {
    production::SceneSimulation simulation(scene(keys));
    for (int k = 0; k < 25; ++k) simulation.advance();
    double low = 1, high = -1;
    for (const Vec3& x : testing::sheet_of(simulation.snapshot()))
      low = std::min(low, x.x()), high = std::max(high, x.x());
    return high - low;
  }
};

TEST_F(UvCloth, PleatsOpenWhereTheUvsAreAFlatSheetAndStayWhereTheMeshIsItsShape) {
  write_sheet(true);
  const double pleated = std::sqrt(0.5) * kCell * kWide, flat = kCell * kWide;
  EXPECT_NEAR(width("rest = 'mesh'\n"), pleated, 0.01 * pleated);
  const double opened = width("");  // without the key `rest`
  EXPECT_GT(opened, pleated + 0.7 * (flat - pleated));
  EXPECT_LT(opened, 1.01 * flat);
}

TEST_F(UvCloth, IslandsThatMeetAreOneCloth) {
  write_sheet(true);
  const environment::Environment made(scene("rest = 'uv'\n"));
  const model::Cloth& cloth = made.model.cloths[0];
  EXPECT_EQ(cloth.start.size(), std::size_t{(kWide + 1) * (kHigh + 1)});
  EXPECT_TRUE(cloth.sheet.sewn);
  EXPECT_NE(made.cloths[0].rest_from.find("UVs: 2 islands, 1 unit = 1 m (metres)"), std::string::npos)
      << made.cloths[0].rest_from;
  EXPECT_TRUE(made.cloths[0].warnings.empty());
  // Tolerance: assimp reads files in single precision.
  for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t)
    EXPECT_NEAR(mesh::rest_area(cloth.sheet, t), 0.5 * kCell * kCell, 1e-6 * kCell) << t;
}

TEST_F(UvCloth, WhatDoesNotFitIsSaid) {
  write_sheet(true);
  const auto first_warning = [&](const std::string& keys) {
    const environment::Environment made(scene(keys));
    return made.cloths[0].warnings.empty() ? made.cloths[0].rest_from : made.cloths[0].warnings[0];
  };
  EXPECT_NE(first_warning("rest = 'uv'\nuv_scale = 2\n").find("may not be the pattern"), std::string::npos);
  EXPECT_NE(first_warning("uv_scale = 2\n").find("the mesh, which its UVs do not fit"), std::string::npos);
  support::expect_error(ExitCode::asset_unreadable, "expected a mesh or node named \"sheet\", got pleats",
                        [&] { environment::Environment made(scene("object = 'sheet'\n")); });
  EXPECT_EQ(first_warning("object = 'pleats'\nrest = 'mesh'\n"), "the mesh: the scene says so");
  write_sheet(false);
  EXPECT_EQ(first_warning(""), "the mesh: it has no UVs");
  support::expect_error(ExitCode::asset_unreadable, "expected texture coordinates (UVs) for rest = \"uv\", got none",
                        [&] { environment::Environment made(scene("rest = 'uv'\n")); });
}

// A sewn tube that hangs on a post is written and read back: its pattern must be the same, and it must continue to
// hang.
TEST_F(UvCloth, AGarmentThatIsExportedAndReadBackDrapesAsItDid) {
  std::string pattern = testing::kTube + "allowance = 0\n";  // allowances are not in meshes
  pattern.insert(pattern.rfind("[[seam]]"), "allowance = 0\n");
  support::write_bytes(folder_ / "tube.toml", pattern);
  const std::string post =
      "[time]\nduration = 2\n[[obstacle]]\nname = 'post'\nshape = 'cone'\nradius = 0.16\nheight = 0.6\n"
      "position = [0, 0, 0.2]\nsegments = 32\n[[cloth]]\nname = 'tube'\nmaterial = { fabric = 'silk' }\n";
  const scene::Scene sewn =
      support::scene_of_text(post + "shape = 'pattern'\nfile = '" + (folder_ / "tube.toml").string() +
                             "'\nedge_length = 0.04\nsewing = 0.4\nposition = [0, 0, 0.05]\n");
  constexpr int kExported = 40, kOn = 10;
  production::SceneSimulation simulation(sewn);
  for (int k = 0; k < kExported; ++k) simulation.advance();
  const frame::SnapshotPtr exported = simulation.snapshot();
  exporter::write_obj(folder_ / "tube.obj", *exported->surfaces[0], exported->states[0].positions);
  for (int k = 0; k < kOn; ++k) simulation.advance();
  const std::vector<Vec3> went_on = testing::sheet_of(simulation.snapshot());

  scene::Scene read =
      support::scene_of_text(post + "shape = 'mesh'\nfile = '" + (folder_ / "tube.obj").string() + "'\n");
  const environment::Environment made(read);
  const model::Cloth& cloth = made.model.cloths[0];
  EXPECT_NE(made.cloths[0].rest_from.find("UVs, which fit it as panels do: 2 islands, 1 unit = 1 m (metres)"),
            std::string::npos)
      << made.cloths[0].rest_from;
  double area = 0;
  for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t) area += mesh::rest_area(cloth.sheet, t);
  EXPECT_NEAR(area, 2 * 0.33 * 0.3, 1e-6);  // tolerance: assimp reads files in single precision
  // The faces of the file determine the numbers of the vertices. The test therefore takes the distance from each
  // particle to the nearest particle of the earlier run.
  const auto off = [&] {
    production::SceneSimulation again(read);
    for (int k = 0; k < kOn; ++k) again.advance();
    double sum_sq = 0;
    for (const Vec3& x : testing::sheet_of(again.snapshot())) {
      double least_sq = 1;
      for (const Vec3& y : went_on) least_sq = std::min(least_sq, (x - y).squaredNorm());
      sum_sq += least_sq;
    }
    return std::sqrt(sum_sq / static_cast<double>(went_on.size()));
  };
  const double by_uv = off();
  read.cloths[0].uv_scale = Vec2(1.1, 1.1);
  const double too_large = off();
  std::printf("off by %.2f mm, with UVs of another size by %.2f mm\n", 1e3 * by_uv, 1e3 * too_large);
  EXPECT_LT(by_uv, 0.002);
  EXPECT_GT(too_large, 3 * by_uv);
}

}  // namespace
}  // namespace weft::simulation
