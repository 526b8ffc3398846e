#include "render/shadow_maps.hpp"

#include <algorithm>
#include <cmath>

#include "render/depth_raster.hpp"
#include "render/painted_mesh.hpp"

namespace weft::render {
namespace {

constexpr int kBlock = 16;  // side of a block of texels that shares one depth range
constexpr int kBounceMapReduction =
    4;  // reduction of maps that only bounced light samples: its cells are larger than their texels

// Maximum half width of a penumbra [texels]. Wider ones would need more filter taps to stay smooth.
constexpr int filter_limit(int map_size) {
  return map_size / 24;
}

/// Rasterises a mesh with holes: a texel is covered if the opacity exceeds its dither threshold; the shadow filter
/// averages these to an even shade. All corners must be in front of the light.
template <class Write>
void fill_with_holes(const DrawnMesh& mesh, std::span<const Eigen::Vector3f> places, int size, const Write& write) {
  for (std::size_t r = 0; r < mesh.holes->ranges().size(); ++r) {
    const PaintedRange& range = mesh.holes->ranges()[r];
    const Opacity* opacity = mesh.holes->opacity(r);
    for (const auto& [a, b, c] : mesh.triangles.subspan(range.first, range.count)) {
      if (opacity == nullptr) {
        fill_triangle(places[a], places[b], places[c], size, size, write);
        continue;
      }
      const Eigen::Vector2f at_a = mesh.holes->place(r, a), along_b = mesh.holes->place(r, b) - at_a,
                            along_c = mesh.holes->place(r, c) - at_a;
      // Picture texels for each map texel, from the ratio of areas.
      const Eigen::Vector2f texels_b = along_b.cwiseProduct(opacity->size()),
                            texels_c = along_c.cwiseProduct(opacity->size());
      const Eigen::Vector3f map_b = places[b] - places[a], map_c = places[c] - places[a];
      const auto area = [](const auto& p, const auto& q) { return std::abs(p.x() * q.y() - p.y() * q.x()); };
      const float footprint = std::sqrt(area(texels_b, texels_c) / std::max(area(map_b, map_c), 1e-6f));
      fill_triangle(places[a], places[b], places[c], size, size,
                    [&](int at, bool covered, float depth, float to_b, float to_c) {
                      const bool here = covered && opacity->at(at_a + to_b * along_b + to_c * along_c, footprint) >
                                                       threshold_at(at % size, at / size);
                      write(at, here, depth, to_b, to_c);
                    });
    }
  }
}

void draw_depths(std::span<const DrawnMesh> casters, const Mat4& clip_from_world, int size, std::vector<float>& map) {
  map.assign(static_cast<std::size_t>(size) * size, 1.0f);
  const auto write = [depths = map.data()](int at, bool covered, float depth, float, float) {
    const float before = depths[at], nearer = std::min(before, depth);
    depths[at] = covered ? nearer : before;
  };
  const Mat4 texels_from_clip = Eigen::Vector4d(size, size, 1, 1).asDiagonal() * texture_from_clip();
  const Mat4 texels_from_world = texels_from_clip * clip_from_world;
  const auto place = [](const Eigen::Vector4d& texels) {
    return Eigen::Vector3f((texels.head<3>() / texels.w()).cast<float>());
  };
  std::vector<char> in_front;
  std::vector<Eigen::Vector3f> places;
  for (const DrawnMesh& mesh : casters) {
    in_front.clear();
    places.clear();
    for (const Vec3& position : mesh.positions) {
      const Eigen::Vector4d texels = texels_from_world * position.homogeneous();
      in_front.push_back(texels.z() >= 0 ? 1 : 0);
      places.push_back(place(texels));
    }
    if (mesh.holes) {
      fill_with_holes(mesh, places, size, write);
      continue;
    }
    const auto write_dithered = [&](int at, bool covered, float depth, float to_b, float to_c) {
      write(at, covered && mesh.opacity > threshold_at(at % size, at / size), depth, to_b, to_c);
    };
    const auto clip = [&](Index vertex) -> Eigen::Vector4d {
      return clip_from_world * mesh.positions[vertex].homogeneous();
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const bool whole = in_front[a] != 0 && in_front[b] != 0 && in_front[c] != 0;
      if (mesh.opacity < 1) {
        if (whole) fill_triangle(places[a], places[b], places[c], size, size, write_dithered);
      } else if (whole) {
        fill_triangle(places[a], places[b], places[c], size, size, write);
      } else {
        clip_near({clip(a), clip(b), clip(c)}, [&](const auto& p, const auto& q, const auto& r) {
          fill_triangle(place(texels_from_clip * p), place(texels_from_clip * q), place(texels_from_clip * r), size,
                        size, write);
        });
      }
    }
  }
}

}  // namespace

std::vector<std::string> ShadowMaps::defines(const QualitySettings& quality, const LightSet& lights) {
  std::vector<std::string> defines = {"LIGHTS " + std::to_string(lights.count),
                                      "BLOCKER_TAPS " + std::to_string(quality.blocker_taps),
                                      "FILTER_TAPS " + std::to_string(quality.filter_taps),
                                      "SHADOW_TEXELS " + std::to_string(quality.shadow_size) + ".0",
                                      "FILTER_FLOOR_TEXELS 1.2",
                                      "FILTER_LIMIT_TEXELS " + std::to_string(filter_limit(quality.shadow_size)) + ".0",
                                      "MAX_SLOPE_TEXELS 40.0"};
  if (lights.spots) defines.push_back("SPOTS");
  return defines;
}

ShadowMaps::ShadowMaps(const Gl& gl, const QualitySettings& quality)
    : gl_(&gl), quality_(quality), compare_(gl), raw_(gl), light_block_(gl) {
  for (const Sampler* sampler : {&compare_, &raw_}) {
    gl.SamplerParameteri(sampler->name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.SamplerParameteri(sampler->name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    const GLint filter = sampler == &compare_ ? GL_LINEAR : GL_NEAREST;
    gl.SamplerParameteri(sampler->name(), GL_TEXTURE_MIN_FILTER, filter);
    gl.SamplerParameteri(sampler->name(), GL_TEXTURE_MAG_FILTER, filter);
  }
  gl.SamplerParameteri(compare_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.SamplerParameteri(compare_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

void ShadowMaps::reserve(int layers) {
  if (layers <= layers_) return;
  const int size = quality_.shadow_size, coarse = size / kBlock;
  depth_ = make_texture_array(*gl_, GL_DEPTH_COMPONENT32F, size, size, layers, GL_NEAREST);
  range_ = make_texture_array(*gl_, GL_RG32F, coarse, coarse, layers, GL_NEAREST);
  layers_ = layers;
}

void ShadowMaps::draw(std::span<const frame::Light> lights, std::span<const Vec3> caster_positions,
                      std::span<const DrawnMesh> casters, const InView* in_view, const Vec3& up, const Vec3& scale) {
  // At least one layer, so that the samplers always have a complete texture.
  reserve(std::max<int>(1, static_cast<int>(lights.size())));
  const int size = quality_.shadow_size, coarse = size / kBlock;
  LightsUniform block;
  maps_.resize(lights.size());
  complete_maps_.resize(in_view == nullptr ? 0 : lights.size());
  const auto fill = [&](Map& map, const frame::Light& light, const InView* needed, int map_size) {
    const ShadowView view = fit_shadow(light, caster_positions, needed, up, map_size);
    map.light = pack_light(light, view, scale);
    map.size = map_size;
    draw_depths(casters, view.clip_from_world, map_size, map.depths);
  };
  for (int i = 0; i < static_cast<int>(lights.size()); ++i) {
    fill(maps_[i], lights[i], in_view, size);
    if (in_view != nullptr) fill(complete_maps_[i], lights[i], nullptr, size / kBounceMapReduction);
    block.lights[i] = maps_[i].light;
    const std::vector<float>& depths = maps_[i].depths;
    find_ranges(depths);
    gl_->TextureSubImage3D(depth_.name(), 0, 0, 0, i, size, size, 1, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    gl_->TextureSubImage3D(range_.name(), 0, 0, 0, i, coarse, coarse, 1, GL_RG, GL_FLOAT, ranges_.data());
  }
  gl_->NamedBufferData(light_block_.name(), sizeof(block), &block, GL_STREAM_DRAW);
  gl_->BindBufferBase(GL_UNIFORM_BUFFER, 1, light_block_.name());
  gl_->BindTextureUnit(0, depth_.name());
  gl_->BindSampler(0, compare_.name());
  gl_->BindTextureUnit(1, depth_.name());
  gl_->BindSampler(1, raw_.name());
  gl_->BindTextureUnit(2, range_.name());
  gl_->BindSampler(2, 0);
}

Eigen::Vector3f ShadowMaps::light_on(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, bool shadowed) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Map& map : complete_maps_.empty() ? maps_ : complete_maps_) {
    const LightUniform& light = map.light;
    const int size = map.size;
    Eigen::Vector3f toward = light.toward_light.head<3>();
    float cone = 1;
    if (light.toward_light.w() != 0) {
      const Eigen::Vector3f to_light = light.position.head<3>() - point;
      toward = to_light.normalized();
      const float t = (toward.dot(light.toward_light.head<3>()) - light.position.w()) * light.color.w();
      cone = std::clamp(t, 0.0f, 1.0f);
      cone *= cone * (3 - 2 * cone) * light.toward_light.w() / std::max(to_light.squaredNorm(), 1e-6f);
    }
    const float facing = cone * normal.dot(toward);
    if (facing <= 0) continue;
    if (shadowed) {
      // A bias of two texels replaces the bias of the picture's shadows.
      const Eigen::Vector4f at = light.shadow_from_world * point.homogeneous();
      const Eigen::Vector2f texel = at.head<2>() / at.w() * static_cast<float>(size);
      const bool inside = at.w() > 0 && texel.minCoeff() >= 0 && texel.maxCoeff() < static_cast<float>(size);
      // Depth 1 means no caster, also for points beyond the far plane.
      const float depth = std::min(at.z() / at.w() - 4 * light.shadow.z(), 1.0f);
      if (inside &&
          depth > map.depths[static_cast<std::size_t>(texel.y()) * size + static_cast<std::size_t>(texel.x())])
        continue;
    }
    sum += facing * light.color.head<3>();
  }
  return sum;
}

/// Computes the depth range of each block, extended by the width of the largest filter, so that a block's range is
/// valid for every tap that starts in it.
void ShadowMaps::find_ranges(std::span<const float> map) {
  const int size = quality_.shadow_size, coarse = size / kBlock;
  ranges_.assign(static_cast<std::size_t>(coarse) * coarse, {});
  for (int y = 0; y < size; ++y) {
    const float* depths = map.data() + static_cast<std::size_t>(y) * size;
    Range* ranges = ranges_.data() + static_cast<std::size_t>(y / kBlock) * coarse;
    for (int block = 0; block < coarse; ++block, depths += kBlock) {
      float nearest = ranges[block].nearest, farthest = ranges[block].farthest;
      for (int i = 0; i < kBlock; ++i) nearest = std::min(nearest, depths[i]);
      for (int i = 0; i < kBlock; ++i) farthest = std::max(farthest, depths[i]);
      ranges[block] = {nearest, farthest};
    }
  }
  for (Range& range : ranges_) range.farthest = range.farthest == 1 ? 1e9f : range.farthest;
  spread_ranges(1, coarse);
  spread_ranges(coarse, 1);
}

/// Extends ranges by their neighbours along lines with element stride `step`; lines are `other_step` apart.
void ShadowMaps::spread_ranges(int step, int other_step) {
  const int coarse = quality_.shadow_size / kBlock, radius = filter_limit(quality_.shadow_size) / kBlock + 1;
  std::vector<Range> line(static_cast<std::size_t>(coarse));
  for (int k = 0; k < coarse; ++k) {
    Range* ranges = ranges_.data() + static_cast<std::ptrdiff_t>(k) * other_step;
    for (int i = 0; i < coarse; ++i) line[i] = ranges[static_cast<std::ptrdiff_t>(i) * step];
    for (int i = 0; i < coarse; ++i) {
      Range& range = ranges[static_cast<std::ptrdiff_t>(i) * step];
      for (int j = std::max(0, i - radius); j <= std::min(coarse - 1, i + radius); ++j) {
        range = {std::min(range.nearest, line[j].nearest), std::max(range.farthest, line[j].farthest)};
      }
    }
  }
}

}  // namespace weft::render
