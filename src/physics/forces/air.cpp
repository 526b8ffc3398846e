#include "physics/forces/air.hpp"

namespace weft::forces {

Air::Air(const mesh::Grid& grid, Index first, const AirParameters& parameters)
    : wind_(parameters.wind), coefficient_(0.5 * parameters.density * parameters.drag) {
  std::vector<std::array<Index, 4>> cells;
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i + 1 < grid.nu; ++i)
      cells.push_back({first + grid.index(i, j), first + grid.index(i + 1, j), first + grid.index(i + 1, j + 1),
                       first + grid.index(i, j + 1)});
  cells_ = pack(cells);
}

Air::Air(const mesh::Sheet& sheet, Index first, const AirParameters& parameters)
    : wind_(parameters.wind), coefficient_(0.5 * parameters.density * parameters.drag) {
  std::vector<mesh::Triangle> triangles = sheet.triangles;
  for (mesh::Triangle& triangle : triangles)
    for (Index& corner : triangle) corner += first;
  triangles_ = pack(triangles);
}

template <std::size_t Corners>
std::vector<Air::Faces<Corners>> Air::pack(const std::vector<std::array<Index, Corners>>& faces) {
  std::vector<Faces<Corners>> packs(packs_of(faces.size()));
  for (std::size_t p = 0; p < packs.size(); ++p)
    for_each_lane(faces.size(), p, [&](std::size_t f, std::size_t lane, bool is_used) {
      for (std::size_t k = 0; k < Corners; ++k) packs[p].corners[k][lane] = faces[f][k];
      packs[p].is_used[lane] = is_used ? 1 : 0;
    });
  return packs;
}

void Air::partition(std::span<const Index> bounds) {
  cut_packs(
      bounds, cells_, [](const Faces<4>& cells) { return std::span(cells.corners); }, ranges_of_cells_);
  cut_packs(
      bounds, triangles_, [](const Faces<3>& triangles) { return std::span(triangles.corners); }, ranges_of_triangles_);
}

void Air::add(const Evaluation& at) const {
  ranges_of_cells_.for_each(at.range, cells_.size(), [&](std::size_t p) { add_drag(cells_[p], at); });
  ranges_of_triangles_.for_each(at.range, triangles_.size(), [&](std::size_t p) { add_drag(triangles_[p], at); });
}

template <std::size_t Corners>
void Air::add_drag(const Faces<Corners>& faces, const Evaluation& at) const {
  // The area vector of a quad, planar or not, is half the cross product of its diagonals; that of a
  // triangle is half the cross product of two edges.
  const VecLanes origin = gather(at.x, faces.corners[0]);
  VecLanes one = gather(at.x, faces.corners[Corners == 4 ? 2 : 1]) - origin,
           other = gather(at.x, faces.corners[Corners - 1]);
  other = other - (Corners == 4 ? gather(at.x, faces.corners[1]) : origin);
  const VecLanes area = lanes_of(0.5) * cross(one, other);
  const Lanes size = sqrt(dot(area, area));
  const VecLanes n = (size > 0 ? 1 / size : lanes_of(0.0)) * area;
  VecLanes velocity = gather(at.v, faces.corners[0]);
  for (std::size_t k = 1; k < Corners; ++k) velocity = velocity + gather(at.v, faces.corners[k]);
  if (!at.air_velocity.empty())
    for (const IndexLanes& corner : faces.corners) velocity = velocity - gather(at.air_velocity, corner);
  const VecLanes wind = lanes_of(at.air_velocity.empty() ? wind_ : Vec3(Vec3::Zero()));
  const Lanes speed = dot(n, lanes_of(1.0 / Corners) * velocity - wind);
  const Lanes drag_per_speed = coefficient_ / Corners * faces.is_used * size * abs(speed);  // per corner [kg/s]
  const VecLanes drag = drag_per_speed * speed * n;
  for (const IndexLanes& corner : faces.corners) subtract(at.force, corner, drag);
  if (!at.assembly) return;
  const auto damping = packed(outer(2 * at.rate * drag_per_speed * n, n));
  for (const IndexLanes& corner : faces.corners)
    for (std::size_t l = 0; l < 4; ++l) at.assembly.add_to_own_block(corner[l], damping[l]);
}

}  // namespace weft::forces
