#include "render/shadow_maps.hpp"

#include <algorithm>

namespace weft::render {
namespace {

constexpr int kBlock = 16;  // texels of a shadow map's side that share one range: two reductions by 4

// Widest filter, in texels: a penumbra may take this much to each side. Wider ones would need more taps to stay smooth.
constexpr int filter_limit(int map_size) {
  return map_size / 24;
}

}  // namespace

void DepthProgram::draw(const Mat4& clip_from_world, const DrawCasters& casters) const {
  const float far = 1.0f;
  gl_->ClearBufferfv(GL_DEPTH, 0, &far);
  program_.use();
  const Eigen::Matrix4f matrix = clip_from_world.cast<float>();
  gl_->UniformMatrix4fv(place_, 1, GL_FALSE, matrix.data());
  casters();
}

std::vector<std::string> ShadowMaps::defines(const QualitySettings& quality, const LightSet& lights) {
  std::vector<std::string> defines = {"LIGHTS " + std::to_string(lights.count),
                                      "BLOCKER_TAPS " + std::to_string(quality.blocker_taps),
                                      "FILTER_TAPS " + std::to_string(quality.filter_taps),
                                      "FILTER_FLOOR_TEXELS 1.2",
                                      "FILTER_LIMIT_TEXELS " + std::to_string(filter_limit(quality.shadow_size)) + ".0",
                                      "MAX_SLOPE_TEXELS 40.0"};
  if (lights.spots) defines.push_back("SPOTS");
  return defines;
}

ShadowMaps::ShadowMaps(const Gl& gl, const QualitySettings& quality)
    : gl_(&gl),
      quality_(quality),
      reduce_depth_(gl, "fullscreen.vert", "shadow_reduce.frag", {"FROM_DEPTH"}),
      reduce_range_(gl, "fullscreen.vert", "shadow_reduce.frag"),
      spread_(gl, "fullscreen.vert", "shadow_spread.frag"),
      compare_(gl),
      raw_(gl),
      framebuffer_(gl),
      no_vertices_(gl),
      light_block_(gl) {
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
  range_quarter_ = make_texture_array(*gl_, GL_RG32F, size / 4, size / 4, layers, GL_NEAREST);
  range_ = make_texture_array(*gl_, GL_RG32F, coarse, coarse, layers, GL_NEAREST);
  range_spread_ = make_texture_array(*gl_, GL_RG32F, coarse, coarse, layers, GL_NEAREST);
  layers_ = layers;
}

void ShadowMaps::draw(std::span<const frame::Light> lights, std::span<const Vec3> caster_positions, const Vec3& up,
                      const Vec3& scale, const DepthProgram& depth, const DrawCasters& casters) {
  // One layer at least, so that the samplers always have something to look at.
  reserve(std::max<int>(1, static_cast<int>(lights.size())));
  const int size = quality_.shadow_size;
  LightsUniform block;
  for (int i = 0; i < static_cast<int>(lights.size()); ++i) {
    const ShadowView view = fit_shadow(lights[i], caster_positions, up, size);
    block.lights[i] = pack_light(lights[i], view, scale, size);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl_->NamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, 0, 0);
    gl_->NamedFramebufferTextureLayer(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0, i);
    check_framebuffer(*gl_, framebuffer_, "shadow map");
    gl_->Viewport(0, 0, size, size);
    gl_->Enable(GL_DEPTH_TEST);
    depth.draw(view.clip_from_world, casters);
    reduce(i);
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

void ShadowMaps::reduce(int layer) {
  struct Step {
    const Program& program;
    const Texture &from, &to;
    int size;
    int axis_x;
  };
  const int size = quality_.shadow_size;
  const int spread_radius = filter_limit(size) / kBlock + 1;
  const Step steps[] = {{reduce_depth_, depth_, range_quarter_, size / 4, 0},
                        {reduce_range_, range_quarter_, range_, size / kBlock, 0},
                        {spread_, range_, range_spread_, size / kBlock, 1},
                        {spread_, range_spread_, range_, size / kBlock, 0}};
  gl_->Disable(GL_DEPTH_TEST);
  gl_->BindVertexArray(no_vertices_.name());
  gl_->NamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, 0, 0);
  gl_->BindSampler(0, 0);
  for (const Step& step : steps) {
    gl_->NamedFramebufferTextureLayer(framebuffer_.name(), GL_COLOR_ATTACHMENT0, step.to.name(), 0, layer);
    gl_->Viewport(0, 0, step.size, step.size);
    gl_->BindTextureUnit(0, step.from.name());
    step.program.use();
    gl_->Uniform1i(step.program.uniform("layer"), layer);
    gl_->Uniform2i(step.program.uniform("axis"), step.axis_x, 1 - step.axis_x);
    gl_->Uniform1i(step.program.uniform("radius"), spread_radius);
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
}

}  // namespace weft::render
