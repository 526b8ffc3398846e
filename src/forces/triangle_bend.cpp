#include "forces/triangle_bend.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace weft::forces {
namespace {

// 2 ‖s_uv‖²: the mixed derivative counts twice.
const Vec3 kCount(1, 1, 2);
// Rest curvature times the size of the triangle below which it is rounding.
constexpr double kFlatRest = 1e-9;

/// The plane of a triangle: its unit normal and the gradients of the corners' weights.
struct Plane {
  Vec3 normal;
  std::array<Vec3, 3> gradients;  // [1/m]
};

Plane plane_of(const std::vector<Index>& particles, std::span<const Vec3> x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[static_cast<std::size_t>(particles[k % 3])]; };
  const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const double size = normal.norm();  // twice the area
  Plane plane{Vec3::Zero(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
  if (size == 0) return plane;  // a collapsed triangle faces nowhere: it bends as if it were flat at rest
  plane.normal = normal / size;
  for (std::size_t k = 0; k < 3; ++k) plane.gradients[k] = plane.normal.cross(corner(k + 2) - corner(k + 1)) / size;
  return plane;
}

}  // namespace

TriangleBend::TriangleBend(const mesh::Sheet& sheet, Index first, const BendParameters& parameters)
    : rigidity_(parameters.rigidity), damping_(parameters) {
  const std::vector<CurvatureStencil> stencils = curvature_stencils(sheet);
  for (std::size_t t = 0; t < stencils.size(); ++t) {
    Element element{stencils[t].vertices, stencils[t].weights, mesh::rest_area(sheet, t), Vec3::Zero(), {}};
    if (!sheet.sewn) find_rest(element, sheet.material[t], sheet.rest);
    for (Index& particle : element.particles) particle += first;
    elements_.push_back(std::move(element));
  }
}

// Signed curvature of the rest shape; what it has in the plane is taken out of the weights.
void TriangleBend::find_rest(Element& element, const std::array<Vec2, 3>& material, std::span<const Vec3> rest) {
  const Mat3 curved = curvature(element, rest);
  if (curved.norm() * std::sqrt(element.area) < kFlatRest) return;
  const Plane plane = plane_of(element.particles, rest);
  element.rest = curved.transpose() * plane.normal;
  Eigen::Matrix2d sides;
  sides << material[1] - material[0], material[2] - material[0];
  const Eigen::Matrix2d inverse = sides.inverse();
  const std::array<Vec2, 3> gradients{-(inverse.row(0) + inverse.row(1)).transpose(), inverse.row(0).transpose(),
                                      inverse.row(1).transpose()};
  std::array<Vec3, 2> tangents{Vec3::Zero(), Vec3::Zero()};  // s_u and s_v at rest
  for (std::size_t k = 0; k < 3; ++k)
    for (int axis = 0; axis < 2; ++axis)
      tangents[static_cast<std::size_t>(axis)] +=
          gradients[k][axis] * rest[static_cast<std::size_t>(element.particles[k])];
  for (std::size_t k = 0; k < 3; ++k)
    for (int axis = 0; axis < 2; ++axis)
      element.weights[k] -= gradients[k][axis] * (curved.transpose() * tangents[static_cast<std::size_t>(axis)]);
}

Mat3 TriangleBend::curvature(const Element& element, std::span<const Vec3> x) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t k = 0; k < element.particles.size(); ++k)
    sum += x[static_cast<std::size_t>(element.particles[k])] * element.weights[k].transpose();
  return sum;
}

void TriangleBend::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Element& element : elements_)
    for (std::size_t a = 0; a < element.particles.size(); ++a)
      for (std::size_t b = a + 1; b < element.particles.size(); ++b)
        pairs.emplace_back(element.particles[a], element.particles[b]);
}

void TriangleBend::attach(const solver::BlockMatrix& matrix) {
  for (Element& element : elements_) {
    element.slots.clear();
    for (Index a : element.particles)
      for (Index b : element.particles) element.slots.push_back(matrix.slot(a, b));
  }
}

void TriangleBend::add(const Evaluation& at) const {
  for (const Element& element : elements_) {
    const Mat3 curved = curvature(element, at.x);
    Mat3 moment = rigidity_ * curved;
    if (damping_.any()) add_damping(element, curved, at, moment);
    for (std::size_t k = 0; k < element.particles.size(); ++k)
      at.force[static_cast<std::size_t>(element.particles[k])] -=
          element.area * moment * kCount.cwiseProduct(element.weights[k]);
    if (!element.rest.isZero(0)) add_rest_moment(element, curved, at);
  }
}

// moment += viscosity and friction; their Jacobian goes into the matrix, if there is one.
void TriangleBend::add_damping(const Element& element, const Mat3& curved, const Evaluation& at, Mat3& moment) const {
  const Mat3 velocity = curvature(element, at.v);
  std::array<Mat3, 3> blocks;
  for (int c = 0; c < 3; ++c) {
    if (at.matrix == nullptr) {
      moment.col(c) += damping_.moment(curved.col(c), velocity.col(c));
      continue;
    }
    const auto linearised = damping_.linearised(curved.col(c), velocity.col(c), at.rate, at.linearisation);
    moment.col(c) += linearised.moment;
    blocks[static_cast<std::size_t>(c)] = element.area * kCount[c] * linearised.jacobian;
  }
  if (at.matrix == nullptr) return;
  const std::size_t count = element.particles.size();
  for (std::size_t a = 0; a < count; ++a) {
    const std::array<Mat3, 3> rows{element.weights[a][0] * blocks[0], element.weights[a][1] * blocks[1],
                                   element.weights[a][2] * blocks[2]};
    for (std::size_t b = 0; b < count; ++b) {
      const Vec3& w = element.weights[b];
      at.matrix->add(element.slots[a * count + b], w[0] * rows[0] + w[1] * rows[1] + w[2] * rows[2]);
    }
  }
}

// The energy −B A n·m, m = Σ κ_ab s_ab = Σ_k c_k x_k, and what goes with it into the matrix.
//
// With g_k the gradient of corner k's weight in the plane, δn = −Σ_k g_k (n·δx_k) and
// δg_k = −Σ_j g_j (g_k·δx_j) + n Σ_j (g_k·g_j)(n·δx_j). The definite form is that of Gauss and Newton for
// ‖s_ab − κ_ab n‖², definite together with the constant part.
void TriangleBend::add_rest_moment(const Element& element, const Mat3& curved, const Evaluation& at) const {
  const auto [n, g] = plane_of(element.particles, at.x);
  const Vec3 rest = kCount.cwiseProduct(element.rest);
  const Vec3 m = curved * rest;
  const double size = rigidity_ * element.area;
  const std::size_t count = element.particles.size();
  for (std::size_t k = 0; k < count; ++k)
    at.force[static_cast<std::size_t>(element.particles[k])] += size * rest.dot(element.weights[k]) * n;
  for (std::size_t k = 0; k < 3; ++k)
    at.force[static_cast<std::size_t>(element.particles[k])] -= size * m.dot(g[k]) * n;
  if (at.matrix == nullptr) return;

  for (std::size_t k = 0; k < 3; ++k) {
    const Mat3 turn = size * n * g[k].transpose();
    for (std::size_t j = 0; j < count; ++j) {
      const double c = rest.dot(element.weights[j]);
      at.matrix->add(element.slots[k * count + j], c * turn);
      at.matrix->add(element.slots[j * count + k], c * turn.transpose());
    }
    for (std::size_t j = 0; j < 3; ++j) {
      Mat3 block;
      if (at.linearisation == Linearisation::exact)
        block = m.dot(n) * g[k].dot(g[j]) * n * n.transpose() - m.dot(g[j]) * n * g[k].transpose() -
                m.dot(g[k]) * g[j] * n.transpose();
      else
        block = rest.dot(element.rest) * g[k].dot(g[j]) * n * n.transpose();
      at.matrix->add(element.slots[k * count + j], size * block);
    }
  }
}

void TriangleBend::add_constant_stiffness(solver::BlockMatrix& matrix) const {
  for (const Element& element : elements_) {
    const std::size_t count = element.particles.size();
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b)
        matrix.add_scalar(element.slots[a * count + b],
                          rigidity_ * element.area * kCount.cwiseProduct(element.weights[a]).dot(element.weights[b]));
  }
}

double TriangleBend::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Element& element : elements_) {
    Mat3 change = curvature(element, x);
    if (!element.rest.isZero(0)) change -= plane_of(element.particles, x).normal * element.rest.transpose();
    sum += 0.5 * rigidity_ * element.area * kCount.dot(change.colwise().squaredNorm().transpose());
  }
  return sum;
}

}  // namespace weft::forces
