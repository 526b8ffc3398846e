// weft_panels PATTERN EDGE_LENGTH FILE.svg: draws the flat meshed panels of a sewing pattern with coloured seams, and
// prints the quality of their triangles.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/temporary_file.hpp"
#include "film/environment/wearers.hpp"
#include "film/garment/garment.hpp"
#include "film/garment/triangulation.hpp"
#include "support/mesh_measures.hpp"

namespace {

using namespace weft;

constexpr double kPixelsPerMetre = 1000, kGap = 0.06;  // between panels [m]
constexpr std::array kSeamColours{"#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

std::array<Vec2, 3> corners_of(const garment::Garment& garment, std::size_t t) {
  const auto& m = garment.sheet.material[t];
  return {m[0], m[1], m[2]};
}

/// Text with the smallest angles of all triangles, in classes of 5 degrees, and the fraction of the area in triangles
/// that are halves of squares.
std::string quality(const garment::Garment& garment, double spacing) {
  std::array<int, 12> classes{};
  double min_angle = 180, mean = 0, squares = 0, area = 0;
  const std::size_t count = garment.sheet.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    const auto corners = corners_of(garment, t);
    const double angle = support::smallest_angle({0, 1, 2}, corners), size = mesh::rest_area(garment.sheet, t);
    ++classes[std::min<std::size_t>(11, static_cast<std::size_t>(angle / 5))];
    min_angle = std::min(min_angle, angle);
    mean += angle / static_cast<double>(count);
    area += size;
    if (std::abs(angle - 45) < 1e-6 && std::abs(2 * size / (spacing * spacing) - 1) < 1e-6) squares += size;
  }
  std::string text =
      fmt::format("{} triangles, {:.0f} % of the area in squares; smallest angles: least {:.1f}, mean {:.1f} degrees;",
                  count, 100 * squares / area, min_angle, mean);
  for (std::size_t k = 0; k < classes.size(); ++k)
    if (classes[k] > 0) text += fmt::format(" {}-{}: {}", 5 * k, 5 * k + 5, classes[k]);
  return text;
}

/// Colour of each edge on a seam, by its vertices.
std::map<std::array<Index, 2>, const char*> seam_colours(const garment::Garment& garment) {
  std::map<std::array<Index, 2>, const char*> colours;
  for (std::size_t s = 0; s < garment.seams.size(); ++s) {
    const auto& v = garment.seams[s].vertices;
    for (std::size_t k = 1; k < v.size(); ++k)
      colours[{std::min(v[k - 1], v[k]), std::max(v[k - 1], v[k])}] = kSeamColours[s % kSeamColours.size()];
  }
  return colours;
}

std::string picture(const garment::Pattern& pattern, const garment::Garment& garment) {
  const auto colours = seam_colours(garment);
  std::string body;
  double left = kGap, top = kGap, width = 0, height = 0;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    Vec2 low = Vec2::Constant(1e9), high = -low;
    for (std::size_t t = 0; t < garment.panel_of.size(); ++t)
      if (garment.panel_of[t] == static_cast<Index>(p))
        for (const Vec2& c : corners_of(garment, t)) low = low.cwiseMin(c), high = high.cwiseMax(c);
    if (p % 2 == 0) left = kGap, top += height + (p > 0 ? kGap : 0), height = 0;  // two panels per row
    const auto place = [&](const Vec2& c) {
      return fmt::format("{:.0f} {:.0f}", kPixelsPerMetre * (left + c.x() - low.x()),
                         kPixelsPerMetre * (top + kGap + high.y() - c.y()));
    };
    std::string mesh, seams;
    for (std::size_t t = 0; t < garment.panel_of.size(); ++t) {
      if (garment.panel_of[t] != static_cast<Index>(p)) continue;
      const auto corners = corners_of(garment, t);
      mesh += fmt::format("M{}L{}L{}Z", place(corners[0]), place(corners[1]), place(corners[2]));
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = garment.sheet.triangles[t][k], b = garment.sheet.triangles[t][(k + 1) % 3];
        if (const auto found = colours.find({std::min(a, b), std::max(a, b)}); found != colours.end())
          seams += fmt::format("<path d='M{}L{}' stroke='{}'/>\n", place(corners[k]), place(corners[(k + 1) % 3]),
                               found->second);
      }
    }
    body +=
        fmt::format("<path d='{}' stroke='#555' stroke-width='0.7' fill='#f2efe9' stroke-linejoin='round'/>\n", mesh);
    body += fmt::format("<g stroke-width='4' stroke-linecap='round'>\n{}</g>\n", seams);
    body += fmt::format("<text x='{:.0f}' y='{:.0f}'>{}</text>\n", kPixelsPerMetre * left,
                        kPixelsPerMetre * (top + 0.5 * kGap), pattern.panels[p].name);
    left += high.x() - low.x() + kGap;
    width = std::max(width, left);
    height = std::max(height, high.y() - low.y() + kGap);
  }
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' font-family='sans-serif' font-size='30'>\n"
      "<rect width='{0:.0f}' height='{1:.0f}' fill='white'/>\n{2}</svg>\n",
      kPixelsPerMetre * width, kPixelsPerMetre * (top + height + kGap), body);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 4) {
    fmt::print(stderr, "usage: weft_panels PATTERN EDGE_LENGTH FILE.svg\n");
    return 2;
  }
  const double spacing = std::stod(arguments[2]);
  const garment::Pattern pattern = garment::load_pattern(arguments[1], arguments[1]);
  // Only the flat panels are drawn. They do not depend on the wearer, so the mannequin of the default size serves.
  scene::Scene scene;
  scene.characters.emplace_back().source = scene::Mannequin{};
  environment::Wearers wearers(scene);
  const garment::Wearer* wearer = pattern.has_bent_panels() ? &wearers.of(scene::Cloth{}, arguments[1]) : nullptr;
  const garment::Garment garment = garment::sew(pattern, spacing, arguments[1], wearer);
  write_file(arguments[3], picture(pattern, garment));
  fmt::print("{}: {}\n", arguments[1], quality(garment, spacing));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
