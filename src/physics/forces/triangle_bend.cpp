#include "physics/forces/triangle_bend.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace weft::forces {

namespace {

// Factors of the parts uu, vv and uv of the energy: the sum over ab counts uv twice, as uv and vu.
const Vec3 kMultiplicity(1, 1, 2);

/// The plane of a triangle: its unit normal, and the gradients of the barycentric coordinates.
struct Plane {
  Vec3 normal;
  std::array<Vec3, 3> gradients;  // [1/m]
};

Plane triangle_plane(const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double size = normal.norm();  // twice the area
  Plane plane{Vec3::Zero(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
  if (size == 0) return plane;  // a collapsed triangle bends as if flat at rest
  plane.normal = normal / size;
  for (std::size_t k = 0; k < 3; ++k)
    plane.gradients[k] = plane.normal.cross(corners[(k + 2) % 3] - corners[(k + 1) % 3]) / size;
  return plane;
}

template <class Points>
std::array<Vec3, 3> corners_of(std::span<const Index> particles, const Points& x) {
  return {solver::vec3_of(x[particles[0]]), solver::vec3_of(x[particles[1]]), solver::vec3_of(x[particles[2]])};
}

/// Returns the signed rest curvatures κ_uu, κ_vv and κ_uv. Changes the weights of the stencil so that it subtracts the
/// rest shape's in-plane curvature (see TriangleBend).
Vec3 extract_rest_curvature(CurvatureStencil& stencil, double area, const std::array<Vec2, 3>& material,
                            std::span<const Vec3> rest) {
  Mat3 curved = Mat3::Zero();
  for (std::size_t k = 0; k < stencil.vertices.size(); ++k)
    curved += rest[stencil.vertices[k]] * stencil.weights[k].transpose();
  if (curved.norm() * std::sqrt(area) < kRoundoff) return Vec3::Zero();
  const std::span<const Index> corners(stencil.vertices);
  const Vec3 normal = triangle_plane(corners_of(corners, rest)).normal;
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
  rebuild_elements();
  if (std::ranges::none_of(sheet_.triangles, [&](const auto& t) { return all_corners_marked(t, pinned_); }))
    sheet_ = {};
}

void TriangleBend::set_held(std::span<const char> held) {
  if (sheet_.triangles.empty()) return;
  const std::span<const char> own = held.subspan(static_cast<std::size_t>(first_), held_.size());
  const bool is_clamp_new = std::ranges::any_of(sheet_.triangles, [&](const mesh::Triangle& t) {
    return all_corners_marked(t, own) != all_corners_marked(t, held_);
  });
  held_.assign(own.begin(), own.end());
  if (is_clamp_new) rebuild_elements();
}

// Every call creates elements with the same particles in the same order, so the Jacobian keeps its sparsity pattern.
void TriangleBend::rebuild_elements() {
  elements_.clear(), particles_.clear(), weights_.clear();
  std::size_t pairs = 0;
  std::vector<CurvatureStencil> stencils = curvature_stencils(sheet_, pinned_, held_);
  for (std::size_t t = 0; t < stencils.size(); ++t) {
    double area = mesh::rest_area(sheet_, t);
    Vec3 rest = Vec3::Zero();
    if (!sheet_.sewn) rest = extract_rest_curvature(stencils[t], area, sheet_.material[t], sheet_.rest);
    if (!sheet_.reinforcements.empty()) area *= sheet_.reinforcements[t].bend;
    const std::size_t begin = particles_.size(), count = stencils[t].vertices.size();
    for (Index vertex : stencils[t].vertices) particles_.push_back(first_ + vertex);
    for (const Vec3& weight : stencils[t].weights) weights_.push_back(solver::padded<double>(weight));
    elements_.push_back({begin, begin + count, pairs, area, rest});
    pairs += count * (count - 1) / 2;
  }
  weights_.resize(weights_.size() + 3);  // add_pairs() loads four weights at a time
}

TriangleBend::Curvature TriangleBend::curvature(const Element& element, std::span<const PaddedVec3> x) const {
  PaddedVec3 uu{}, vv{}, uv{};
  for (std::size_t k = element.begin; k < element.end; ++k) {
    const PaddedVec3 &weight = weights_[k], &position = x[particles_[k]];
    uu += weight[0] * position;
    vv += weight[1] * position;
    uv += weight[2] * position;
  }
  return {uu, vv, uv};
}

Mat3 TriangleBend::curvature(const Element& element, std::span<const Vec3> x) const {
  Mat3 columns = Mat3::Zero();
  for (std::size_t k = element.begin; k < element.end; ++k)
    columns += x[particles_[k]] * solver::vec3_of(weights_[k]).transpose();
  return columns;
}

// Curvatures of the elements [first, first + count); `count` is at most four.
TriangleBend::CurvatureLanes TriangleBend::curvatures(std::size_t first, std::size_t count,
                                                      std::span<const PaddedVec3> x) const {
  std::array<Curvature, 4> of_elements{};
  for (std::size_t l = 0; l < count; ++l) of_elements[l] = curvature(elements_[first + l], x);
  CurvatureLanes lanes;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto axes = transposed(of_elements[0][c], of_elements[1][c], of_elements[2][c], of_elements[3][c]);
    lanes[c] = {axes[0], axes[1], axes[2]};
  }
  return lanes;
}

void TriangleBend::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Element& element : elements_) append_pairs_of(particles(element), pairs);
}

// False if rest curvature needs full blocks.
bool TriangleBend::isotropic() const {
  return std::ranges::all_of(elements_, [](const Element& element) { return element.rest.isZero(0); });
}

void TriangleBend::attach(const solver::Assembly& assembly) {
  const bool curved = !isotropic();
  scalars_.clear(), blocks_.clear();
  for (const Element& element : elements_)
    for (std::size_t a = element.begin; a < element.end; ++a)
      for (std::size_t b = a + 1; b < element.end; ++b) {
        const auto [i, j] = std::minmax(particles_[a], particles_[b]);
        scalars_.push_back(assembly.scalar(i, j));
        if (curved) blocks_.push_back(assembly.block(i, j));
      }
}

void TriangleBend::partition(std::span<const Index> bounds) {
  ranges_.partition(bounds, packs_of(elements_.size()), [&](std::size_t pack, const auto& visit) {
    for (std::size_t e = 4 * pack; e < std::min(4 * pack + 4, elements_.size()); ++e)
      for (Index particle : particles(elements_[e])) visit(particle);
  });
}

void TriangleBend::add(const Evaluation& at) const {
  std::vector<double> scratch;
  ranges_.for_each(at.range, packs_of(elements_.size()), [&](std::size_t pack) {
    const std::size_t first = 4 * pack, count = std::min<std::size_t>(4, elements_.size() - first);
    const std::span<const Element> elements(elements_.data() + first, count);
    const CurvatureLanes curved = curvatures(first, count, at.x);
    CurvatureLanes velocity;
    if (damping_.is_active()) velocity = curvatures(first, count, at.v);
    Lanes area{};
    for (std::size_t l = 0; l < count; ++l) area[l] = elements[l].area;

    // Moments for s_uu, s_vv and s_uv, and the stiffness of damping. As in Bend, the stiffness of
    // damping contains ‖c‖² I instead of c cᵀ (measured: the scene catwalk takes no more iterations
    // than with c cᵀ).
    std::array<std::array<PaddedVec3, 4>, 3> moments;
    std::array<Lanes, 3> stiffness{};
    for (std::size_t k = 0; k < 3; ++k) {
      VecLanes moment = lanes_of(rigidity_) * curved[k];
      if (damping_.is_active()) {
        const VecLanes c = at.rate > 0 ? curved[k] - lanes_of(1 / at.rate) * velocity[k] : curved[k];
        const Lanes c_sq = dot(c, c), rate = dot(c, velocity[k]), secant = damping_.secant(c_sq, rate);
        moment = moment + secant * rate * c;
        stiffness[k] = at.rate * kMultiplicity[k] * area * secant * c_sq;
      }
      moment = kMultiplicity[k] * area * moment;
      moments[k] = transposed(moment.x, moment.y, moment.z, lanes_of(0.0));
    }
    for (std::size_t l = 0; l < count; ++l) {
      const PaddedVec3 of_uu = moments[0][l], of_vv = moments[1][l], of_uv = moments[2][l];
      for (std::size_t k = elements[l].begin; k < elements[l].end; ++k) {
        const PaddedVec3& w = weights_[k];
        at.force.subtract(particles_[k], w[0] * of_uu + w[1] * of_vv + w[2] * of_uv);
      }
      if (!elements[l].rest.isZero(0)) add_rest_moment(elements[l], curvature(elements[l], at.x), at);
      if (at.assembly && damping_.is_active())
        add_pairs(elements[l], {stiffness[0][l], stiffness[1][l], stiffness[2][l]}, scratch, at.assembly);
    }
  });
}

// Adds Σ_c stiffness[c] w_a[c] w_b[c] for all pairs (a, b) of particles with weights w, where c is uu, vv and uv.
// Computes four pairs at a time.
void TriangleBend::add_pairs(const Element& element, const Vec3& stiffness, std::vector<double>& scratch,
                             const solver::AssemblyRows& assembly) const {
  const std::size_t count = element.end - element.begin, stride = 4 * packs_of(count);
  if (scratch.size() < 4 * stride) scratch.resize(4 * stride);
  double* const uu = scratch.data();
  double* const vv = uu + stride;
  double* const uv = vv + stride;
  double* const row = uv + stride;
  const PaddedVec3* weights = weights_.data() + element.begin;
  for (std::size_t k = 0; k < count; k += 4) {
    const auto columns = transposed(weights[k], weights[k + 1], weights[k + 2], weights[k + 3]);
    solver::store_padded(uu + k, columns[0]);
    solver::store_padded(vv + k, columns[1]);
    solver::store_padded(uv + k, columns[2]);
  }
  const Index* scalar = scalars_.data() + element.pairs;
  for (std::size_t a = 0; a + 1 < count; ++a) {
    const double of_uu = stiffness[0] * uu[a], of_vv = stiffness[1] * vv[a], of_uv = stiffness[2] * uv[a];
    for (std::size_t b = (a + 1) / 4 * 4; b < count; b += 4)
      solver::store_padded(row + b, of_uu * solver::load_padded(uu + b) + of_vv * solver::load_padded(vv + b) +
                                        of_uv * solver::load_padded(uv + b));
    for (std::size_t b = a + 1; b < count; ++b) assembly.add_scalar(*scalar++, row[b]);
  }
}

// Forces and stiffness of the energy −B A n·m with m = Σ κ_ab s_ab = Σ_k rest_weight(k) x_k. Calls push(k, force) for
// all particles, and twice for corners. Calls add_block(a, b, block) for all pairs that contain a corner; one pair may
// get several blocks.
//
// If g_k is the gradient of corner k's barycentric coordinate, then δn = −Σ_k g_k (n·δx_k) and δg_k = −Σ_j g_j
// (g_k·δx_j) + n Σ_j (g_k·g_j)(n·δx_j). If `exact` is false, the blocks are the Gauss-Newton matrix of ‖s_ab − κ_ab n‖²
// without its constant part; together with that part, they are positive semidefinite.
template <class Push, class AddBlock>
void TriangleBend::rest_moment(const Element& element, const Mat3& curved, const std::array<Vec3, 3>& corners,
                               bool exact, const Push& push, const AddBlock& add_block) const {
  const auto [n, g] = triangle_plane(corners);
  const Vec3 rest = kMultiplicity.cwiseProduct(element.rest);
  const Vec3 m = curved * rest;
  const double size = rigidity_ * element.area;
  const std::size_t count = element.end - element.begin;
  const auto rest_weight = [&](std::size_t k) { return rest.dot(solver::vec3_of(weights_[element.begin + k])); };
  for (std::size_t k = 0; k < count; ++k) push(k, Vec3(size * rest_weight(k) * n));
  for (std::size_t k = 0; k < 3; ++k) push(k, Vec3(-size * m.dot(g[k]) * n));

  for (std::size_t k = 0; k < 3; ++k) {
    const Mat3 turn = size * n * g[k].transpose();
    for (std::size_t j = 0; j < count; ++j) {
      add_block(k, j, Mat3(rest_weight(j) * turn));
      add_block(j, k, Mat3(rest_weight(j) * turn.transpose()));
    }
    for (std::size_t j = 0; j < 3; ++j) {
      Mat3 block;
      if (exact)
        block = m.dot(n) * g[k].dot(g[j]) * n * n.transpose() - m.dot(g[j]) * n * g[k].transpose() -
                m.dot(g[k]) * g[j] * n.transpose();
      else
        block = rest.dot(element.rest) * g[k].dot(g[j]) * n * n.transpose();
      add_block(k, j, Mat3(size * block));
    }
  }
}

void TriangleBend::add_rest_moment(const Element& element, const Curvature& curved, const Evaluation& at) const {
  Mat3 columns;
  for (int c = 0; c < 3; ++c) columns.col(c) = solver::vec3_of(curved[c]);
  const std::span<const Index> particle = particles(element);
  const auto push = [&](std::size_t k, const Vec3& force) { at.force.add(particle[k], solver::padded<double>(force)); };
  const auto add_block = [&](std::size_t a, std::size_t b, const Mat3& block) {
    if (!at.assembly || particle[a] >= particle[b]) return;
    // The index of a pair (i, j) is the number of pairs before it, in the order 01, 02, ... 12, ...
    const std::size_t count = particle.size(), i = std::min(a, b), j = std::max(a, b);
    at.assembly.add(blocks_[element.pairs + i * (2 * count - i - 1) / 2 + (j - i - 1)], block);
  };
  rest_moment(element, columns, corners_of(particle, at.x), false, push, add_block);
}

void TriangleBend::add_constant_stiffness(solver::Assembly& assembly) const {
  std::vector<double> scratch;
  for (const Element& element : elements_)
    add_pairs(element, rigidity_ * element.area * kMultiplicity, scratch, assembly);
}

void TriangleBend::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                                solver::BlockMatrix& jacobian) const {
  for (const Element& element : elements_) {
    const std::span<const Index> particle = particles(element);
    const Mat3 curved = curvature(element, x), velocity = curvature(element, v);
    const auto add_block = [&](std::size_t a, std::size_t b, const Mat3& block) {
      jacobian.add(jacobian.slot(particle[a], particle[b]), block);
    };
    for (int k = 0; k < 3; ++k) {
      const Mat3 stiffness = element.area * kMultiplicity[k] *
                             (rigidity_ * Mat3::Identity() + damping_.stiffness(curved.col(k), velocity.col(k), rate));
      for (std::size_t a = 0; a < particle.size(); ++a)
        for (std::size_t b = 0; b < particle.size(); ++b)
          add_block(a, b, weights_[element.begin + a][k] * weights_[element.begin + b][k] * stiffness);
    }
    if (!element.rest.isZero(0))
      rest_moment(
          element, curved, corners_of(particle, x), true, [](std::size_t, const Vec3&) {}, add_block);
  }
}

double TriangleBend::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Element& element : elements_) {
    Mat3 change = curvature(element, x);
    if (!element.rest.isZero(0))
      change -= triangle_plane(corners_of(particles(element), x)).normal * element.rest.transpose();
    sum += 0.5 * rigidity_ * element.area * kMultiplicity.dot(change.colwise().squaredNorm().transpose());
  }
  return sum;
}

}  // namespace weft::forces
