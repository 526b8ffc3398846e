#include "render/bounced_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/color.hpp"
#include "render/drawing_time.hpp"

namespace weft::render {
namespace {

using Eigen::Vector3f;

constexpr double kMarginRatio = 0.35;         // margin around the subjects, relative to their largest side
constexpr int kFadeCells = 2;                 // cells at each side over which the light fades to zero
constexpr float kMinCellsAboveFloor = 0.25f;  // minimum height of a sampled point above the floor [cells]
constexpr float kMinLight = 1e-3f;            // patches with less light are ignored
constexpr std::size_t kMaxSampledTriangles =
    6000;                       // maximum of sampled triangles per surface; in finer surfaces each stands for several
constexpr int kMaxPieces = 16;  // per edge of a triangle larger than a cell

/// Accumulates the surfaces in one cell that have about the same normal.
struct PatchSum {
  Vector3f position = Vector3f::Zero(), normal = Vector3f::Zero(), light = Vector3f::Zero(), color = Vector3f::Zero();
  float area = 0;
};

class PatchGrid {
 public:
  explicit PatchGrid(const BounceGrid& grid) : grid_(grid), sums_(6 * grid.size()), blocked_area_(grid.size(), 0.0f) {}

  void add(const Vector3f& position, const Vector3f& normal, float area, const Vector3f& color, const Vector3f& light) {
    const int cell = cell_at(position);
    if (cell < 0) return;
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const int side = 2 * axis + (normal[axis] < 0 ? 1 : 0);
    PatchSum& sum_here = sums_[6 * static_cast<std::size_t>(cell) + static_cast<std::size_t>(side)];
    sum_here.position += area * position;
    sum_here.normal += area * normal;
    sum_here.light += area * light.cwiseProduct(color);
    sum_here.color += area * color;
    sum_here.area += area;
  }

  /// Registers surface that blocks light.
  void add_blocker(const Vector3f& position, float area) {
    if (const int cell = cell_at(position); cell >= 0) blocked_area_[static_cast<std::size_t>(cell)] += area;
  }

  /// Fraction of light that travels from one point to another. Blockers close to either end are ignored.
  float transmittance(const Vector3f& from, const Vector3f& to) const {
    constexpr float kFrom = 1.2f, kTo = 0.8f;  // cells left out at the ends
    const Vector3f way = to - from;
    const float length = way.norm() / grid_.cell;
    float left = 1;
    for (float gone = kFrom; gone < length - kTo && left > 0.02f; gone += 0.8f)
      if (const int cell = cell_at(from + gone / length * way); cell >= 0)
        left *= std::max(1 - blocked_area_[static_cast<std::size_t>(cell)] / (grid_.cell * grid_.cell), 0.0f);
    return left;
  }

  std::vector<LitPatch> patches() const {
    std::vector<LitPatch> list;
    for (const PatchSum& sum_here : sums_) {
      if (sum_here.normal.squaredNorm() == 0) continue;
      list.push_back({sum_here.position / sum_here.area, sum_here.normal.normalized(), sum_here.area,
                      sum_here.light / sum_here.area, sum_here.color / sum_here.area});
    }
    return list;
  }

 private:
  int cell_at(const Vector3f& position) const {
    const Eigen::Array3i at = ((position - grid_.first).array() / grid_.cell + 0.5f).floor().cast<int>();
    if ((at < 0).any() || (at >= grid_.counts).any()) return -1;
    return (at.z() * grid_.counts.y() + at.y()) * grid_.counts.x() + at.x();
  }

  BounceGrid grid_;
  std::vector<PatchSum> sums_;
  std::vector<float> blocked_area_;  // area in each cell [m²]
};

using Lanes = Eigen::Array<float, 8, 1>;
constexpr int kLanes = 8;

/// Light from a patch at eight points, as if it arrived at right angles: the form factor of a disc, valid at all
/// distances, A cos cos' / (pi d^2 + A), without the receiver's cosine and divided by d. The caller multiplies by
/// dot(n, w); `w` returns the vector to the patch.
Lanes light_factor(const LitPatch& patch, const std::array<Lanes, 3>& at, std::array<Lanes, 3>& w) {
  for (int k = 0; k < 3; ++k) w[k] = patch.position[k] - at[k];
  const Lanes d_sq = w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + 1e-9f;
  const Lanes facing = -(w[0] * patch.normal[0] + w[1] * patch.normal[1] + w[2] * patch.normal[2]);
  return patch.area * facing.max(0.0f) / (d_sq * (std::numbers::pi_v<float> * d_sq + patch.area));
}

/// Adds the environment light that reaches the patches past `before`, minus the deficit of the shaded floor. If `full`
/// is false, adds only the occluded part of the environment light, as a negative value.
void light_from_around(std::span<LitPatch> patches, std::span<const LitPatch> before, std::span<const LitPatch> floor,
                       const Irradiance& around, bool full) {
  drawing_for(patches.size(), std::size_t{kLanes}, [&](std::size_t begin, std::size_t end) {
    std::array<Lanes, 3> at, n, w;
    for (int lane = 0; lane < kLanes; ++lane) {
      const LitPatch& patch = patches[std::min(begin + static_cast<std::size_t>(lane), end - 1)];
      for (int k = 0; k < 3; ++k) at[k][lane] = patch.position[k], n[k][lane] = patch.normal[k];
    }
    Lanes hidden = Lanes::Zero();
    for (const LitPatch& patch : before) {
      const Lanes factor = light_factor(patch, at, w);
      hidden += factor * (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]).max(0.0f);
    }
    std::array<Lanes, 3> missing{Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
    for (const LitPatch& patch : floor) {
      const Lanes factor = light_factor(patch, at, w),
                  taken = factor * (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]).max(0.0f);
      for (int color = 0; color < 3; ++color) missing[color] += taken * patch.light[color];
    }
    for (std::size_t i = begin; i < end; ++i) {
      const auto lane = static_cast<Eigen::Index>(i - begin);
      const float open = std::max(1 - hidden[lane], 0.0f);
      const Vector3f sky = render::at(around, patches[i].normal.cast<double>()).cast<float>();
      const Vector3f deficit(missing[0][lane], missing[1][lane], missing[2][lane]);
      const Vector3f light = full ? Vector3f((open * sky + deficit).cwiseMax(0.0f)) : Vector3f((open - 1) * sky);
      patches[i].light += light.cwiseProduct(patches[i].color);
    }
  });
}

/// Colours of both sides for cloth, of the front for solids.
struct Colors {
  Vector3f front, back;
  bool two_sided;
};

void add_triangle(PatchGrid& grid_sums, const std::array<Vector3f, 3>& corners, float weight, const Colors& colors,
                  float cell, const ShadowMaps& shadows) {
  const Vector3f along = corners[1] - corners[0], across = corners[2] - corners[0], normal_sized = along.cross(across);
  const float twice_area = normal_sized.norm();
  if (!(twice_area > 0)) return;
  const Vector3f normal = normal_sized / twice_area;
  const float longest = std::max({along.norm(), across.norm(), (across - along).norm()});
  const int pieces = std::clamp(static_cast<int>(std::ceil(longest / (0.7f * cell))), 1, kMaxPieces);
  const float share = 1 / static_cast<float>(pieces), area = 0.5f * twice_area * share * share * weight;
  // Centres of the small triangles: upright ones (even k) and inverted ones between them.
  for (int row = 0; row < pieces; ++row) {
    for (int k = 0; k < 2 * (pieces - row) - 1; ++k) {
      const float third = k % 2 == 0 ? 1.0f / 3 : 2.0f / 3;
      const Vector3f at = corners[0] + share * ((static_cast<float>(k >> 1) + third) * along +
                                                (static_cast<float>(row) + third) * across);
      grid_sums.add_blocker(at, area);
      grid_sums.add(at, normal, area, colors.front, shadows.light_on(at, normal, true));
      if (colors.two_sided) grid_sums.add(at, -normal, area, colors.back, shadows.light_on(at, -normal, true));
    }
  }
}

/// Adds the deficit of shaded floor, relative to the uniform light from below that all surfaces receive.
void add_floor(PatchGrid& grid_sums, const BounceGrid& grid, const Floor& floor, const Vector3f& color,
               const ShadowMaps& shadows) {
  const Vector3f n = floor.normal.cast<float>();
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float area = grid.cell * grid.cell / (4 * std::abs(n[axis]));
  for (int j = 0; j < 2 * grid.counts[v]; ++j) {
    for (int i = 0; i < 2 * grid.counts[u]; ++i) {
      Vector3f at = grid.first;
      at[u] += grid.cell * (0.5f * static_cast<float>(i) - 0.25f);
      at[v] += grid.cell * (0.5f * static_cast<float>(j) - 0.25f);
      at[axis] += n.dot(floor.point.cast<float>() - at) / n[axis];
      grid_sums.add(at, n, area, color, shadows.light_on(at, n, true) - shadows.light_on(at, n, false));
    }
  }
}

bool is_dark(const LitPatch& patch) {
  return patch.light.cwiseAbs().maxCoeff() < kMinLight;
}

/// Offset of one of the 2x2x2 cells of a block.
Eigen::Array3i offset_in_block(int lane) {
  return {lane & 1, lane >> 1 & 1, lane >> 2};
}

/// 1 inside, falling to 0 in the outermost cells.
float fade(int at, int count) {
  return std::clamp(static_cast<float>(std::min(at, count - 1 - at)) / kFadeCells, 0.0f, 1.0f);
}

}  // namespace

BounceGrid::BounceGrid(const Box3& subjects, int cell_count) {
  const Vec3 size = subjects.sizes() + Vec3::Constant(2 * kMarginRatio * subjects.sizes().maxCoeff() + 1e-3);
  const double wanted = std::cbrt(size.prod() / cell_count);
  const double side = std::exp2(std::ceil(8 * std::log2(wanted)) / 8);
  const Vec3 low = ((subjects.center() - 0.5 * size) / side).array().floor() * side;
  const Vec3 high = subjects.center() + 0.5 * size;
  first = low.cast<float>();
  cell = static_cast<float>(side);
  counts = ((high - low) / side).array().ceil().cast<int>() + 1;
  counts += counts.unaryExpr([](int count) { return count % 2; });
}

Vector3f BounceGrid::middle(const Eigen::Array3i& place, const std::optional<Floor>& floor) const {
  Vector3f at = first + cell * place.cast<float>().matrix();
  if (!floor) return at;
  const Vector3f n = floor->normal.cast<float>();
  return at + std::max(n.dot(floor->point.cast<float>() - at) + kMinCellsAboveFloor * cell, 0.0f) * n;
}

std::vector<Eigen::Vector4f> gather(const BounceGrid& grid, std::span<const LitPatch> patches,
                                    const std::optional<Floor>& floor,
                                    const std::function<float(const LitPatch&, const Vector3f&)>& passes) {
  const Eigen::Array3i blocks = grid.counts / 2;
  std::vector<Eigen::Vector4f> light(6 * grid.size(), Eigen::Vector4f::Zero());
  drawing_for(static_cast<std::size_t>(blocks.prod()), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      const auto number = static_cast<int>(block);
      const Eigen::Array3i corner(2 * (number % blocks.x()), 2 * (number / blocks.x() % blocks.y()),
                                  2 * (number / (blocks.x() * blocks.y())));
      std::array<Lanes, 3> at, w;
      std::array<std::array<Lanes, 4>, 6> sums;  // three colours and the hidden fraction
      for (auto& side : sums) side.fill(Lanes::Zero());
      for (int lane = 0; lane < kLanes; ++lane) {
        const Vector3f center = grid.middle(corner + offset_in_block(lane), floor);
        for (int k = 0; k < 3; ++k) at[k][lane] = center[k];
      }
      const Vector3f middle(at[0].mean(), at[1].mean(), at[2].mean());
      for (const LitPatch& patch : patches) {
        Lanes factor = light_factor(patch, at, w);
        if (!(factor.maxCoeff() > 0)) continue;
        factor *= passes(patch, middle);
        for (std::size_t side = 0; side < 6; ++side) {
          const Lanes taken = factor * (side % 2 == 0 ? w[side / 2] : Lanes(-w[side / 2])).max(0.0f);
          for (int color = 0; color < 3; ++color) sums[side][color] += taken * patch.light[color];
          if (patch.hides) sums[side][3] += taken;
        }
      }
      for (int lane = 0; lane < kLanes; ++lane) {
        const Eigen::Array3i place = corner + offset_in_block(lane);
        float share = 1;
        for (int k = 0; k < 3; ++k) share *= fade(place[k], grid.counts[k]);
        const int cell = (place.z() * grid.counts.y() + place.y()) * grid.counts.x() + place.x();
        for (std::size_t side = 0; side < 6; ++side)
          light[side * grid.size() + static_cast<std::size_t>(cell)] =
              share *
              Eigen::Vector4f(sums[side][0][lane], sums[side][1][lane], sums[side][2][lane], sums[side][3][lane]);
      }
    }
  });
  return light;
}

BouncedLight::BouncedLight(const Gl& gl, int cells) : gl_(&gl), cells_(cells), block_(gl) {}

Vector3f BouncedLight::color_of(const frame::Appearance& look, bool back) {
  const Vec3 own = image::linear_from_srgb(back ? look.back_color : look.color);
  const frame::Paint& paint = look.paint;
  if (!paint.texture || (back && !look.back_painted) || paint.alpha == frame::Paint::Alpha::over_color)
    return own.cast<float>();
  const auto [known, added] = means_.try_emplace(paint.texture, Vector3f::Zero());
  if (added) {
    // A few hundred pixels suffice for the mean.
    const std::size_t pixels = paint.texture->rgba.size() / 4, step = std::max<std::size_t>(1, pixels / 499);
    Vec3 sum = Vec3::Zero();
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels; i += step, ++count) {
      const std::uint8_t* rgba = paint.texture->rgba.data() + 4 * i;
      sum += image::linear_from_srgb(Vec3(rgba[0], rgba[1], rgba[2]) / 255);
    }
    known->second = (sum / static_cast<double>(std::max<std::size_t>(count, 1))).cast<float>();
  }
  return known->second.cwiseProduct(image::linear_from_srgb(look.color).cast<float>());
}

void BouncedLight::draw(std::span<const BouncingSurface> surfaces, const std::optional<Floor>& floor, double floor_tint,
                        const Irradiance& around, const Box3& subjects, const ShadowMaps& shadows) {
  const BounceGrid grid(subjects, cells_);
  BounceGrid coarse = grid;
  coarse.cell *= 2;
  coarse.counts /= 2;
  coarse.first.array() += 0.5f * grid.cell;
  PatchGrid grid_sums(coarse);
  for (const BouncingSurface& each : surfaces) {
    const frame::Surface& surface = each.surface->surface();
    const auto& positions = each.surface->state().positions;
    const std::size_t step = (surface.triangles.size() + kMaxSampledTriangles - 1) / kMaxSampledTriangles;
    const auto colors_of = [&](const frame::Appearance& look) {
      return Colors{color_of(look, false), color_of(look, true), surface.kind == frame::ObjectKind::cloth};
    };
    std::vector<Colors> parts;
    if (!each.plain && surface.part_of_triangle.size() == surface.triangles.size())
      for (const frame::SurfacePart& part : surface.parts) parts.push_back(colors_of(part.appearance));
    const Colors own = colors_of(*each.look);
    for (std::size_t t = 0; t < surface.triangles.size(); t += step) {
      std::array<Vector3f, 3> corners;
      for (int c = 0; c < 3; ++c) corners[c] = positions[surface.triangles[t][c]].cast<float>();
      add_triangle(grid_sums, corners, each.opacity * static_cast<float>(step),
                   parts.empty() ? own : parts[surface.part_of_triangle[t]], grid.cell, shadows);
    }
  }
  std::vector<LitPatch> patches = grid_sums.patches();
  const std::vector<LitPatch> blockers = patches;
  std::vector<LitPatch> shaded;
  if (floor) {
    PatchGrid ground(grid);
    const Vec3 color = floor_tint * image::linear_from_srgb(floor->look.color);
    add_floor(ground, grid, *floor, color.cast<float>(), shadows);
    shaded = ground.patches();
    light_from_around(shaded, blockers, {}, around, false);
    std::erase_if(shaded, is_dark);
    for (LitPatch& patch : shaded) patch.hides = false;
  }
  light_from_around(patches, blockers, shaded, around, true);
  const std::size_t surface_patch_count = patches.size();
  patches.insert(patches.end(), shaded.begin(), shaded.end());
  const std::vector<Eigen::Vector4f> light =
      gather(grid, patches, floor, [&](const LitPatch& patch, const Vector3f& middle) {
        return &patch < patches.data() + surface_patch_count ? grid_sums.transmittance(patch.position, middle) : 1;
      });

  if ((grid.counts != counts_).any()) {
    counts_ = grid.counts;
    light_ = Texture(*gl_, GLenum{GL_TEXTURE_3D});
    gl_->TextureStorage3D(light_.name(), 1, GL_RGBA32F, counts_.x(), counts_.y(), 6 * counts_.z());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      gl_->TextureParameteri(light_.name(), filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      gl_->TextureParameteri(light_.name(), wrap, GL_CLAMP_TO_EDGE);
  }
  gl_->TextureSubImage3D(light_.name(), 0, 0, 0, 0, counts_.x(), counts_.y(), 6 * counts_.z(), GL_RGBA, GL_FLOAT,
                         light.data());
  std::array<Eigen::Vector4f, 2> block;
  block[0] << grid.first, 1 / grid.cell;
  block[1] << grid.counts.cast<float>().matrix(), 0;
  gl_->NamedBufferData(block_.name(), sizeof(block), &block, GL_STREAM_DRAW);
  gl_->BindBufferBase(GL_UNIFORM_BUFFER, 2, block_.name());
  gl_->BindTextureUnit(15, light_.name());
}

}  // namespace weft::render
