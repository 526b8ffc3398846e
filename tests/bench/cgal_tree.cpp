#include "bench/cgal_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

#include "bench/measure.hpp"

namespace weft::bench {

CgalCosts cgal_self_pairs(std::span<const Vec3> x, std::span<const std::array<Index, 3>> triangles, double reach) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Soup = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Soup::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  Soup soup;
  for (const auto& t : triangles) {
    const auto at = [&](std::size_t c) {
      const Vec3& p = x[static_cast<std::size_t>(t[c])];
      return Kernel::Point_3(p[0], p[1], p[2]);
    };
    soup.emplace_back(at(0), at(1), at(2));
  }
  CgalCosts costs;
  Tree tree;
  costs.build_ms = median_ms(3, [&] {
    tree.clear();
    tree.insert(soup.begin(), soup.end());
    tree.build();
  });
  std::vector<Soup::const_iterator> found;
  costs.query_ms = median_ms(1, [&] {
    for (std::size_t t = 0; t < soup.size(); ++t) {
      const CGAL::Bbox_3 box = soup[t].bbox();
      found.clear();
      tree.all_intersected_primitives(
          Kernel::Iso_cuboid_3(Kernel::Point_3(box.xmin() - reach, box.ymin() - reach, box.zmin() - reach),
                               Kernel::Point_3(box.xmax() + reach, box.ymax() + reach, box.zmax() + reach)),
          std::back_inserter(found));
      for (const auto other : found)
        costs.pairs += static_cast<std::size_t>(other - soup.begin() > static_cast<std::ptrdiff_t>(t));
    }
  });
  return costs;
}

}  // namespace weft::bench
