#include "film/render/saliency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "film/render/camera_path.hpp"
#include "film/render/framing.hpp"
#include "film/render/view.hpp"

namespace weft::render {
namespace {

// Number of rows of CoverageGrid.
constexpr int kRows = 72;
// Maximum number of columns of CoverageGrid, which limits its memory to 42 MB. A picture needs more columns if it is
// more than 910 times as wide as high.
constexpr int kMaxColumns = 65536;
// Value of v in Saliency::motion at which the result is 1/2 [√(area of the cloth) per second].
constexpr double kHalfScoreRate = 0.5;

/// A coarse depth buffer: for each cell, the nearest surface.
class CoverageGrid {
 public:
  CoverageGrid(const View& view, double aspect)
      : view_(view),
        columns_(static_cast<int>(std::clamp<long>(std::lround(kRows * aspect), 1, kMaxColumns))),
        nearness_(static_cast<std::size_t>(columns_ * kRows), 0),
        cloth_(nearness_.size(), 0) {}

  void add(const frame::Surface& surface, const std::vector<Vec3>& positions) {
    std::vector<Vec3> cells;  // column, row, near / distance; NaN if the vertex is nearer than the near plane
    for (const Vec3& position : positions) {
      const Eigen::Vector4d clip = view_.clip_from_world * position.homogeneous();
      const Vec3 ndc = clip.head<3>() / clip.w();
      cells.push_back(clip.w() < view_.near
                          ? Vec3::Constant(std::numeric_limits<double>::quiet_NaN())
                          : Vec3((0.5 + 0.5 * ndc.x()) * columns_, (0.5 + 0.5 * ndc.y()) * kRows, ndc.z()));
    }
    for (const auto& [a, b, c] : surface.triangles)
      fill(cells[a], cells[b], cells[c], surface.kind == frame::ObjectKind::cloth);
  }

  double cloth_fraction() const {
    return static_cast<double>(std::count(cloth_.begin(), cloth_.end(), 1)) / static_cast<double>(cloth_.size());
  }

 private:
  // Fills the cells whose centre is in the triangle, unless they show something nearer. Ignores triangles with a vertex
  // nearer than the near plane.
  void fill(const Vec3& a, const Vec3& b, const Vec3& c, bool cloth) {
    const auto area = [](const Vec3& p, const Vec3& q, const Vec3& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    const double whole = area(a, b, c);
    if (!std::isfinite(whole) || whole == 0) return;
    const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
    const auto [low, high] = std::minmax({a.y(), b.y(), c.y()});
    const auto first = [](double edge, int count) {
      return static_cast<int>(std::clamp(std::ceil(edge - 0.5), 0.0, 1.0 * count));
    };
    for (int y = first(low, kRows); y < first(high, kRows); ++y) {
      for (int x = first(left, columns_); x < first(right, columns_); ++x) {
        const Vec3 at(x + 0.5, y + 0.5, 0);
        const Vec3 weights = Vec3(area(at, b, c), area(at, c, a), area(at, a, b)) / whole;
        if (weights.minCoeff() < 0) continue;
        const double nearness = weights.dot(Vec3(a.z(), b.z(), c.z()));
        const auto cell = static_cast<std::size_t>(y * columns_ + x);
        if (nearness <= nearness_[cell]) continue;
        nearness_[cell] = nearness;
        cloth_[cell] = cloth ? 1 : 0;
      }
    }
  }

  const View& view_;
  int columns_;
  std::vector<double> nearness_;
  std::vector<char> cloth_;
};

double coverage(const frame::FrameSnapshot& snapshot, const std::string& camera_name, double aspect) {
  const Vec3 up = snapshot.stage ? snapshot.stage->up : Vec3::UnitZ();
  const frame::Camera camera = camera_of(snapshot, camera_name, aspect);
  const View view = make_view(camera, up, aspect, subject_bounds(snapshot), find_floor(snapshot, up));
  CoverageGrid cells(view, aspect);
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i)
    if (is_subject(*snapshot.surfaces[i])) cells.add(*snapshot.surfaces[i], snapshot.states[i].positions);
  return cells.cloth_fraction();
}

/// Total area of a surface [m²], and the sum of its area vectors [m²], whose length equals the area only if the surface
/// is flat.
struct Facing {
  double area = 0;
  Vec3 sum = Vec3::Zero();
};

Facing facing(const frame::Surface& surface, const std::vector<Vec3>& x) {
  Facing result;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto at = [&](Index v) { return x[v]; };
    const Vec3 normal = 0.5 * (at(b) - at(a)).cross(at(c) - at(a));
    result.area += normal.norm();
    result.sum += normal;
  }
  return result;
}

/// Mean speed of the vertices relative to their mean velocity [m/s], so that translation of the whole cloth does not
/// count.
double speed_within(const std::vector<Vec3>& now, const std::vector<Vec3>& before, double seconds) {
  Vec3 mean = Vec3::Zero();
  for (std::size_t v = 0; v < now.size(); ++v) mean += (now[v] - before[v]) / static_cast<double>(now.size());
  double sum = 0;
  for (std::size_t v = 0; v < now.size(); ++v) sum += (now[v] - before[v] - mean).norm();
  return sum / (static_cast<double>(now.size()) * seconds);
}

}  // namespace

Saliency saliency_of(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* previous, double seconds,
                     const std::string& camera, double aspect) {
  Saliency saliency;
  saliency.coverage = coverage(snapshot, camera, aspect);
  double area = 0, flat = 0, rate = 0;  // `rate`: sum of area times v of Saliency::motion
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    const frame::Surface& surface = *snapshot.surfaces[i];
    if (surface.kind != frame::ObjectKind::cloth || !is_subject(surface)) continue;
    const auto& positions = snapshot.states[i].positions;
    const Facing front = facing(surface, positions);
    if (!(front.area > 0)) continue;
    area += front.area;
    flat += front.sum.norm();
    if (previous)
      rate += front.area * speed_within(positions, previous->states[i].positions, seconds) / std::sqrt(front.area);
  }
  if (!(area > 0)) return saliency;
  saliency.folding = 1 - flat / area;
  saliency.motion = rate / (rate + kHalfScoreRate * area);
  return saliency;
}

}  // namespace weft::render
