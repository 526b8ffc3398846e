#include "physics/forces/stretch.hpp"

#include <cmath>

namespace weft::forces {

Stretch::Stretch(const mesh::Grid& grid, Index first, const StretchParameters& parameters)
    : Membrane(first), viscous_(parameters.viscosity > 0) {
  std::vector<Edge> edges;
  const auto add_edge = [&](Index i, Index j, double l, double width, double k) {
    const double per_length_sq = width * l / (l * l);  // A / l²
    edges.push_back({first + i, first + j, l, k * per_length_sq, parameters.viscosity * per_length_sq});
  };
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      if (i + 1 < grid.nu)
        add_edge(grid.index(i, j), grid.index(i + 1, j), grid.du(i), grid.width_v(j), parameters.weft);
      if (j + 1 < grid.nv)
        add_edge(grid.index(i, j), grid.index(i, j + 1), grid.dv(j), grid.width_u(i), parameters.warp);
    }
  }
  count_ = edges.size();
  packs_.resize(packs_of(count_));
  for (std::size_t p = 0; p < packs_.size(); ++p)
    for_each_lane(count_, p, [&](std::size_t e, std::size_t lane, bool counts) {
      const Edge& edge = edges[e];
      packs_[p].i[lane] = edge.i;
      packs_[p].j[lane] = edge.j;
      packs_[p].rest_length[lane] = edge.rest_length;
      packs_[p].elasticity[lane] = counts ? edge.elasticity : 0;
      packs_[p].viscosity[lane] = counts ? edge.viscosity : 0;
    });
}

template <class Body>
void Stretch::for_each_edge(const Body& body) const {
  for (std::size_t e = 0; e < count_; ++e) {
    const Edges& pack = packs_[e / 4];
    const std::size_t lane = e % 4;
    body(Edge{pack.i[lane], pack.j[lane], pack.rest_length[lane], pack.elasticity[lane], pack.viscosity[lane]});
  }
}

void Stretch::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for_each_edge([&](const Edge& edge) { pairs.emplace_back(edge.i, edge.j); });
}

void Stretch::attach(const solver::Assembly& assembly) {
  for (Edges& pack : packs_)
    for (std::size_t lane = 0; lane < 4; ++lane) pack.block[lane] = assembly.block(pack.i[lane], pack.j[lane]);
}

void Stretch::partition(std::span<const Index> bounds) {
  cut_packs(
      bounds, packs_,
      [](const Edges& edges) {
        return std::array{edges.i, edges.j};
      },
      ranges_);
}

void Stretch::add(const Evaluation& at) const {
  ranges_.for_each(at.range, packs_.size(), [&](std::size_t p) {
    const Edges& edges = packs_[p];
    const VecLanes d = gather(at.x, edges.j) - gather(at.x, edges.i);
    const Lanes length = max(sqrt(dot(d, d)), kMinStretch * edges.rest_length);
    const VecLanes n = 1 / length * d;
    Lanes tension = edges.elasticity * (length - edges.rest_length);
    if (viscous_)
      tension += edges.viscosity * at.rate_of(
                                       length,
                                       [&](std::span<const Vec3> x) {
                                         const VecLanes then = gather(x, edges.j) - gather(x, edges.i);
                                         return sqrt(dot(then, then));
                                       },
                                       [&] { return dot(n, gather(at.v, edges.j) - gather(at.v, edges.i)); });
    const VecLanes pull = tension * n;
    forces::add(at.force, edges.i, pull);
    subtract(at.force, edges.j, pull);
    if (!at.assembly) return;

    // Across the edge, tension causes positive stiffness, and compression negative stiffness. The
    // matrix omits the negative stiffness, so that it stays positive semidefinite.
    const Lanes lateral = edges.elasticity * max(1 - edges.rest_length / length, lanes_of(0.0));
    const Lanes along = edges.elasticity + at.rate * edges.viscosity;
    forces::add(at.assembly, edges.block, outer((lateral - along) * n, n, -lateral));
  });
}

// Here, the viscous force is proportional to (n·w) n, where n is the direction of the edge and w
// the relative velocity of its ends. The matrix of add() omits the part of the derivative of
// viscous forces that comes from the change of n, O(η‖w‖/l): this part may be indefinite, and is
// unsymmetric if Evaluation::past is empty. Therefore Newton's method converges only linearly with
// viscosity.
void Stretch::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                           solver::BlockMatrix& jacobian) const {
  for_each_edge([&](const Edge& edge) {
    jacobian.add_spring(edge.i, edge.j,
                        spring_stiffness(x[edge.j] - x[edge.i], v[edge.j] - v[edge.i], edge.rest_length,
                                         edge.elasticity, edge.viscosity, rate));
  });
}

double Stretch::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for_each_edge([&](const Edge& e) {
    const double extension = (x[e.j] - x[e.i]).norm() - e.rest_length;
    sum += 0.5 * e.elasticity * extension * extension;
  });
  return sum;
}

void Stretch::for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const {
  for_each_edge([&](const Edge& e) {
    const double length = (x[e.j] - x[e.i]).norm();
    visit(std::abs(length / e.rest_length - 1), std::array{e.i, e.j});
  });
}

}  // namespace weft::forces
