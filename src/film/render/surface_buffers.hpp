// The vertices and triangles of one surface in GL buffers.
#pragma once

#include <memory>
#include <optional>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/gl/objects.hpp"
#include "film/render/painted_mesh.hpp"
#include "film/render/refinement.hpp"
#include "film/render/shaded_mesh.hpp"
#include "film/render/trims.hpp"

namespace weft::render {

/// Detail of the drawn surface beyond its simulated triangles.
struct Detail {
  bool refines = false;   ///< splits each triangle in four (Refinement); mesh() has the triangles before this split
  bool rims = false;      ///< strips along borders, which show the thickness of the cloth; mesh() excludes them
  bool trims = false;     ///< hems and seams
  bool closures = false;  ///< strips between the edges of closed zips; mesh() excludes them
};

/// One surface in GL buffers. Vertex attributes, numbered as in geometry.vert: 0: position, 1: normal, 2: rest (u, v),
/// 3: heat; if the surface is painted, 4: paint coordinates; if it has trims, 5 and 6: Trim::distance and Trim::along.
class SurfaceBuffers {
 public:
  SurfaceBuffers(const Gl& gl, std::shared_ptr<const frame::Surface> surface, const Detail& detail);

  const frame::Surface& surface() const { return *surface_; }
  bool refined() const { return refinement_.has_value(); }
  /// Longest edge before refinement [m]; 0 without refinement.
  double longest_edge() const { return longest_edge_; }
  bool trimmed() const { return trims_.has_value() && detail_.trims; }

  /// Copies the state of a frame. Throws Error(internal) if a triangle names a vertex without a
  /// position. `rim`: width of the strips along borders [m], 0 for none; ignored without
  /// Detail::rims.
  void update(const frame::SurfaceState& state, double rim = 0);
  void draw() const { draw({0, triangles().size()}); }
  void draw(const PaintedRange& range) const;
  /// The painted mesh; null if nothing is painted.
  const PaintedMesh* painted() const { return painted_ ? &*painted_ : nullptr; }
  /// Whether only front faces are visible from `eye`. True if the surface is closed, is not cloth, has no holes, the
  /// normals of all its shells point outwards, and the eye is outside its bounding box.
  bool shows_only_fronts(const Vec3& eye) const { return faces_outward_ && !bounds_.contains(eye); }
  /// World positions of the drawn vertices [m], and the drawn triangles.
  std::span<const Vec3> positions() const { return positions_; }
  std::span<const Triangle> triangles() const {
    if (!with_strips_.empty()) return with_strips_;
    return refinement_ ? refinement_->triangles() : std::span<const Triangle>(mesh_.triangles);
  }
  /// The mesh that positions() and triangles() derive from.
  const ShadedMesh& mesh() const { return mesh_; }
  const frame::SurfaceState& state() const { return state_; }

 private:
  struct Vertex {
    Eigen::Vector3f position, normal;
    Eigen::Vector2f rest_uv;
    float heat;
  };
  void add_midpoints(std::vector<Vertex>& vertices);
  void add_strips(std::vector<Vertex>& vertices, double rim);
  void upload_trims();
  friend class FloorBuffers;
  static void describe(const Gl& gl, const VertexArray& array, const Buffer& vertices);

  const Gl* gl_;
  std::shared_ptr<const frame::Surface> surface_;
  Detail detail_;
  CornerMap corners_;
  std::size_t vertex_count_ = 0;
  bool has_corner_map_ = false, closed_ = false, faces_outward_ = false;
  Box3 bounds_;
  std::vector<Index> shells_;  // by triangle, if the surface is closed
  VertexArray array_;
  Buffer vertices_, triangles_, places_, trim_distances_, trim_places_;
  ShadedMesh mesh_;
  std::optional<Refinement> refinement_;
  std::optional<PaintedMesh> painted_;
  std::optional<Trims> trims_;
  std::size_t uploaded_trim_count_ = 0;  // number of vertices whose trims are uploaded
  double rim_width_ = 0, longest_edge_ = 0;
  std::vector<Slit> slits_;  // of closures
  std::vector<Triangle> with_strips_;
  std::vector<Vec3> positions_;
  frame::SurfaceState state_;  // of the last frame
};

/// A square of two triangles for the floor. Its front is the side to which `normal` points.
class FloorBuffers {
 public:
  explicit FloorBuffers(const Gl& gl);
  void update(const Vec3& center, const Vec3& normal, double half_side);
  void draw() const;

 private:
  const Gl* gl_;
  VertexArray array_;
  Buffer vertices_;
};

}  // namespace weft::render
