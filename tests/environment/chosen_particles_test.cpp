// Selection of particles for pins and weights by rows, pictures, colours and vertex groups, and the fading of strength
// around them.
#include "film/environment/chosen_particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "film/environment/made_cloth.hpp"
#include "film/image/png.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::environment {
namespace {

std::map<Index, double> shares_of(const std::vector<model::WeightedParticle>& chosen) {
  std::map<Index, double> shares;
  for (const model::WeightedParticle& one : chosen) shares.emplace(one.particle, one.fraction);
  EXPECT_EQ(shares.size(), chosen.size()) << "each once";
  return shares;
}

class ChosenParticles : public support::TestFolder {
 protected:
  /// The first cloth of a scene; `cloth` is appended to its table.
  model::Cloth cloth_of(const std::string& cloth) const {
    return std::move(Environment(support::scene_of_text("[[cloth]]\nname = 'c'\n" + cloth)).model.cloths[0]);
  }
  /// Writes a picture with one row of grey pixels; returns its file.
  std::string row_of(const std::vector<int>& greys) const {
    image::Image picture(static_cast<int>(greys.size()), 1);
    for (std::size_t i = 0; i < greys.size(); ++i)
      for (int k = 0; k < 3; ++k)
        picture.rgb[3 * i + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(greys[i]);
    image::write_png(folder_ / "mask.png", picture, {});
    return (folder_ / "mask.png").string();
  }
  /// A strip of two squares of 1 m along x. Its u decreases along x; red increases along x; blue is 1 at y = 1.
  std::string strip() const {
    std::string text = "o strip\n";
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) text += fmt::format("v {} {} 0 {} 0.25 {}\n", x, y, 0.5 * x, y);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) text += fmt::format("vt {} {}\n", 1 - 0.5 * x, y);
    text += "f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\n";
    support::write_bytes(folder_ / "strip.obj", text);
    return (folder_ / "strip.obj").string();
  }
  std::string strip_with(const std::string& more) const {
    return "shape = 'mesh'\nrest = 'mesh'\nfile = '" + strip() + "'\n" + more;
  }
};

// The spacing of the grid is 0.1 m at rest. The strength decreases with the distance from the row at warp 0, up to 0.25
// m.
TEST_F(ChosenParticles, FadeWithTheDistanceAlongTheClothAtRest) {
  for (const char* shape : {"quads", "aligned_triangles"}) {
    const model::Cloth cloth =
        cloth_of(fmt::format("size = [0.4, 0.4]\nparticles = 5\nstart_scale = [0.5, 0.5]\nshape = '{}'\n"
                             "pin = [{{ high = [1, 0], strength = 10, fade = 0.25 }}]\n",
                             shape));
    const auto shares = shares_of(cloth.pins[0].particles);
    ASSERT_EQ(shares.size(), 15u) << shape;
    for (const auto& [particle, fraction] : shares) {
      const double s = 1 - 0.1 * (particle / 5) / 0.25;
      EXPECT_NEAR(fraction, s * s * (3 - 2 * s), 1e-12) << shape << " " << particle;
    }
    for (std::size_t k = 0; k < cloth.pins[0].particles.size(); ++k)
      EXPECT_EQ(cloth.pins[0].particles[k].faded, k >= 5) << shape;
  }
}

// Distances from a corner of the sheet are also measured across quads: 0.141 m along the diagonal of a cell.
TEST_F(ChosenParticles, FadeAcrossQuadsToo) {
  const model::Cloth cloth =
      cloth_of("size = [0.4, 0.4]\nparticles = 5\npin = [{ high = [0, 0], strength = 10, fade = 0.2 }]\n");
  const auto shares = shares_of(cloth.pins[0].particles);
  const double s = 1 - 0.1 * std::sqrt(2) / 0.2;
  ASSERT_EQ(shares.size(), 4u);
  EXPECT_NEAR(shares.at(6), s * s * (3 - 2 * s), 1e-12);
}

// The mask has three pixels (white, a third of white, black) over five columns of particles. Grey values are exact at
// the middles of pixels, and interpolated between them.
TEST_F(ChosenParticles, HaveTheGreyOfAMaskAsTheirShare) {
  const std::string mask = row_of({255, 85, 0});
  const auto pinned = [&](const std::string& more) {
    return cloth_of("size = [1, 1]\nparticles = 5\npin = [{ mask = '" + mask + "'" + more + " }]\n");
  };
  const auto soft = shares_of(pinned(", strength = 3").pins[0].particles);
  ASSERT_EQ(soft.size(), 20u);
  EXPECT_EQ(soft.at(0), 1);
  EXPECT_NEAR(soft.at(1), 0.25 * 1 / 3.0 + 0.75,
              1e-12);  // 0.75 pixels from the left edge, 0.25 after the middle of a pixel
  EXPECT_NEAR(soft.at(2), 1 / 3.0, 1e-12);
  EXPECT_FALSE(soft.contains(4));
  const auto held = pinned(", high = [1, 0.5]");
  EXPECT_EQ(shares_of(held.pins[0].particles).size(), 6u) << "two columns of three rows: a third is not held";
}

// A mask is upright: its bottom edge is at low warp.
TEST_F(ChosenParticles, AreTakenByMasksThatStandUpright) {
  image::Image picture(1, 2);
  picture.rgb = {255, 255, 255, 0, 0, 0};
  image::write_png(folder_ / "mask.png", picture, {});
  const auto shares = shares_of(cloth_of("size = [1, 1]\nparticles = 3\npin = [{ strength = 1, mask = '" +
                                         (folder_ / "mask.png").string() + "' }]\n")
                                    .pins[0]
                                    .particles);
  EXPECT_FALSE(shares.contains(0));
  EXPECT_EQ(shares.at(8), 1);
}

TEST_F(ChosenParticles, OfMeshesAreTakenByUvsColoursAndGroups) {
  const std::string mask = row_of({255, 0});
  const model::Cloth cloth =
      cloth_of(strip_with("pin = [{ mask = '" + mask +
                          "' }, { vertex_color = 'red', strength = 2 }, { vertex_color = 'blue' },\n"
                          "       { vertex_color = 'brightness', strength = 1, low = [0, 1] }]\n"
                          "weight = [{ vertex_color = 'red', mass = 3 }]\n"));
  const auto x_of = [&](Index i) { return cloth.start[static_cast<std::size_t>(i)].x(); };
  const auto y_of = [&](Index i) { return cloth.start[static_cast<std::size_t>(i)].y(); };
  for (const auto& [particle, fraction] : shares_of(cloth.pins[0].particles))
    EXPECT_GE(x_of(particle), 1) << "UVs run against x";
  const auto red = shares_of(cloth.pins[1].particles);
  ASSERT_EQ(red.size(), 4u);
  for (const auto& [particle, fraction] : red) EXPECT_NEAR(fraction, 0.5 * x_of(particle), 1e-6);
  const auto blue = shares_of(cloth.pins[2].particles);
  ASSERT_EQ(blue.size(), 3u);
  for (const auto& [particle, fraction] : blue) EXPECT_EQ(y_of(particle), 1);
  for (const auto& [particle, fraction] : shares_of(cloth.pins[3].particles))
    EXPECT_NEAR(fraction, (0.5 * x_of(particle) + 0.25 + 1) / 3, 1e-6);
  EXPECT_EQ(shares_of(cloth.weights[0].particles), red);
}

// Front and back cover the same places, so a picture over both panels would also select particles of the back.
TEST_F(ChosenParticles, OfOnePanelAreTakenInItsOwnFractions) {
  std::string pattern;
  for (const char* side : {"front", "back"})
    pattern += fmt::format(
        "[[panel]]\nname = '{0}'\nside = '{0}'\npath = 'M -0.2 0 L 0.2 0 L 0.2 0.4 L -0.2 0.4 Z'\n"
        "edges = 'hem left top right'\nposition = [0, 1]\n",
        side);
  for (const char* edge : {"left", "right"})
    pattern += fmt::format("[[seam]]\na = 'front.{0}'\nb = 'back.{0}'\n", edge);
  support::write_bytes(folder_ / "tube.toml", pattern);
  const std::string tube = "shape = 'pattern'\nedge_length = 0.05\nfile = '" + (folder_ / "tube.toml").string() + "'\n";
  const Environment environment(support::scene_of_text("[[cloth]]\nname = 'c'\n" + tube +
                                                       "pin = [{ panel = 'front', mask = '" + row_of({255, 0}) +
                                                       "', high = [1, 0.5], strength = 1 }]\n"));
  const model::Cloth& cloth = environment.model.cloths[0];
  const ClothDetails& details = environment.cloths[0];
  std::map<Index, double> expected;
  for (std::size_t t = 0; t < details.panel_of.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      // The fraction is 1 up to the middle of the left pixel, and 0 from the middle of the right pixel on.
      const Vec2 at = (details.paint_uv[t][k] + Vec2(0.2, 0)) / 0.4;
      const double fraction = std::clamp(1.5 - 2 * at.x(), 0.0, 1.0);
      if (details.panel_of[t] == 0 && at.y() < 0.5 + 1e-9 && fraction > 0.5 / 255)
        expected.emplace(cloth.mesh.topology.triangles[t][k], fraction);
    }
  const auto shares = shares_of(cloth.pins[0].particles);
  ASSERT_EQ(shares.size(), expected.size());
  ASSERT_GT(expected.size(), 10U);
  for (const auto& [particle, fraction] : expected) EXPECT_NEAR(shares.at(particle), fraction, 1e-9) << particle;
  support::expect_error(
      ExitCode::scene_invalid,
      "cloth.c.pin.0.panel: expected a panel of its pattern, such as front, got \"frnt\"; did you mean "
      "front?",
      [&] { cloth_of(tube + "pin = [{ panel = 'frnt' }]\n"); });
}

TEST_F(ChosenParticles, AreRefusedForWhatTheClothHasNot) {
  const auto refused = [&](const std::string& cloth, const std::string& words) {
    support::expect_error(ExitCode::scene_invalid, words, [&] { cloth_of(cloth); });
  };
  const std::string black = row_of({0});
  refused("particles = 3\npin = [{}, { mask = '" + black + "' }]\n",
          ":1:1: cloth.c.pin.1: expected a part that holds at least one particle, got one that holds none");
  refused(strip_with("weight = [{ vertex_group = 'waist' }]\n"),
          "cloth.c.weight.0.vertex_group: expected a mesh with groups of vertices, or bones, got one without");
  support::write_bytes(folder_ / "bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const std::string bare = "shape = 'mesh'\nfile = '" + (folder_ / "bare.obj").string() + "'\n";
  refused(bare + "pin = [{ low = [0.3, 0.3], high = [0.6, 0.6] }]\n",
          "got one that holds none between low = [0.3, 0.3] and high = [0.6, 0.6]; the nearest particle is at [0, 0]: "
          "low = [0, 0], high = [0.6, 0.6] hold it");
  refused(bare + "pin = [{ vertex_color = 'red' }]\n",
          "cloth.c.pin.0.vertex_color: expected a mesh whose vertices have colours, got none");
  refused(bare + "pin = [{ mask = '" + black + "' }]\n",
          "cloth.c.pin.0.mask: expected a mesh with texture coordinates (UVs) to lay it on, got none");
}

// Crossed triangles have a particle in the middle of each cell, between the rows.
TEST_F(ChosenParticles, OfCrossedTrianglesMayBeTheMiddleOfACell) {
  const model::Cloth cloth =
      cloth_of("shape = 'crossed_triangles'\nparticles = [4, 4]\npin = [{ low = [0.5, 0.5], high = [0.5, 0.5] }]\n");
  ASSERT_EQ(cloth.pins.size(), 1U);
  EXPECT_EQ(cloth.pins[0].particles.size(), 1U);
}

// The jacket is bent around its wearer, whose feet point against the up axis of the scene.
TEST_F(ChosenParticles, OfABentPatternAreThoseAcrossAndUpItsWearer) {
  std::vector<Vec2> with_z_up;
  for (const scene::UpAxis up : {scene::UpAxis::z, scene::UpAxis::y}) {
    scene::Scene scene = support::scene_of_text(
        "[[character]]\nname = 'she'\nsource = 'mannequin'\nedge_length = 0.05\n[[cloth]]\nname = 'jacket'\n"
        "shape = 'pattern'\nedge_length = 0.06\nfile = '" WEFT_SOURCE_DIR "/scenes/patterns/jacket.toml'\n");
    scene.up = up;
    Wearers wearers(scene);
    const std::vector<Vec2> fractions = make_cloth(scene, scene.cloths[0], wearers).details.fractions;
    if (up == scene::UpAxis::z) with_z_up = fractions;
    ASSERT_EQ(fractions.size(), with_z_up.size());
    for (std::size_t i = 0; i < fractions.size(); ++i) EXPECT_LT((fractions[i] - with_z_up[i]).norm(), 1e-6) << i;
  }
}

}  // namespace
}  // namespace weft::environment
