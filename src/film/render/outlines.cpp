#include "film/render/outlines.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "film/render/depth_raster.hpp"
#include "film/render/painted_mesh.hpp"
#include "film/render/pixels.hpp"

namespace weft::render {
namespace {

constexpr int kWordBits = 64;

// Offsets of the samples from the pixel's lower left corner: Direct3D's pattern of 16 samples,
// shifted by 1/32. No two samples share one of the 16 rows or columns, so that nearly horizontal
// and vertical edges also have 17 levels of coverage.
constexpr float kOffsetX[] = {19 / 32.f, 15 / 32.f, 11 / 32.f, 25 / 32.f, 7 / 32.f, 21 / 32.f, 27 / 32.f, 23 / 32.f,
                              13 / 32.f, 17 / 32.f, 9 / 32.f,  5 / 32.f,  1 / 32.f, 31 / 32.f, 29 / 32.f, 3 / 32.f};
constexpr float kOffsetY[] = {19 / 32.f, 11 / 32.f, 21 / 32.f, 15 / 32.f, 13 / 32.f, 27 / 32.f, 23 / 32.f, 7 / 32.f,
                              29 / 32.f, 3 / 32.f,  5 / 32.f,  25 / 32.f, 17 / 32.f, 9 / 32.f,  31 / 32.f, 1 / 32.f};

// Tangent of the smallest crease angle that is antialiased. In the picture of a plane, 1 / distance is linear. At the
// border of a surface, 1 / distance has a step; at a fold, its slope changes. Beside a face seen head-on, this change
// [per pixel], relative to 1 / distance, is the tangent of the crease angle times the angle of a pixel.
constexpr double kMinCreaseTangent = 0.4;
// Tolerance [multiples of `kink_`] within which the point that a pixel shows counts as being in the plane of a sample's
// triangle. The sample then takes the colour of this pixel.
constexpr float kSamePlane = 0.25f;

/// Edge function: twice the signed area of the triangle of a, b and a point; positive if the point is left of the edge
/// from a to b. The function of the edge from b to a has exactly the negative value, because both are computed from the
/// same end. Thus at least one of the two triangles of an edge covers each sample near it.
struct Edge {
  float along, across, from_x, from_y;

  template <class Vertex>
  Edge(const Vertex& a, const Vertex& b) {
    const bool swapped = a.x != b.x ? a.x > b.x : a.y > b.y;
    const Vertex &p = swapped ? b : a, &q = swapped ? a : b;
    const float sign = swapped ? -1 : 1;
    along = sign * (p.y - q.y);
    across = sign * (q.x - p.x);
    from_x = p.x;
    from_y = p.y;
  }
  float at(float x, float y) const { return along * (x - from_x) + across * (y - from_y); }
};

// The opacity threshold of sample s is (kThresholdOrder[s] + 1/2) / 16. Consecutive samples have very different
// thresholds.
constexpr int kThresholdOrder[] = {0, 8, 12, 4, 10, 2, 6, 14, 9, 1, 5, 13, 3, 11, 15, 7};

/// The opacity of a triangle at points of the rendered picture. If an attribute is linear over the triangle, then
/// attribute / distance is linear over the rendered picture (perspective-correct interpolation).
class HoleTest {
 public:
  template <class Vertex>
  HoleTest(const Opacity& opacity, const std::array<Vertex, 3>& corners, const std::array<Eigen::Vector2f, 3>& places)
      : opacity_(&opacity), x_(corners[0].x), y_(corners[0].y) {
    const auto over = [&](int i) -> Eigen::Vector2f { return corners[i].nearness * places[i]; };
    first_ = over(0);
    const float b_x = corners[1].x - x_, b_y = corners[1].y - y_, c_x = corners[2].x - x_, c_y = corners[2].y - y_;
    const float area = b_x * c_y - c_x * b_y;
    const Eigen::Vector2f b = over(1) - first_, c = over(2) - first_;
    if (!(std::abs(area) > 0)) return;
    along_x_ = (c_y * b - b_y * c) / area;
    along_y_ = (b_x * c - c_x * b) / area;
    // Texels per pixel: the root of the triangle's area in texels over its area in pixels.
    const Eigen::Vector2f q = (places[1] - places[0]).cwiseProduct(opacity.size()),
                          r = (places[2] - places[0]).cwiseProduct(opacity.size());
    footprint_ = std::sqrt(std::abs(q.x() * r.y() - q.y() * r.x()) / std::abs(area));
  }

  float opacity(float x, float y, float nearness) const {
    return opacity_->at((first_ + (x - x_) * along_x_ + (y - y_) * along_y_) / nearness, footprint_);
  }

 private:
  const Opacity* opacity_;
  float x_, y_, footprint_ = 1;
  Eigen::Vector2f first_, along_x_ = Eigen::Vector2f::Zero(), along_y_ = Eigen::Vector2f::Zero();
};

}  // namespace

Outlines::Outlines(int width, int height)
    : width_(width),
      height_(height),
      words_((width + kWordBits - 1) / kWordBits),
      bits_(static_cast<std::size_t>(words_) * height),
      first_(bits_.size()) {}

/// Sets the bits of the pixels in `area` that have a neighbour with another surface, or at which the surface folds.
void Outlines::find_outlines(std::span<const Seen> seen, const PixelArea& area) {
  std::fill(bits_.begin(), bits_.end(), Bits{0});
  // `nearness_` holds three rows of 1 / distance at a time, with a padding column on either side.
  const std::size_t stride = static_cast<std::size_t>(width_) + 2;
  nearness_.resize(3 * stride);
  const auto load = [&](int row) {
    const Seen* from = seen.data() + static_cast<std::size_t>(std::clamp(row, 0, height_ - 1)) * width_;
    float* to = nearness_.data() + static_cast<std::size_t>((row + 3) % 3) * stride + 1;
    for (int x = 0; x < width_; ++x) to[x] = 1 / from[x].distance;
    to[-1] = to[0];
    to[width_] = to[width_ - 1];
    return to;
  };
  load(area.y - 1);
  load(area.y);
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(width_));
  const int left = area.x, right = area.x + area.width;
  for (int y = area.y; y < area.y + area.height; ++y) {
    load(y + 1);
    const auto row = [&](int k) { return nearness_.data() + static_cast<std::size_t>((k + 3) % 3) * stride + 1; };
    const float *below = row(y - 1), *here = row(y), *above = row(y + 1);
    const Seen* own = seen.data() + static_cast<std::size_t>(y) * width_;
    const Seen *lower = y > 0 ? own - width_ : own, *upper = y + 1 < height_ ? own + width_ : own;
    for (int x = left; x < right; ++x) {
      const float across = std::abs(here[x - 1] + here[x + 1] - 2 * here[x]);
      const float along = std::abs(below[x] + above[x] - 2 * here[x]);
      flags[x] = (std::max(across, along) > kink_ * here[x]) | (own[x].surface != lower[x].surface) |
                 (own[x].surface != upper[x].surface);
    }
    for (int x = std::max(left, 1); x < right; ++x) flags[x] |= own[x].surface != own[x - 1].surface;
    for (int x = left; x < std::min(right, width_ - 1); ++x) flags[x] |= own[x].surface != own[x + 1].surface;
    Bits* bits = bits_.data() + static_cast<std::size_t>(y) * words_;
    for (int x = left; x < right; ++x) bits[x / kWordBits] |= Bits{flags[x]} << (x % kWordBits);
  }
}

/// Numbers the pixels with a set bit, and allocates their samples.
void Outlines::number_samples() {
  for (std::size_t word = 0; word < bits_.size(); ++word) {
    first_[word] = static_cast<int>(pixels_.size());
    const int y = static_cast<int>(word) / words_, x = static_cast<int>(word) % words_ * kWordBits;
    for (Bits left = bits_[word]; left; left &= left - 1) pixels_.push_back({x + std::countr_zero(left), y});
  }
  samples_.assign(pixels_.size(), {});
}

Outlines::Vertex Outlines::to_picture(const Eigen::Vector4d& clip) const {
  const double nearness = 1 / clip.w();
  return {static_cast<float>((0.5 + 0.5 * clip.x() * nearness) * width_),
          static_cast<float>((0.5 + 0.5 * clip.y() * nearness) * height_), static_cast<float>(nearness)};
}

/// Writes the triangle to each sample that it covers if it is nearer than the surface that the sample has shown so far,
/// and if `shows(x, y, nearness, sample)` is true.
template <class Shows>
void Outlines::sample(const Vertex& a, const Vertex& b, const Vertex& c, float surface, const Shows& shows) {
  const auto [x_min, x_max] = std::minmax({a.x, b.x, c.x});
  const auto [y_min, y_max] = std::minmax({a.y, b.y, c.y});
  if (!(x_max >= 0 && y_max >= 0 && x_min < static_cast<float>(width_) && y_min < static_cast<float>(height_))) return;
  const int x0 = static_cast<int>(std::max(0.0f, x_min)), y0 = static_cast<int>(std::max(0.0f, y_min));
  const int x1 = static_cast<int>(std::min(x_max, static_cast<float>(width_ - 1)));
  const int y1 = static_cast<int>(std::min(y_max, static_cast<float>(height_ - 1)));

  // Bits of the columns x0 to x1 in word `word`.
  const auto columns = [&](int word) {
    const int from = std::max(x0 - word * kWordBits, 0), to = std::min(x1 - word * kWordBits, kWordBits - 1);
    return (~Bits{0} << from) & (~Bits{0} >> (kWordBits - 1 - to));
  };
  const int word0 = x0 / kWordBits, word1 = x1 / kWordBits;
  int y = y0;
  const auto row_has_outlines = [&](int row) {
    for (int word = word0; word <= word1; ++word) {
      if (bits_[static_cast<std::size_t>(row) * words_ + word] & columns(word)) return true;
    }
    return false;
  };
  while (y <= y1 && !row_has_outlines(y)) ++y;
  if (y > y1) return;

  const Edge edges[] = {{a, b}, {b, c}, {c, a}};
  const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (!(std::abs(area) > 0)) return;
  // If the triangle is seen from behind, all edge functions have the opposite sign.
  const float side = area > 0 ? 1.0f : -1.0f, shown = area > 0 ? surface : surface + 0.5f;
  const float b_a = b.nearness - a.nearness, c_a = c.nearness - a.nearness;
  const float slope_x = (b_a * (c.y - a.y) - c_a * (b.y - a.y)) / area;
  const float slope_y = (c_a * (b.x - a.x) - b_a * (c.x - a.x)) / area;
  // Slivers have extreme slopes, so interpolated values are clamped to the range of the corners.
  const auto [min_nearness, max_nearness] = std::minmax({a.nearness, b.nearness, c.nearness});

  float edge_offsets[3][kSamples], nearness_offsets[kSamples];
  for (int s = 0; s < kSamples; ++s) {
    for (int e = 0; e < 3; ++e) edge_offsets[e][s] = edges[e].along * kOffsetX[s] + edges[e].across * kOffsetY[s];
    nearness_offsets[s] = slope_x * kOffsetX[s] + slope_y * kOffsetY[s];
  }
  for (; y <= y1; ++y) {
    for (int word = word0; word <= word1; ++word) {
      const std::size_t at = static_cast<std::size_t>(y) * words_ + word;
      for (Bits left = bits_[at] & columns(word); left; left &= left - 1) {
        const int bit = std::countr_zero(left);
        Samples& samples = samples_[first_[at] + std::popcount(bits_[at] & ((Bits{1} << bit) - 1))];
        const float px = static_cast<float>(word * kWordBits + bit), py = static_cast<float>(y);
        float corner[3];
        for (int e = 0; e < 3; ++e) corner[e] = edges[e].at(px, py);
        const float corner_nearness = a.nearness + slope_x * (px - a.x) + slope_y * (py - a.y);
        for (int s = 0; s < kSamples; ++s) {
          const float e0 = side * (corner[0] + edge_offsets[0][s]), e1 = side * (corner[1] + edge_offsets[1][s]);
          const float e2 = side * (corner[2] + edge_offsets[2][s]);
          const float near = std::min(std::max(corner_nearness + nearness_offsets[s], min_nearness), max_nearness);
          bool wins = (std::min(e0, std::min(e1, e2)) >= 0) & (near > samples.nearness[s]);
          if constexpr (!std::is_same_v<Shows, AlwaysOpaque>)
            wins = wins && shows(px + kOffsetX[s], py + kOffsetY[s], near, s);
          samples.nearness[s] = wins ? near : samples.nearness[s];
          samples.slope_x[s] = wins ? slope_x : samples.slope_x[s];
          samples.slope_y[s] = wins ? slope_y : samples.slope_y[s];
          samples.surface[s] = wins ? shown : samples.surface[s];
        }
      }
    }
  }
}

void Outlines::sample(const DrawnMesh& mesh, float surface, const View& view) {
  clip_.clear();
  vertices_.clear();
  for (const Vec3& position : mesh.positions) {
    clip_.push_back(view.clip_from_world * position.homogeneous());
    vertices_.push_back(to_picture(clip_.back()));
  }
  if (mesh.holes) return sample_with_holes(mesh, surface, view);
  for (const auto& [a, b, c] : mesh.triangles) {
    if (std::min({clip_[a].w(), clip_[b].w(), clip_[c].w()}) >= view.near) {
      sample(vertices_[a], vertices_[b], vertices_[c], surface);
    } else {
      clip_near({clip_[a], clip_[b], clip_[c]}, [&](const auto& p, const auto& q, const auto& r) {
        sample(to_picture(p), to_picture(q), to_picture(r), surface);
      });
    }
  }
}

/// Samples the triangles of a mesh with holes. Each sample has its own opacity threshold, so that
/// the fraction of samples that show the surface is its opacity, rounded to sixteenths.
void Outlines::sample_with_holes(const DrawnMesh& mesh, float surface, const View& view) {
  for (std::size_t r = 0; r < mesh.holes->ranges().size(); ++r) {
    const PaintedRange& range = mesh.holes->ranges()[r];
    const Opacity* opacity = mesh.holes->opacity(r);
    const auto sample_triangle = [&](const std::array<Vertex, 3>& corners,
                                     const std::array<Eigen::Vector2f, 3>& places) {
      if (opacity == nullptr) return sample(corners[0], corners[1], corners[2], surface);
      const HoleTest test(*opacity, corners, places);
      sample(corners[0], corners[1], corners[2], surface, [&](float x, float y, float nearness, int s) {
        return test.opacity(x, y, nearness) > (static_cast<float>(kThresholdOrder[s]) + 0.5f) / kSamples;
      });
    };
    // Clip coordinates and place of a vertex.
    using Corner = Eigen::Matrix<double, 6, 1>;
    const auto corner = [&](Index v) -> Corner {
      return (Corner() << clip_[v], mesh.holes->place(r, v).cast<double>()).finished();
    };
    for (const auto& [a, b, c] : mesh.triangles.subspan(range.first, range.count)) {
      if (std::min({clip_[a].w(), clip_[b].w(), clip_[c].w()}) >= view.near) {
        sample_triangle({vertices_[a], vertices_[b], vertices_[c]},
                        {mesh.holes->place(r, a), mesh.holes->place(r, b), mesh.holes->place(r, c)});
      } else {
        clip_near(std::array{corner(a), corner(b), corner(c)}, [&](const Corner& p, const Corner& q, const Corner& t) {
          sample_triangle({to_picture(p.head<4>()), to_picture(q.head<4>()), to_picture(t.head<4>())},
                          {p.tail<2>().cast<float>(), q.tail<2>().cast<float>(), t.tail<2>().cast<float>()});
        });
      }
    }
  }
}

/// If the eye is above the floor, writes the floor to all samples that show nothing nearer.
void Outlines::sample_floor(const Floor& floor, const View& view) {
  const double height = floor.normal.dot(view.eye - floor.point);
  if (height <= 0) return;
  // The ray through point (i, j) of the picture [pixels] descends towards the floor by corner + x i + y j, per metre
  // along the view axis.
  const double x = -2 * view.tan_half_width / width_ * floor.normal.dot(view.axes.right);
  const double y = -2 * view.tan_half_height / height_ * floor.normal.dot(view.axes.up);
  const double corner = -floor.normal.dot(view.axes.forward) - 0.5 * (x * width_ + y * height_);
  for (std::size_t slot = 0; slot < pixels_.size(); ++slot) {
    Samples& samples = samples_[slot];
    const double base = corner + x * pixels_[slot].x + y * pixels_[slot].y;
    for (int s = 0; s < kSamples; ++s) {
      const float near = static_cast<float>((base + x * kOffsetX[s] + y * kOffsetY[s]) / height);
      const bool wins = near > samples.nearness[s];
      samples.nearness[s] = wins ? near : samples.nearness[s];
      samples.slope_x[s] = wins ? static_cast<float>(x / height) : samples.slope_x[s];
      samples.slope_y[s] = wins ? static_cast<float>(y / height) : samples.slope_y[s];
      samples.surface[s] = wins ? static_cast<float>(kFloor) : samples.surface[s];
    }
  }
}

/// The source of each sample: the pixel from which the sample takes its colour. If the sample's own
/// pixel shows the same surface, in the plane of the sample's triangle and on the same side of a
/// crease, this pixel is the source. Else, the source is the pixel, among the own pixel and its
/// eight neighbours, whose point on the same surface is nearest to this plane; an own pixel on the
/// other side of a crease is excluded. Thus, samples on each side of an edge take colours from
/// their own side. If no pixel qualifies, the own pixel is the source.
std::array<std::size_t, Outlines::kSamples> Outlines::find_sources(std::size_t slot, std::span<const Seen> seen) const {
  const int x = pixels_[slot].x, y = pixels_[slot].y;
  const Samples& samples = samples_[slot];
  const int x0 = std::max(x - 1, 0), x1 = std::min(x + 1, width_ - 1);
  const int y0 = std::max(y - 1, 0), y1 = std::min(y + 1, height_ - 1);
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j) * width_ + i; };
  // Finds the slopes of the triangle that the pixel's centre shows: those of the sample on the same surface whose plane
  // is nearest to the point at the centre. If a crease passes close to the centre, the planes of both sides are near,
  // but the centre shows only one of them.
  const Seen& own = seen[index(x, y)];
  float min_own_offset = 1e9f, own_slope_x = 0, own_slope_y = 0;
  for (int s = 0; s < kSamples; ++s) {
    const float right = 0.5f - kOffsetX[s], up = 0.5f - kOffsetY[s];
    const float nearness = samples.nearness[s] + samples.slope_x[s] * right + samples.slope_y[s] * up;
    const float off = std::abs(own.distance * nearness - 1);
    if (samples.surface[s] != own.surface || off >= min_own_offset) continue;
    min_own_offset = off;
    own_slope_x = samples.slope_x[s];
    own_slope_y = samples.slope_y[s];
  }
  std::array<std::size_t, kSamples> sources;
  std::size_t chosen = 0;
  for (int s = 0; s < kSamples; ++s) {
    const float surface = samples.surface[s], slope_x = samples.slope_x[s], slope_y = samples.slope_y[s];
    // Most samples show the same triangle as the sample before, and thus have the same source.
    if (s == 0 || surface != samples.surface[s - 1] || slope_x != samples.slope_x[s - 1] ||
        slope_y != samples.slope_y[s - 1]) {
      // Distance of the point that pixel (i, j) shows from the sample's plane along the view axis,
      // relative to the distance from the eye. 1e9 if the pixel shows another surface than the
      // sample; 0 if both show the backdrop.
      const auto off_plane = [&](int i, int j) {
        const Seen& there = seen[index(i, j)];
        if (there.surface != surface) return 1e9f;
        const float right = static_cast<float>(i - x) + 0.5f - kOffsetX[s];
        const float up = static_cast<float>(j - y) + 0.5f - kOffsetY[s];
        const float nearness = samples.nearness[s] + slope_x * right + slope_y * up;
        return surface < kFloor ? 0.0f : std::abs(there.distance * nearness - 1);
      };
      chosen = index(x, y);
      const float slope_change =
          std::max(std::abs(slope_x - own_slope_x), std::abs(slope_y - own_slope_y)) * own.distance;
      const bool beyond_crease = surface == own.surface && slope_change > kink_;
      float min_offset = beyond_crease ? 1e9f : off_plane(x, y);
      if (min_offset > kSamePlane * kink_) {
        for (int j = y0; j <= y1; ++j) {
          for (int i = x0; i <= x1; ++i) {
            if (beyond_crease && i == x && j == y) continue;
            const float off = off_plane(i, j);
            if (off >= min_offset) continue;
            min_offset = off;
            chosen = index(i, j);
          }
        }
      }
    }
    sources[s] = chosen;
  }
  return sources;
}

void Outlines::antialias(std::span<const Seen> seen, std::span<const DrawnMesh> meshes,
                         const std::optional<Floor>& floor, const View& view, const PixelArea& area,
                         std::span<std::uint64_t> picture) {
  pixels_.clear();
  if (area.width <= 0 || area.height <= 0) return;
  kink_ = static_cast<float>(kMinCreaseTangent * 2 * view.tan_half_height / height_);
  find_outlines(seen, area);
  number_samples();
  for (std::size_t i = 0; i < meshes.size(); ++i) sample(meshes[i], static_cast<float>(kFirstSurface + i), view);
  if (floor) sample_floor(*floor, view);
  // This loop computes all pixels before the next one writes them, because each pixel reads its neighbours.
  resolved_.clear();
  for (std::size_t slot = 0; slot < pixels_.size(); ++slot) {
    std::uint64_t sums[3] = {}, mean = 0;
    for (const std::size_t source : find_sources(slot, seen))
      for (int channel = 0; channel < 3; ++channel) sums[channel] += picture[source] >> (16 * channel) & 0xFFFF;
    for (int channel = 0; channel < 3; ++channel) mean |= (sums[channel] + kSamples / 2) / kSamples << (16 * channel);
    resolved_.push_back(mean);
  }
  for (std::size_t slot = 0; slot < pixels_.size(); ++slot) {
    picture[static_cast<std::size_t>(pixels_[slot].y) * width_ + pixels_[slot].x] = resolved_[slot];
  }
}

void Outlines::extract_surfaces(std::span<const Seen> seen, std::span<const std::uint64_t> unsmoothed,
                                std::vector<Eigen::Vector4f>& surfaces) const {
  const auto color = [&](std::size_t pixel) { return Eigen::Vector4f(linear_of(unsmoothed[pixel]).homogeneous()); };
  surfaces.assign(seen.size(), Eigen::Vector4f::Zero());
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i].surface >= kFirstSurface) surfaces[i] = color(i);
  for (std::size_t slot = 0; slot < pixels_.size(); ++slot) {
    Eigen::Vector4f& pixel = surfaces[static_cast<std::size_t>(pixels_[slot].y) * width_ + pixels_[slot].x];
    pixel.setZero();
    const auto sources = find_sources(slot, seen);
    for (int s = 0; s < kSamples; ++s)
      if (samples_[slot].surface[s] >= kFirstSurface) pixel += color(sources[s]) / kSamples;
  }
}

}  // namespace weft::render
