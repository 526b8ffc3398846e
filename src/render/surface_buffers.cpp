#include "render/surface_buffers.hpp"

#include <algorithm>
#include <cstddef>

#include "core/error.hpp"

namespace weft::render {
namespace {

/// Where pictures cut holes, backs are seen through them.
bool has_holes(const frame::Surface& surface) {
  const auto cuts = [](const frame::Appearance& look) { return look.paint.alpha == frame::Paint::Alpha::cutout; };
  return cuts(surface.appearance) ||
         std::ranges::any_of(surface.parts, [&](const frame::SurfacePart& part) { return cuts(part.appearance); });
}

struct DrawnVertex {
  Eigen::Vector3f position, normal;
  Eigen::Vector2f rest_uv;
  float heat;
};

void describe_vertices(const Gl& gl, const VertexArray& array, const Buffer& vertices) {
  struct Attribute {
    GLint size;
    std::size_t offset;
  };
  const Attribute attributes[] = {{3, offsetof(DrawnVertex, position)},
                                  {3, offsetof(DrawnVertex, normal)},
                                  {2, offsetof(DrawnVertex, rest_uv)},
                                  {1, offsetof(DrawnVertex, heat)}};
  gl.VertexArrayVertexBuffer(array.name(), 0, vertices.name(), 0, sizeof(DrawnVertex));
  for (GLuint place = 0; place < std::size(attributes); ++place) {
    gl.EnableVertexArrayAttrib(array.name(), place);
    gl.VertexArrayAttribFormat(array.name(), place, attributes[place].size, GL_FLOAT, GL_FALSE,
                               static_cast<GLuint>(attributes[place].offset));
    gl.VertexArrayAttribBinding(array.name(), place, 0);
  }
}

}  // namespace

SurfaceBuffers::SurfaceBuffers(const Gl& gl, std::shared_ptr<const frame::Surface> surface, bool refines)
    : gl_(&gl), surface_(std::move(surface)), array_(gl), vertices_(gl), triangles_(gl), places_(gl) {
  closed_ = surface_->kind != frame::ObjectKind::cloth && !has_holes(*surface_) && is_closed(surface_->triangles);
  if (refines) refinement_.emplace();
  describe_vertices(gl, array_, vertices_);
  gl.VertexArrayElementBuffer(array_.name(), triangles_.name());
  if (!frame::is_painted(*surface_)) return;
  painted_.emplace();
  constexpr GLuint kPlace = 4, kBinding = 1;
  gl.VertexArrayVertexBuffer(array_.name(), kBinding, places_.name(), 0, sizeof(Eigen::Vector2f));
  gl.EnableVertexArrayAttrib(array_.name(), kPlace);
  gl.VertexArrayAttribFormat(array_.name(), kPlace, 2, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribBinding(array_.name(), kPlace, kBinding);
}

void SurfaceBuffers::update(const frame::SurfaceState& state) {
  // Obstacles mostly stand still.
  if (mapped_ && state.positions == state_.positions && state.heat == state_.heat) return;
  state_ = state;
  if (!mapped_ || vertex_count_ != state.positions.size()) {
    corners_ = CornerMap(surface_->triangles, state.positions.size());
    vertex_count_ = state.positions.size();
    mapped_ = true;
  }
  if (closed_) {
    double volume = 0;  // six times what is enclosed: negative where the front is inside
    bounds_.setEmpty();
    for (const Vec3& position : state.positions) bounds_.extend(position);
    for (const auto& [a, b, c] : surface_->triangles) {
      const Vec3 from_center = state.positions[a] - bounds_.center();
      volume +=
          from_center.dot((state.positions[b] - state.positions[a]).cross(state.positions[c] - state.positions[a]));
    }
    outward_ = volume > 0;
  }
  mesh_ = shade(surface_->triangles, corners_, state.positions, surface_->crease_angle);
  if (painted_) painted_ = lay_paint(*surface_, mesh_);
  std::vector<DrawnVertex> vertices(mesh_.source.size());
  positions_.resize(vertices.size());
  const bool has_uv = surface_->uv.size() == vertex_count_, has_heat = state.heat.size() == vertex_count_;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Index v = mesh_.source[i];
    positions_[i] = state.positions[v];
    vertices[i] = {state.positions[v].cast<float>(), mesh_.normals[i].cast<float>(),
                   has_uv ? surface_->uv[v].cast<float>().eval() : Eigen::Vector2f::Zero(),
                   has_heat ? state.heat[v] : 0.0f};
  }
  if (refinement_) {
    refinement_->update(mesh_.triangles, vertices.size());
    for (const auto& [a, b] : refinement_->edges()) {
      const Middle here = middle(positions_[a], positions_[b], mesh_.normals[a], mesh_.normals[b]);
      positions_.push_back(here.position);
      vertices.push_back({here.position.cast<float>(), here.normal.cast<float>(),
                          0.5f * (vertices[a].rest_uv + vertices[b].rest_uv),
                          0.5f * (vertices[a].heat + vertices[b].heat)});
      if (painted_) painted_->places.push_back(0.5f * (painted_->places[a] + painted_->places[b]));
    }
    if (painted_) {
      for (PaintedRange& range : painted_->ranges) {
        range.first *= 4;
        range.count *= 4;
      }
    }
  }
  upload<DrawnVertex>(*gl_, vertices_, vertices);
  upload<Triangle>(*gl_, triangles_, triangles());
  if (painted_) upload<Eigen::Vector2f>(*gl_, places_, painted_->places);
}

void SurfaceBuffers::draw(const PaintedRange& range) const {
  gl_->BindVertexArray(array_.name());
  // OpenGL takes the offset in its buffer as a pointer. NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* first = reinterpret_cast<const void*>(range.first * sizeof(Triangle));
  gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * range.count), GL_UNSIGNED_INT, first);
}

void SurfaceBuffers::draw() const {
  if (triangles().empty()) return;
  gl_->BindVertexArray(array_.name());
  gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles().size()), GL_UNSIGNED_INT, nullptr);
}

FloorBuffers::FloorBuffers(const Gl& gl) : gl_(&gl), array_(gl), vertices_(gl) {
  describe_vertices(gl, array_, vertices_);
}

void FloorBuffers::update(const Vec3& center, const Vec3& normal, double half_side) {
  const Vec3 x = half_side * normal.unitOrthogonal(), y = normal.cross(x);
  std::array<DrawnVertex, 4> vertices;
  for (int i = 0; i < 4; ++i) {
    const Vec3 position = center + (i & 1 ? x : -x) + (i & 2 ? y : -y);
    vertices[i] = {position.cast<float>(), normal.cast<float>(), Eigen::Vector2f::Zero(), 0.0f};
  }
  upload<DrawnVertex>(*gl_, vertices_, vertices);
}

void FloorBuffers::draw() const {
  gl_->BindVertexArray(array_.name());
  gl_->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace weft::render
