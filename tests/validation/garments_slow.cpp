// The shipped garments, sewn and worn by a simple body: they fit, and nothing ever intersects.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "film/garment/garment.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

constexpr int kAround = 32;

/// Cross-section of a limb or of the trunk: an ellipse around `centre` with the half axes a and b.
struct Ring {
  Vec3 centre, a, b;
};

// Writes a closed tube through rings as an OBJ file; its ends are cones.
void write_tube(const std::filesystem::path& file, const std::vector<Ring>& rings, const Vec3& begin, const Vec3& end) {
  std::ofstream out(file);
  const auto vertex = [&](const Vec3& x) { out << "v " << x.x() << " " << x.y() << " " << x.z() << "\n"; };
  vertex(begin);
  vertex(end);
  for (const Ring& ring : rings)
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      vertex(ring.centre + std::cos(angle) * ring.a + std::sin(angle) * ring.b);
    }
  const auto at = [&](std::size_t ring, int k) { return 3 + static_cast<int>(ring) * kAround + k % kAround; };
  for (int k = 0; k < kAround; ++k) {
    out << "f 1 " << at(0, k + 1) << " " << at(0, k) << "\n";
    out << "f 2 " << at(rings.size() - 1, k) << " " << at(rings.size() - 1, k + 1) << "\n";
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
      out << "f " << at(r, k) << " " << at(r, k + 1) << " " << at(r + 1, k + 1) << "\n";
      out << "f " << at(r, k) << " " << at(r + 1, k + 1) << " " << at(r + 1, k) << "\n";
    }
  }
}

// Height, half width and half depth [m] of each ring of a body of 1.75 m, with a chest of 0.88 m, a waist of 0.68 m and
// a hip of 0.94 m.
constexpr std::array<std::array<double, 3>, 16> kTrunk{{{0.77, 0.10, 0.06},
                                                        {0.80, 0.155, 0.105},
                                                        {0.86, 0.170, 0.125},
                                                        {0.95, 0.162, 0.115},
                                                        {1.01, 0.142, 0.103},
                                                        {1.07, 0.122, 0.093},
                                                        {1.12, 0.125, 0.096},
                                                        {1.17, 0.135, 0.102},
                                                        {1.25, 0.152, 0.120},
                                                        {1.30, 0.157, 0.116},
                                                        {1.34, 0.158, 0.106},
                                                        {1.39, 0.150, 0.088},
                                                        {1.42, 0.128, 0.074},
                                                        {1.445, 0.095, 0.064},
                                                        {1.465, 0.066, 0.058},
                                                        {1.56, 0.054, 0.056}}};

class Worn : public support::TestFolder {
 protected:
  // The arms point down at 45 degrees.
  std::string body() {
    std::vector<Ring> trunk;
    for (const auto& [z, a, b] : kTrunk) trunk.push_back({{0, 0, z}, {a, 0, 0}, {0, b, 0}});
    write_tube(folder_ / "trunk.obj", trunk, {0, 0, 0.76}, {0, 0, 1.58});
    std::string text = obstacle("trunk");
    for (double side : {-1.0, 1.0}) {
      const Vec3 along(side * std::numbers::sqrt2 / 2, 0, -std::numbers::sqrt2 / 2);
      const Vec3 up(side * std::numbers::sqrt2 / 2, 0, std::numbers::sqrt2 / 2), shoulder(side * 0.15, 0, 1.392);
      std::vector<Ring> arm, leg;
      for (const auto& [along_arm, r] :
           {std::pair(-0.03, 0.036), {0.0, 0.044}, {0.3, 0.036}, {0.55, 0.027}, {0.7, 0.03}})
        arm.push_back({shoulder + along_arm * along, side * r * Vec3::UnitY(), r * up});
      for (const auto& [z, r] : {std::pair(0.08, 0.036), {0.33, 0.052}, {0.46, 0.052}, {0.6, 0.068}, {0.86, 0.078}})
        leg.push_back({{side * 0.092, 0, z}, {r, 0, 0}, {0, r, 0}});
      const std::string name = side < 0 ? "right" : "left";
      write_tube(folder_ / (name + "_arm.obj"), arm, shoulder - 0.05 * along, shoulder + 0.72 * along);
      write_tube(folder_ / (name + "_leg.obj"), leg, {side * 0.092, 0, 0.06}, {side * 0.092, 0, 0.9});
      text += obstacle(name + "_arm") + obstacle(name + "_leg");
    }
    return text;
  }
  std::string obstacle(const std::string& name) const {
    return "[[obstacle]]\nname = '" + name + "'\nshape = 'mesh'\nfile = '" + (folder_ / (name + ".obj")).string() +
           "'\n";
  }

  void wear(const std::string& name) {
    const scene::Scene scene = support::scene_of_text(
        "[time]\nduration = 2.4\n" + body() + "[[cloth]]\nname = 'garment'\nshape = 'pattern'\nfile = '" +
        std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + name + ".toml'\nedge_length = 0.025\n");
    const auto frames = support::run_scene(scene);
    for (const auto& frame : frames)
      EXPECT_EQ(frame.pairs, 0U) << "frame " << frame.report.frame << ": " << frame.between;
    EXPECT_LT(frames.front().report.max_strain, 1e-9);

    const auto garment = garment::sew(garment::load_pattern(scene.cloths[0].file, "a test"), 0.025, "a test");
    const std::vector<Vec3>& x = frames.back().cloths[0];
    const auto at = [&](Index i) -> const Vec3& { return x[i]; };
    double area = 0, pattern = 0, worst = 0;
    for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) {
      const auto& [a, b, c] = garment.sheet.triangles[t];
      area += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
      pattern += mesh::rest_area(garment.sheet, t);
    }
    for (const garment::SewnSeam& seam : garment.seams) {
      double length = 0;
      for (std::size_t k = 1; k < seam.vertices.size(); ++k)
        length += (at(seam.vertices[k]) - at(seam.vertices[k - 1])).norm();
      // Lengths are chords: an arc of 0.2 m radius loses (25 mm)² / (24 · 0.04 m²) of its length, below 1e-3.
      worst = std::max(worst, std::abs(2 * length / (seam.length_a + seam.length_b) - 1));
    }
    EXPECT_NEAR(area, pattern, 0.01 * pattern);
    EXPECT_LT(worst, 0.01);
    // The garment has not fallen off the body.
    double mean = 0;
    for (const Vec3& p : x) mean += p.z() / static_cast<double>(x.size());
    EXPECT_GT(mean, 0.6);
    std::printf("%s: %zu particles, area %.4f of %.4f m², seams off by %.2f %% at most, strain %.3f, rms %.1f mm/s\n",
                name.c_str(), x.size(), area, pattern, 100 * worst, frames.back().report.max_strain,
                1e3 * frames.back().rms_speed);
  }
};

TEST_F(Worn, TheSkirtFits) {
  wear("skirt");
}
TEST_F(Worn, TheTShirtFits) {
  wear("tshirt");
}
TEST_F(Worn, TheDressFits) {
  wear("dress");
}

/// Positions of points at equal fractions of the length of a panel's edge, found by their place in the flat panel:
/// independent of the seams with which the mesh was made.
std::vector<Vec3> places_along(const garment::Pattern& pattern, const garment::Garment& garment,
                               const std::string& edge, std::size_t segments, const std::vector<Vec3>& x) {
  const auto [p, e] = pattern.find(edge);
  const garment::Panel& panel = pattern.panels[p];
  const garment::Arclength along(panel.edges[e].curves);
  std::vector<Vec3> places;
  for (std::size_t k = 0; k <= segments; ++k) {
    Vec2 flat = Eigen::Rotation2Dd(-panel.grain * std::numbers::pi / 180) *
                along.at(static_cast<double>(k) / static_cast<double>(segments));
    if (panel.side == garment::Side::back) flat.x() = -flat.x();
    for (std::size_t t = 0; t < garment.panel_of.size() && places.size() == k; ++t)
      for (std::size_t c = 0; c < 3 && places.size() == k; ++c)
        if (garment.panel_of[t] == static_cast<Index>(p) && (garment.sheet.material[t][c] - flat).norm() < 1e-9)
          places.push_back(x[garment.sheet.triangles[t][c]]);
    EXPECT_EQ(places.size(), k + 1) << edge << " has no point at " << flat.transpose();
    if (places.size() != k + 1) break;
  }
  return places;
}

/// Maximum distance between the two sides of a seam [m].
double opening(const garment::Pattern& pattern, const garment::Garment& garment, std::size_t seam,
               const std::vector<Vec3>& x) {
  const std::size_t segments = garment.seams[seam].vertices.size() - 1;
  const std::vector<Vec3> a = places_along(pattern, garment, pattern.seams[seam].a, segments, x);
  std::vector<Vec3> b = places_along(pattern, garment, pattern.seams[seam].b, segments, x);
  const auto widest = [&] {
    double distance = 0;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) distance = std::max(distance, (a[k] - b[k]).norm());
    return distance;
  };
  const double one_way = widest();
  std::ranges::reverse(b);
  return std::min(one_way, widest());
}

// Garments on the mannequin, with coarse meshes: edges of 30 mm in the cloth and of 25 mm in the body.
class OnTheMannequin : public ::testing::TestWithParam<const char*> {};

TEST_P(OnTheMannequin, FitsAtRestWithItsSeamsClosed) {
  constexpr double kSpacing = 0.03;
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 3\n[[character]]\nname = 'model'\nsource = 'mannequin'\nstance = 'rest'\nblend = 1\n"
      "edge_length = 0.025\n[[cloth]]\nname = 'garment'\nshape = 'pattern'\nfile = '" +
      std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + GetParam() + ".toml'\nedge_length = 0.03\n");
  const auto frames = support::run_scene(scene);
  for (const auto& frame : frames)
    EXPECT_EQ(frame.pairs, 0U) << "frame " << frame.report.frame << ": " << frame.between;
  EXPECT_LT(frames.back().rms_speed, 0.05);

  const garment::Pattern pattern = garment::load_pattern(scene.cloths[0].file, "a test");
  const garment::Garment garment = garment::sew(pattern, kSpacing, "a test");
  const std::vector<Vec3>& x = frames.back().cloths[0];
  const auto at = [&](Index i) -> const Vec3& { return x[i]; };
  std::vector<double> areas(pattern.panels.size()), flat(pattern.panels.size());
  for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) {
    const auto& [a, b, c] = garment.sheet.triangles[t];
    const auto panel = static_cast<std::size_t>(garment.panel_of[t]);
    areas[panel] += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
    flat[panel] += mesh::rest_area(garment.sheet, t);
  }
  double worst_area = 0, worst_seam = 0, widest = 0;
  for (std::size_t p = 0; p < areas.size(); ++p) worst_area = std::max(worst_area, std::abs(areas[p] / flat[p] - 1));
  for (std::size_t s = 0; s < garment.seams.size(); ++s) {
    const garment::SewnSeam& seam = garment.seams[s];
    double length = 0;
    for (std::size_t k = 1; k < seam.vertices.size(); ++k)
      length += (at(seam.vertices[k]) - at(seam.vertices[k - 1])).norm();
    worst_seam = std::max(worst_seam, std::abs(2 * length / (seam.length_a + seam.length_b) - 1));
    widest = std::max(widest, opening(pattern, garment, s, x));
  }
  std::printf(
      "%s: %zu particles, panels off by %.2f %%, seams by %.2f %% at most, open by %.3f mm, strain %.3f, "
      "rms %.1f mm/s\n",
      GetParam(), x.size(), 100 * worst_area, 100 * worst_seam, 1e3 * widest, frames.back().report.max_strain,
      1e3 * frames.back().rms_speed);
  EXPECT_LT(worst_area, 0.01);
  EXPECT_LT(worst_seam, 0.01);
  EXPECT_LT(widest, 1e-4);
  // The garment has not slipped down.
  double mean = 0;
  for (const Vec3& p : x) mean += p.z() / static_cast<double>(x.size());
  EXPECT_GT(mean, 0.6);
}

INSTANTIATE_TEST_SUITE_P(Worn, OnTheMannequin, ::testing::Values("skirt", "tshirt", "dress"),
                         [](const auto& garment) { return std::string(garment.param); });

}  // namespace
}  // namespace weft::simulation
