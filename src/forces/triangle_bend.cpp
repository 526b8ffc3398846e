#include "forces/triangle_bend.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace weft::forces {

namespace {

// 2 ‖s_uv‖²: the mixed derivative counts twice.
const Vec3 kCount(1, 1, 2);
const Eigen::Array4d kCounts(1, 1, 2, 0);
// Rest curvature times the size of the triangle below which it is rounding.
constexpr double kFlatRest = 1e-9;

/// s_uu, s_vv and s_uv as columns.
Mat3 columns_of(const std::array<Eigen::Array4d, 3>& curvature) {
  Mat3 columns;
  for (int d = 0; d < 3; ++d) columns.row(d) = curvature[d].head<3>();
  return columns;
}

/// The plane of a triangle: its unit normal and the gradients of the corners' weights.
struct Plane {
  Vec3 normal;
  std::array<Vec3, 3> gradients;  // [1/m]
};

Plane plane_of(std::span<const Index> particles, std::span<const Vec3> x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[particles[k % 3]]; };
  const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const double size = normal.norm();  // twice the area
  Plane plane{Vec3::Zero(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
  if (size == 0) return plane;  // a collapsed triangle faces nowhere: it bends as if it were flat at rest
  plane.normal = normal / size;
  for (std::size_t k = 0; k < 3; ++k) plane.gradients[k] = plane.normal.cross(corner(k + 2) - corner(k + 1)) / size;
  return plane;
}

/// Signed curvature of the rest shape of a triangle, s_uu, s_vv and s_uv; what it has in the plane is taken out of the
/// stencil.
Vec3 take_rest(CurvatureStencil& stencil, double area, const std::array<Vec2, 3>& material,
               std::span<const Vec3> rest) {
  Mat3 curved = Mat3::Zero();
  for (std::size_t k = 0; k < stencil.vertices.size(); ++k)
    curved += rest[stencil.vertices[k]] * stencil.weights[k].transpose();
  if (curved.norm() * std::sqrt(area) < kFlatRest) return Vec3::Zero();
  const std::span<const Index> corners(stencil.vertices);
  const Vec3 normal = plane_of(corners, rest).normal;
  Eigen::Matrix2d sides;
  sides << material[1] - material[0], material[2] - material[0];
  const Eigen::Matrix2d inverse = sides.inverse();
  const std::array<Vec2, 3> gradients{-(inverse.row(0) + inverse.row(1)).transpose(), inverse.row(0).transpose(),
                                      inverse.row(1).transpose()};
  std::array<Vec3, 2> tangents{Vec3::Zero(), Vec3::Zero()};  // s_u and s_v at rest
  for (std::size_t k = 0; k < 3; ++k)
    for (int axis = 0; axis < 2; ++axis) tangents[axis] += gradients[k][axis] * rest[corners[k]];
  for (std::size_t k = 0; k < 3; ++k)
    for (int axis = 0; axis < 2; ++axis) stencil.weights[k] -= gradients[k][axis] * curved.transpose() * tangents[axis];
  return curved.transpose() * normal;
}

}  // namespace

TriangleBend::TriangleBend(const mesh::Sheet& sheet, Index first, const BendParameters& parameters,
                           std::span<const char> pinned)
    : first_(first), rigidity_(parameters.rigidity), damping_(parameters), sheet_(sheet) {
  if (!pinned.empty()) pinned_.assign(pinned.begin() + first, pinned.begin() + first + std::ssize(sheet.rest));
  held_ = pinned_;
  use_held();
  if (std::ranges::count(pinned_, 0) == std::ssize(pinned_)) sheet_ = {};
}

void TriangleBend::hold(std::span<const char> held) {
  if (sheet_.triangles.empty()) return;
  const std::span<const char> own = held.subspan(static_cast<std::size_t>(first_), held_.size());
  if (std::ranges::equal(own, held_)) return;
  held_.assign(own.begin(), own.end());
  use_held();
}

// The same particles in the same order, whatever is held.
void TriangleBend::use_held() {
  elements_.clear(), particles_.clear(), weights_.clear();
  std::size_t pairs = 0;
  std::vector<CurvatureStencil> stencils = curvature_stencils(sheet_, pinned_, held_);
  for (std::size_t t = 0; t < stencils.size(); ++t) {
    const double area = mesh::rest_area(sheet_, t);
    Vec3 rest = Vec3::Zero();
    if (!sheet_.sewn) rest = take_rest(stencils[t], area, sheet_.material[t], sheet_.rest);
    const std::size_t begin = particles_.size(), count = stencils[t].vertices.size();
    for (Index vertex : stencils[t].vertices) particles_.push_back(first_ + vertex);
    for (const Vec3& weight : stencils[t].weights) weights_.emplace_back(weight.x(), weight.y(), weight.z(), 0);
    elements_.push_back({begin, begin + count, pairs, area, rest});
    pairs += count * count;
  }
}

TriangleBend::Curvature TriangleBend::curvature(const Element& element, std::span<const Vec3> x) const {
  Lanes of_x = Lanes::Zero(), of_y = Lanes::Zero(), of_z = Lanes::Zero();
  const Index* particle = particles_.data();
  const Lanes* weight = weights_.data();
  for (std::size_t k = element.begin; k < element.end; ++k) {
    const Vec3& position = x[particle[k]];
    of_x += position.x() * weight[k];
    of_y += position.y() * weight[k];
    of_z += position.z() * weight[k];
  }
  return {of_x, of_y, of_z};
}

void TriangleBend::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Element& element : elements_)
    for (std::size_t a = element.begin; a < element.end; ++a)
      for (std::size_t b = a + 1; b < element.end; ++b) pairs.emplace_back(particles_[a], particles_[b]);
}

// But for the moments of rest curvature.
bool TriangleBend::isotropic() const {
  return std::ranges::all_of(elements_, [](const Element& element) { return element.rest.isZero(0); });
}

void TriangleBend::attach(const solver::BlockMatrix& matrix) {
  slots_.clear();
  for (const Element& element : elements_)
    for (Index a : particles(element))
      for (Index b : particles(element)) slots_.push_back(matrix.slot(a, b));
}

void TriangleBend::add(const Evaluation& at) const {
  for (const Element& element : elements_) {
    const Curvature curved = curvature(element, at.x);
    Curvature moment{rigidity_ * curved[0], rigidity_ * curved[1], rigidity_ * curved[2]};
    if (damping_.any()) add_damping(element, curved, at, moment);
    // Moments against s_uu, s_vv and s_uv, each as (x, y, z, 0).
    const auto moment_of = [&](int c) -> Lanes {
      return element.area * kCounts[c] * Lanes(moment[0][c], moment[1][c], moment[2][c], 0);
    };
    const Lanes of_uu = moment_of(0), of_vv = moment_of(1), of_uv = moment_of(2);
    for (std::size_t k = element.begin; k < element.end; ++k) {
      const Lanes& w = weights_[k];
      const Lanes force = w[0] * of_uu + w[1] * of_vv + w[2] * of_uv;
      at.force[particles_[k]] -= force.head<3>().matrix();
    }
    if (!element.rest.isZero(0)) add_rest_moment(element, columns_of(curved), at);
  }
}

// moment += viscosity and friction; their Jacobian goes into the matrix, if there is one.
void TriangleBend::add_damping(const Element& element, const Curvature& curved, const Evaluation& at,
                               Curvature& moment) const {
  const Curvature velocity = curvature(element, at.v);
  Curvature c = curved;
  for (std::size_t d = 0; d < 3 && at.rate > 0; ++d) c[d] -= velocity[d] / at.rate;
  const Lanes c_sq = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
  const Lanes rate = c[0] * velocity[0] + c[1] * velocity[1] + c[2] * velocity[2];
  const auto [secant, tangent] = damping_.respond(c_sq, rate);
  const Lanes size = secant * rate;
  for (std::size_t d = 0; d < 3; ++d) moment[d] += size * c[d];
  if (at.matrix == nullptr) return;
  if (at.linearisation == Linearisation::exact)
    add_exact_blocks(element, columns_of(c), at.rate * tangent, *at.matrix);
  else
    add_stiffness(element, element.area * at.rate * kCounts * secant * c_sq, *at.matrix);
}

// As Bend, with ‖c‖² I in place of c cᵀ: the catwalk takes no more iterations.
void TriangleBend::add_stiffness(const Element& element, const Lanes& stiffness, solver::BlockMatrix& matrix) const {
  const std::size_t count = element.end - element.begin;
  const solver::Slot* slots = slots_.data() + element.slots;
  const Lanes* weights = weights_.data() + element.begin;
  for (std::size_t a = 0; a < count; ++a) {
    const Lanes row = stiffness * weights[a];
    for (std::size_t b = a; b < count; ++b) {
      const double value = (row * weights[b]).sum();
      matrix.add_scalar(slots[a * count + b], value);
      if (b != a) matrix.add_scalar(slots[b * count + a], value);
    }
  }
}

void TriangleBend::add_exact_blocks(const Element& element, const Mat3& c, const Lanes& stiffness,
                                    solver::BlockMatrix& matrix) const {
  const std::size_t count = element.end - element.begin;
  for (int k = 0; k < 3; ++k) {
    const Mat3 block = element.area * kCount[k] * stiffness[k] * c.col(k) * c.col(k).transpose();
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b)
        matrix.add(slots_[element.slots + a * count + b],
                   weights_[element.begin + a][k] * weights_[element.begin + b][k], block);
  }
}

// The energy −B A n·m, m = Σ κ_ab s_ab = Σ_k c_k x_k, and what goes with it into the matrix.
//
// With g_k the gradient of corner k's weight in the plane, δn = −Σ_k g_k (n·δx_k) and
// δg_k = −Σ_j g_j (g_k·δx_j) + n Σ_j (g_k·g_j)(n·δx_j). The definite form is that of Gauss and Newton for
// ‖s_ab − κ_ab n‖², definite together with the constant part.
void TriangleBend::add_rest_moment(const Element& element, const Mat3& curved, const Evaluation& at) const {
  const auto [n, g] = plane_of(particles(element), at.x);
  const Vec3 rest = kCount.cwiseProduct(element.rest);
  const Vec3 m = curved * rest;
  const double size = rigidity_ * element.area;
  const std::size_t count = element.end - element.begin;
  const Index* particle = particles_.data() + element.begin;
  const solver::Slot* slots = slots_.data() + element.slots;
  const auto turned = [&](std::size_t k) { return rest.dot(weights_[element.begin + k].head<3>().matrix()); };
  for (std::size_t k = 0; k < count; ++k) at.force[particle[k]] += size * turned(k) * n;
  for (std::size_t k = 0; k < 3; ++k) at.force[particle[k]] -= size * m.dot(g[k]) * n;
  if (at.matrix == nullptr) return;

  for (std::size_t k = 0; k < 3; ++k) {
    const Mat3 turn = size * n * g[k].transpose();
    for (std::size_t j = 0; j < count; ++j) {
      at.matrix->add(slots[k * count + j], turned(j), turn);
      at.matrix->add(slots[j * count + k], turned(j), turn.transpose());
    }
    for (std::size_t j = 0; j < 3; ++j) {
      Mat3 block;
      if (at.linearisation == Linearisation::exact)
        block = m.dot(n) * g[k].dot(g[j]) * n * n.transpose() - m.dot(g[j]) * n * g[k].transpose() -
                m.dot(g[k]) * g[j] * n.transpose();
      else
        block = rest.dot(element.rest) * g[k].dot(g[j]) * n * n.transpose();
      at.matrix->add(slots[k * count + j], size * block);
    }
  }
}

void TriangleBend::add_constant_stiffness(solver::BlockMatrix& matrix) const {
  for (const Element& element : elements_) {
    const solver::Slot* slot = slots_.data() + element.slots;
    for (std::size_t a = element.begin; a < element.end; ++a)
      for (std::size_t b = element.begin; b < element.end; ++b)
        matrix.add_scalar(*slot++, rigidity_ * element.area * (kCounts * weights_[a] * weights_[b]).sum());
  }
}

double TriangleBend::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Element& element : elements_) {
    Mat3 change = columns_of(curvature(element, x));
    if (!element.rest.isZero(0)) change -= plane_of(particles(element), x).normal * element.rest.transpose();
    sum += 0.5 * rigidity_ * element.area * kCount.dot(change.colwise().squaredNorm().transpose());
  }
  return sum;
}

}  // namespace weft::forces
