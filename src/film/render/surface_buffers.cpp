#include "film/render/surface_buffers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/disjoint_sets.hpp"
#include "core/error.hpp"
#include "film/render/seen.hpp"

namespace weft::render {
namespace {

/// Whether pictures cut holes into the surface, through which back faces are visible.
bool has_holes(const frame::Surface& surface) {
  const auto cuts = [](const frame::Appearance& look) { return look.paint.alpha == frame::Paint::Alpha::cutout; };
  return cuts(surface.appearance) ||
         std::ranges::any_of(surface.parts, [&](const frame::SurfacePart& part) { return cuts(part.appearance); });
}

/// The shell of each triangle, named by its smallest vertex. A shell is a connected part of a surface.
std::vector<Index> shells_of(std::span<const Triangle> triangles, std::size_t vertex_count) {
  DisjointSets sets(vertex_count);
  for (const auto& [a, b, c] : triangles) {
    sets.join(a, b);
    sets.join(b, c);
  }
  std::vector<Index> shells;
  for (const Triangle& triangle : triangles) shells.push_back(sets.root(triangle[0]));
  return shells;
}

}  // namespace

void SurfaceBuffers::describe(const Gl& gl, const VertexArray& array, const Buffer& vertices) {
  struct Attribute {
    GLint size;
    std::size_t offset;
  };
  const Attribute attributes[] = {{3, offsetof(Vertex, position)},
                                  {3, offsetof(Vertex, normal)},
                                  {2, offsetof(Vertex, rest_uv)},
                                  {1, offsetof(Vertex, heat)}};
  gl.VertexArrayVertexBuffer(array.name(), 0, vertices.name(), 0, sizeof(Vertex));
  for (GLuint place = 0; place < std::size(attributes); ++place) {
    gl.EnableVertexArrayAttrib(array.name(), place);
    gl.VertexArrayAttribFormat(array.name(), place, attributes[place].size, GL_FLOAT, GL_FALSE,
                               static_cast<GLuint>(attributes[place].offset));
    gl.VertexArrayAttribBinding(array.name(), place, 0);
  }
}

SurfaceBuffers::SurfaceBuffers(const Gl& gl, std::shared_ptr<const frame::Surface> surface, const Detail& detail)
    : gl_(&gl),
      surface_(std::move(surface)),
      detail_(detail),
      array_(gl),
      vertices_(gl),
      triangles_(gl),
      places_(gl),
      trim_distances_(gl),
      trim_places_(gl) {
  closed_ = surface_->kind != frame::ObjectKind::cloth && !has_holes(*surface_) && is_closed(surface_->triangles);
  if (detail_.refines) refinement_.emplace();
  if (detail_.trims || detail_.rims) trims_.emplace(*surface_);
  if (detail_.closures) slits_ = find_slits(*surface_);
  describe(gl, array_, vertices_);
  gl.VertexArrayElementBuffer(array_.name(), triangles_.name());
  if (detail_.trims) {
    add_attribute(gl, array_, 5, trim_distances_, Trim::kKinds);
    add_attribute(gl, array_, 6, trim_places_, Trim::kKinds);
  }
  if (!frame::is_painted(*surface_)) return;
  painted_.emplace();
  add_attribute(gl, array_, 4, places_, 2);
}

void SurfaceBuffers::update(const frame::SurfaceState& state, double rim) {
  // Skips unchanged surfaces, because most obstacles do not move.
  if (!detail_.rims) rim = 0;
  if (has_corner_map_ && state.positions == state_.positions && state.heat == state_.heat && rim == rim_width_) return;
  rim_width_ = rim;
  state_ = state;
  if (!has_corner_map_ || vertex_count_ != state.positions.size()) {
    corners_ = CornerMap(surface_->triangles, state.positions.size());
    if (closed_) shells_ = shells_of(surface_->triangles, state.positions.size());
    vertex_count_ = state.positions.size();
    has_corner_map_ = true;
  }
  if (closed_) {
    bounds_.setEmpty();
    for (const Vec3& position : state.positions) bounds_.extend(position);
    // Six times the volume of each shell, by its smallest vertex [m³]; negative if its triangles face inwards.
    std::vector<double> volumes(state.positions.size(), 0);
    for (std::size_t t = 0; t < shells_.size(); ++t) {
      const auto& [a, b, c] = surface_->triangles[t];
      const Vec3 from_center = state.positions[a] - bounds_.center();
      volumes[shells_[t]] +=
          from_center.dot((state.positions[b] - state.positions[a]).cross(state.positions[c] - state.positions[a]));
    }
    // The volume of a flat shell is a rounding error.
    constexpr double kMaxFlatVolume = 1e-9;  // relative to the cube of the diagonal of `bounds_`
    const auto [least, most] = std::ranges::minmax(volumes);
    faces_outward_ = most > 0 && least > -kMaxFlatVolume * std::pow(bounds_.diagonal().norm(), 3);
  }
  mesh_ = make_shaded_mesh(surface_->triangles, corners_, state.positions, surface_->crease_angle);
  if (painted_) painted_ = make_painted_mesh(*surface_, mesh_);
  std::vector<Vertex> vertices(mesh_.source.size());
  positions_.resize(vertices.size());
  const bool has_uv = surface_->uv.size() == vertex_count_, has_heat = state.heat.size() == vertex_count_;
  const float no_heat = surface_->kind == frame::ObjectKind::cloth ? 0.0f : kSolid;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Index v = mesh_.source[i];
    positions_[i] = state.positions[v];
    vertices[i] = {state.positions[v].cast<float>(), mesh_.normals[i].cast<float>(),
                   has_uv ? surface_->uv[v].cast<float>().eval() : Eigen::Vector2f::Zero(),
                   has_heat ? state.heat[v] : no_heat};
  }
  if (refinement_) add_midpoints(vertices);
  with_strips_.clear();
  if (rim > 0 || !slits_.empty()) add_strips(vertices, rim);
  if (detail_.trims && uploaded_trim_count_ != positions_.size()) upload_trims();
  upload<Vertex>(*gl_, vertices_, vertices);
  upload<Triangle>(*gl_, triangles_, triangles());
  if (painted_) upload<Eigen::Vector2f>(*gl_, places_, painted_->places);
}

void SurfaceBuffers::add_midpoints(std::vector<Vertex>& vertices) {
  refinement_->update(mesh_.triangles, vertices.size());
  const double max_offset = max_midpoint_offset(surface_->appearance.thickness);
  longest_edge_ = 0;
  for (const auto& [a, b] : refinement_->edges()) {
    longest_edge_ = std::max(longest_edge_, (positions_[b] - positions_[a]).norm());
    const Middle here = middle(positions_[a], positions_[b], mesh_.normals[a], mesh_.normals[b], max_offset);
    positions_.push_back(here.position);
    vertices.push_back({here.position.cast<float>(), here.normal.cast<float>(),
                        0.5f * (vertices[a].rest_uv + vertices[b].rest_uv),
                        0.5f * (vertices[a].heat + vertices[b].heat)});
    if (painted_) painted_->places.push_back(0.5f * (painted_->places[a] + painted_->places[b]));
  }
  if (!painted_) return;
  for (PaintedRange& range : painted_->ranges) {
    range.first *= 4;
    range.count *= 4;
  }
}

/// Appends strips after all other vertices and triangles: those along borders (RimStrip) if `rim`, their width [m], is
/// positive, and those across the slits of closed zips.
void SurfaceBuffers::add_strips(std::vector<Vertex>& vertices, double rim) {
  // `points`: the positions of the surface vertices and, if the surface is refined, the midpoints
  // of the rims and slits.
  std::vector<Index> drawn(vertex_count_);
  for (std::size_t i = 0; i < mesh_.source.size(); ++i) drawn[mesh_.source[i]] = static_cast<Index>(i);
  std::vector<Vec3> points = state_.positions, normals(vertex_count_);
  for (std::size_t v = 0; v < vertex_count_; ++v) normals[v] = mesh_.normals[drawn[v]];
  std::vector<std::pair<Index, Index>> ends;  // per point: two drawn vertices, whose attributes are averaged
  for (std::size_t v = 0; v < vertex_count_; ++v) ends.emplace_back(drawn[v], drawn[v]);
  const double max_offset = max_midpoint_offset(surface_->appearance.thickness);
  const auto add_middle = [&](Index a, Index b) {
    const Middle here = middle(points[a], points[b], normals[a], normals[b], max_offset);
    points.push_back(here.position);
    normals.push_back(here.normal);
    ends.emplace_back(drawn[a], drawn[b]);
    return static_cast<Index>(points.size()) - 1;
  };
  std::vector<Trims::Rim> rims;
  for (const Trims::Rim& whole : rim > 0 ? trims_->rims() : std::span<const Trims::Rim>{}) {
    if (!refinement_) {
      rims.push_back(whole);
      continue;
    }
    const Index m = add_middle(whole.a, whole.b);
    rims.push_back({whole.a, m, whole.triangle});
    rims.push_back({m, whole.b, whole.triangle});
  }
  RimStrip strip = rim_strip(rims, points, normals, rim);
  // Both sides of a slit have the attributes of side a, because (u, v) of the two sides may be far apart.
  const auto add_across = [&](const Slit& slit) {
    const auto p = static_cast<Index>(strip.positions.size());
    for (const Index v : {slit.a[0], slit.b[0], slit.a[1], slit.b[1]}) {
      strip.positions.push_back(points[v]);
      strip.normals.push_back(normals[v]);
    }
    strip.source.insert(strip.source.end(), {slit.a[0], slit.a[0], slit.a[1], slit.a[1]});
    strip.triangles.insert(strip.triangles.end(), {{p + 2, p, p + 1}, {p + 2, p + 1, p + 3}});
    strip.owner.insert(strip.owner.end(), {slit.triangle, slit.triangle});
  };
  for (const Slit& slit : slits_) {
    const auto gap = [&](std::size_t end) { return (points[slit.a[end]] - points[slit.b[end]]).norm(); };
    if (std::max(gap(0), gap(1)) >= surface_->max_closed_gap) continue;
    if (!refinement_) {
      add_across(slit);
      continue;
    }
    const Index a = add_middle(slit.a[0], slit.a[1]), b = add_middle(slit.b[0], slit.b[1]);
    add_across({{slit.a[0], a}, {slit.b[0], b}, slit.triangle});
    add_across({{a, slit.a[1]}, {b, slit.b[1]}, slit.triangle});
  }
  if (strip.triangles.empty()) return;
  const frame::Appearance& look = surface_->appearance;
  const std::span<const Triangle> without =
      refinement_ ? refinement_->triangles() : std::span<const Triangle>(mesh_.triangles);
  const auto first = static_cast<Index>(vertices.size());
  for (std::size_t i = 0; i < strip.positions.size(); ++i) {
    const auto [a, b] = ends[strip.source[i]];
    positions_.push_back(strip.positions[i]);
    vertices.push_back({strip.positions[i].cast<float>(), strip.normals[i].cast<float>(),
                        0.5f * (vertices[a].rest_uv + vertices[b].rest_uv),
                        0.5f * (vertices[a].heat + vertices[b].heat)});
    if (painted_) painted_->places.push_back(0.5f * (painted_->places[a] + painted_->places[b]));
  }
  with_strips_.assign(without.begin(), without.end());
  const auto add = [&](std::size_t t) {
    const auto& [a, b, c] = strip.triangles[t];
    with_strips_.push_back({a + first, b + first, c + first});
  };
  if (!painted_) {
    for (std::size_t t = 0; t < strip.triangles.size(); ++t) add(t);
    return;
  }
  // For each painted range that has strips, appends a range of these strips.
  const auto& parts = surface_->part_of_triangle;
  const auto look_of = [&](std::int32_t triangle) {
    return parts.empty() ? &look : &surface_->parts[static_cast<std::size_t>(parts[triangle])].appearance;
  };
  const std::vector<PaintedRange> ranges = painted_->ranges;
  for (const PaintedRange& range : ranges) {
    PaintedRange strips{with_strips_.size(), 0, range.look};
    for (std::size_t t = 0; t < strip.triangles.size(); ++t)
      if (look_of(strip.owner[t]) == range.look) add(t);
    strips.count = with_strips_.size() - strips.first;
    if (strips.count > 0) painted_->ranges.push_back(strips);
  }
}

/// Trims depend on rest coordinates only, so one upload suffices until the number of drawn vertices changes.
void SurfaceBuffers::upload_trims() {
  std::vector<Trim> trims;
  for (const Index v : mesh_.source) trims.push_back(trims_->at(v));
  if (refinement_)
    for (const auto& [a, b] : refinement_->edges()) trims.push_back(trims_->middle(mesh_.source[a], mesh_.source[b]));
  // The strips along borders and across slits must show neither the fold of the hem nor its stitches. Therefore the
  // strips get a distance from the border beyond the fold and before the stitches: kPlain times the width of the hem.
  constexpr float kPlain = 0.3f;
  Trim plain;
  plain.distance[Trim::border] = kPlain * static_cast<float>(surface_->appearance.hem);
  trims.resize(positions_.size(), plain);
  std::vector<std::array<float, Trim::kKinds>> distances, along;
  for (const Trim& trim : trims) {
    distances.push_back(trim.distance);
    along.push_back(trim.along);
  }
  upload<std::array<float, Trim::kKinds>>(*gl_, trim_distances_, distances);
  upload<std::array<float, Trim::kKinds>>(*gl_, trim_places_, along);
  uploaded_trim_count_ = trims.size();
}

void SurfaceBuffers::draw(const PaintedRange& range) const {
  gl_->BindVertexArray(array_.name());
  // OpenGL takes the offset in the index buffer as a pointer. NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* first = reinterpret_cast<const void*>(range.first * sizeof(Triangle));
  gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * range.count), GL_UNSIGNED_INT, first);
}

FloorBuffers::FloorBuffers(const Gl& gl) : gl_(&gl), array_(gl), vertices_(gl) {
  SurfaceBuffers::describe(gl, array_, vertices_);
}

void FloorBuffers::update(const Vec3& center, const Vec3& normal, double half_side) {
  const Vec3 x = half_side * normal.unitOrthogonal(), y = normal.cross(x);
  std::array<SurfaceBuffers::Vertex, 4> vertices;
  for (int i = 0; i < 4; ++i) {
    const Vec3 position = center + (i & 1 ? x : -x) + (i & 2 ? y : -y);
    vertices[i] = {position.cast<float>(), normal.cast<float>(), Eigen::Vector2f::Zero(), 0.0f};
  }
  upload<SurfaceBuffers::Vertex>(*gl_, vertices_, vertices);
}

void FloorBuffers::draw() const {
  gl_->BindVertexArray(array_.name());
  gl_->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace weft::render
