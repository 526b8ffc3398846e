// Moving surfaces, for tests and measurements of methods that reuse results of earlier steps.
#pragma once

#include <cmath>

#include "collision/hierarchy/test_meshes.hpp"

namespace weft::collision::testing {

inline constexpr double kMargin = 0.01;  ///< enlargement of the bounds [m]

/// Several meshes with a common numbering.
struct MovingScene {
  std::vector<Triangle> triangles;
  std::vector<Index> first_triangle{0}, first_vertex{0};  ///< of each surface; then the totals

  void add(const TestMesh& mesh) {
    for (Triangle t : mesh.triangles) {
      for (Index& v : t) v += first_vertex.back();
      triangles.push_back(t);
    }
    first_triangle.push_back(static_cast<Index>(triangles.size()));
    first_vertex.push_back(first_vertex.back() + static_cast<Index>(mesh.x.size()));
  }

  std::vector<Surface> surfaces() const {
    std::vector<Surface> all;
    for (std::size_t s = 0; s + 1 < first_triangle.size(); ++s) {
      const auto begin = static_cast<std::size_t>(first_triangle[s]),
                 end = static_cast<std::size_t>(first_triangle[s + 1]);
      all.push_back({std::span(triangles).subspan(begin, end - begin), first_triangle[s], first_vertex[s],
                     first_vertex[s + 1] - first_vertex[s]});
    }
    return all;
  }
};

/// A sheet of 1 m rolls up and unrolls. A second sheet slides over it and flutters. A ball of triangles flies through
/// both by 0.1 m in each of ten steps, rests for ten steps, and jumps back.
class FoldingSlidingFlying {
 public:
  explicit FoldingSlidingFlying(int n) : sheet_(folded_sheet(n, 1, 0)), ball_(triangle_soup(4, 20, 60, 0.1)) {
    scene_.add(sheet_);
    scene_.add(sheet_);
    scene_.add(ball_);
  }

  const MovingScene& scene() const { return scene_; }

  std::vector<Vec3> at(int step) const {
    const double phase = std::sin(0.15 * step), still = step % 20 < 10 ? step % 20 : 10;
    std::vector<Vec3> x;
    const double curl = 3.5 * phase * phase + 1e-3;  // angle of the roll [rad]
    for (const Vec3& p : sheet_.x)
      x.emplace_back(std::sin(curl * p[0]) / curl, p[1], (1 - std::cos(curl * p[0])) / curl);
    for (const Vec3& p : sheet_.x)
      x.emplace_back(p[0] + 0.3 * phase, p[1] + 0.02 * step, 0.02 + 0.01 * std::sin(9 * p[0] + 0.4 * step));
    for (const Vec3& p : ball_.x) x.push_back(0.3 * p + Vec3{0.5, 0.5, 0.5 - 0.1 * still});
    return x;
  }

 private:
  TestMesh sheet_, ball_;
  MovingScene scene_;
};

}  // namespace weft::collision::testing
