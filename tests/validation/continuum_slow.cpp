// Compares the stiffness of quads and triangles with the continuum, on meshes of every kind.
#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "forces/sheets.hpp"
#include "forces/triangle_meshes.hpp"
#include "physics/mesh/quads.hpp"

namespace weft::forces {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array<int, 4> kCells{8, 16, 32, 64};  // along a side of one metre

/// A square metre of cloth at rest: mesh, forces, and the area of each particle.
struct Sample {
  mesh::Mesh mesh;
  std::vector<std::unique_ptr<Force>> forces;
  std::vector<double> areas;
};

struct Material {
  StretchParameters stretch{1000, 400, 0};
  ShearParameters shear{120, 0};
  BendParameters bend{1, 0};
};

using Make = std::function<Sample(int cells, bool membrane)>;

// Quads whose spacing grows along weft, and shrinks along warp, by this factor from one end to the other.
Sample quads(double grading, int cells, bool membrane) {
  mesh::Grid grid = testing::grid_of_squares({1, 1}, cells);
  grid.weft_grading = grading;
  grid.warp_grading = 1 / grading;
  Sample sample{mesh::make_sheet(grid), {}, lumped_masses(grid, 1)};
  if (membrane) {
    sample.forces.push_back(std::make_unique<Stretch>(grid, 0, Material{}.stretch));
    sample.forces.push_back(std::make_unique<Shear>(grid, 0, Material{}.shear));
  } else {
    sample.forces.push_back(std::make_unique<Bend>(grid, 0, Material{}.bend));
  }
  return sample;
}

Sample triangles(const testing::Meshing& meshing, int cells, bool membrane) {
  Sample sample;
  sample.mesh = meshing.make({1, 1}, cells);
  const mesh::Sheet sheet = mesh::make_sheet_from_mesh(sample.mesh);
  sample.areas = lumped_masses(sheet, 1);
  if (membrane)
    sample.forces.push_back(std::make_unique<TriangleMembrane>(sheet, 0, Material{}.stretch, Material{}.shear));
  else
    sample.forces.push_back(std::make_unique<TriangleBend>(sheet, 0, Material{}.bend));
  return sample;
}

/// Solves K d = f for small displacements d, with `axes` coordinates per particle from `first_axis` on.
class Statics {
 public:
  Statics(const Sample& sample, int first_axis, int axes)
      : first_axis_(first_axis), axes_(axes), values_(Eigen::VectorXd::Zero(axes * size(sample))), held_(size(sample)) {
    std::vector<std::pair<Index, Index>> pairs;
    for (const auto& force : sample.forces) force->append_couplings(pairs);
    solver::BlockMatrix matrix(static_cast<Index>(sample.areas.size()), pairs);
    const std::vector<Vec3> zero(sample.mesh.positions.size(), Vec3::Zero());
    for (const auto& force : sample.forces) force->add_jacobian(sample.mesh.positions, zero, 0, matrix);
    matrix.for_each_block(0, matrix.rows(), [&](Index i, Index j, const auto& block) {
      for (int a = 0; a < axes_; ++a)
        for (int b = 0; b < axes_; ++b)
          entries_.emplace_back(axes_ * i + a, axes_ * j + b, block(first_axis_ + a, first_axis_ + b));
    });
  }

  /// Prescribes the displacement of a particle.
  void hold(std::size_t particle, const Vec3& displacement) {
    held_[particle] = 1;
    values_.segment(static_cast<Eigen::Index>(particle) * axes_, axes_) = displacement.segment(first_axis_, axes_);
  }

  /// Displacements under these loads [N].
  std::vector<Vec3> solve(const std::vector<Vec3>& loads) const {
    std::vector<Eigen::Index> row(held_.size(), -1);
    Eigen::Index rows = 0;
    for (std::size_t i = 0; i < held_.size(); ++i)
      if (!held_[i]) row[i] = axes_ * rows++;
    rows *= axes_;
    const auto particle = [&](Eigen::Index k) { return static_cast<std::size_t>(k / axes_); };
    const auto free_row = [&](Eigen::Index k) { return row[particle(k)] + k % axes_; };
    Eigen::VectorXd b(rows);
    for (Eigen::Index k = 0; k < values_.size(); ++k)
      if (!held_[particle(k)]) b[free_row(k)] = loads[particle(k)][first_axis_ + k % axes_];
    std::vector<Eigen::Triplet<double>> kept;
    for (const auto& e : entries_) {
      if (held_[particle(e.row())]) continue;
      if (held_[particle(e.col())])
        b[free_row(e.row())] -= e.value() * values_[e.col()];
      else
        kept.emplace_back(free_row(e.row()), free_row(e.col()), e.value());
    }
    Eigen::SparseMatrix<double> matrix(rows, rows);
    matrix.setFromTriplets(kept.begin(), kept.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    const Eigen::VectorXd y = factors.solve(b);
    std::vector<Vec3> d(held_.size(), Vec3::Zero());
    for (Eigen::Index k = 0; k < values_.size(); ++k)
      d[particle(k)][first_axis_ + k % axes_] = held_[particle(k)] ? values_[k] : y[free_row(k)];
    return d;
  }

 private:
  static Eigen::Index size(const Sample& sample) { return static_cast<Eigen::Index>(sample.areas.size()); }

  int first_axis_, axes_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd values_;
  std::vector<char> held_;
};

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

bool on_border(const Vec2& uv, int axis) {
  return uv[axis] < 1e-9 || uv[axis] > 1 - 1e-9;
}

/// Relative error of the compliance of a sheet held along all sides, under the load that displaces it by d sin πu sin
/// πv.
double membrane_error(const Make& make, int cells, const Vec2& d) {
  const Sample sample = make(cells, true);
  Statics statics(sample, 0, 2);
  const Material m;
  std::vector<Vec3> loads, exact;
  for (std::size_t i = 0; i < sample.areas.size(); ++i) {
    const Vec2& uv = sample.mesh.uv[i];
    const double s = std::sin(kPi * uv.x()) * std::sin(kPi * uv.y()),
                 c = std::cos(kPi * uv.x()) * std::cos(kPi * uv.y());
    const double g = 0.5 * m.shear.modulus;
    // The load per area is −div σ with σ_uu = k1 ε_uu, σ_vv = k2 ε_vv, σ_uv = ½ μ 2ε_uv.
    loads.push_back(
        sample.areas[i] * kPi * kPi *
        Vec3((m.stretch.weft + g) * d.x() * s - g * d.y() * c, (m.stretch.warp + g) * d.y() * s - g * d.x() * c, 0));
    exact.emplace_back(d.x() * s, d.y() * s, 0);
    if (on_border(uv, 0) || on_border(uv, 1)) statics.hold(i, Vec3::Zero());
  }
  return dot(loads, statics.solve(loads)) / dot(loads, exact) - 1;
}

/// Relative error of the compliance of a plate that is supported along two opposite sides (`along_u` or `along_v`) and
/// free along the others, or supported along all sides (both).
double plate_error(const Make& make, int cells, bool along_u, bool along_v) {
  const Sample sample = make(cells, false);
  Statics statics(sample, 2, 1);
  std::vector<Vec3> loads, exact;
  for (std::size_t i = 0; i < sample.areas.size(); ++i) {
    const Vec2& uv = sample.mesh.uv[i];
    const double w = (along_u ? std::sin(kPi * uv.x()) : 1) * (along_v ? std::sin(kPi * uv.y()) : 1);
    const double factor = std::pow((along_u + along_v) * kPi * kPi, 2);  // B Δ² w = factor w
    loads.emplace_back(0, 0, sample.areas[i] * factor * w);
    exact.emplace_back(0, 0, w);
    if ((along_u && on_border(uv, 0)) || (along_v && on_border(uv, 1))) statics.hold(i, Vec3::Zero());
  }
  return dot(loads, statics.solve(loads)) / dot(loads, exact) - 1;
}

/// Error of a plate held flat up to `clamp` along weft, under an even load: its compliance relative to that of a beam
/// clamped there, less one. `held` has an entry per particle.
double cantilever_error(const Sample& sample, double clamp, const std::vector<char>& held) {
  for (const auto& force : sample.forces) force->set_held(held);
  Statics statics(sample, 2, 1);
  const double length = 1 - clamp;
  std::vector<Vec3> loads, exact;
  for (std::size_t i = 0; i < sample.areas.size(); ++i) {
    const double s = std::max(0.0, sample.mesh.uv[i].x() - clamp);
    loads.emplace_back(0, 0, sample.areas[i]);
    exact.emplace_back(0, 0, s * s * (6 * length * length - 4 * length * s + s * s) / (24 * Material{}.bend.rigidity));
    if (held[i]) statics.hold(i, Vec3::Zero());
  }
  return dot(loads, statics.solve(loads)) / dot(loads, exact) - 1;
}

/// Marks the particles up to `clamp` along weft as held.
std::vector<char> held_up_to(const Sample& sample, double clamp) {
  std::vector<char> held;
  for (const Vec2& uv : sample.mesh.uv) held.push_back(uv.x() <= clamp + 1e-9);
  return held;
}

/// cantilever_error() of quads whose first two columns are held.
double clamped_quads_error(double grading, int cells) {
  const Sample sample = quads(grading, cells, false);
  const double clamp = sample.mesh.uv[1].x();
  return cantilever_error(sample, clamp, held_up_to(sample, clamp));
}

/// cantilever_error() of triangles that are held up to the column nearest to a quarter of the sheet. The column is
/// moved into a straight line.
double clamped_triangles_error(const testing::Meshing& meshing, int cells) {
  Sample sample;
  sample.mesh = meshing.make({1, 1}, cells);
  const auto columns =
      static_cast<std::size_t>(std::ranges::count_if(sample.mesh.uv, [](const Vec2& uv) { return uv.y() < 1e-9; }));
  const std::size_t rows =
      static_cast<std::size_t>(std::ranges::count_if(sample.mesh.uv, [](const Vec2& uv) { return uv.x() < 1e-9; }));
  double clamp = 0;
  for (std::size_t row = 0; row < rows; ++row)
    clamp += sample.mesh.uv[row * columns + columns / 4].x() / static_cast<double>(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t k = row * columns + columns / 4;
    sample.mesh.positions[k].x() += clamp - sample.mesh.uv[k].x();
    sample.mesh.uv[k].x() = clamp;
  }
  // Removes triangles that the moved column has flattened.
  std::vector<Vec2> places;
  for (const Vec2& uv : sample.mesh.uv)
    places.push_back(uv.cwiseProduct(Vec2(static_cast<double>(columns), static_cast<double>(rows))));
  testing::make_delaunay(sample.mesh.topology.triangles, places);
  const mesh::Sheet sheet = mesh::make_sheet_from_mesh(sample.mesh);
  sample.areas = lumped_masses(sheet, 1);
  const std::vector<char> held = held_up_to(sample, clamp);
  sample.forces.push_back(std::make_unique<TriangleBend>(sheet, 0, Material{}.bend, held));
  return cantilever_error(sample, clamp, held);
}

/// Marks the particles that bending at the border can affect: three rows.
std::vector<char> near_border(const Sample& sample) {
  std::vector<char> near(sample.areas.size());
  for (std::size_t i = 0; i < near.size(); ++i)
    near[i] = on_border(sample.mesh.uv[i], 0) || on_border(sample.mesh.uv[i], 1);
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<char> before = near;
    for (const mesh::Triangle& t : sample.mesh.topology.triangles)
      for (Index a : t)
        for (Index b : t)
          if (before[a]) near[b] = 1;
  }
  return near;
}

/// Error of a plate that is clamped along its border to the ridge w = sin(4 ξ + 0.3), ξ at an angle to the weft, and
/// loaded to keep that shape: deviation relative to the displacement that the load causes.
double ridge_error(const Make& make, int cells, double degrees) {
  const Sample sample = make(cells, false);
  Statics statics(sample, 2, 1);
  const std::vector<char> near = near_border(sample);
  const Vec2 direction(std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180));
  std::vector<Vec3> loads, exact;
  for (std::size_t i = 0; i < sample.areas.size(); ++i) {
    const double w = std::sin(4 * direction.dot(sample.mesh.uv[i]) + 0.3);
    loads.emplace_back(0, 0, sample.areas[i] * 256 * w);
    exact.emplace_back(0, 0, w);
    if (near[i]) statics.hold(i, exact.back());
  }
  const std::vector<Vec3> found = statics.solve(loads);
  const std::vector<Vec3> unloaded = statics.solve(std::vector<Vec3>(loads.size(), Vec3::Zero()));
  double error = 0, deflection = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    error += sample.areas[i] * (found[i] - exact[i]).squaredNorm();
    deflection += sample.areas[i] * (exact[i] - unloaded[i]).squaredNorm();
  }
  return std::sqrt(error / deflection);
}

/// Prints errors at all resolutions and the order over the last two halvings; expects the last error within 1 %.
void report(const std::string& mesh, const char* what, const std::function<double(int)>& error_at) {
  std::printf("%-19s %-22s", mesh.c_str(), what);
  std::vector<double> errors;
  for (int cells : kCells) {
    errors.push_back(error_at(cells));
    std::printf(" %9.3f %%", 100 * errors.back());
  }
  const double error = errors[3], order = 0.5 * std::log2(std::abs(errors[1] / error));
  std::printf("   order %.2f\n", order);
  EXPECT_LT(std::abs(error), 0.01) << mesh << ": " << what;
  EXPECT_GT(order, 1) << mesh << ": " << what;
}

void report_all(const std::string& mesh, const Make& make) {
  const double s = std::numbers::sqrt2 / 2;
  report(mesh, "membrane, weft", [&](int n) { return membrane_error(make, n, {1, 0}); });
  report(mesh, "membrane, warp", [&](int n) { return membrane_error(make, n, {0, 1}); });
  report(mesh, "membrane, bias", [&](int n) { return membrane_error(make, n, {s, s}); });
  report(mesh, "bent along weft", [&](int n) { return plate_error(make, n, true, false); });
  report(mesh, "bent along warp", [&](int n) { return plate_error(make, n, false, true); });
  report(mesh, "plate on four sides", [&](int n) { return plate_error(make, n, true, true); });
  // On meshes of n cells, the three held rows along each side would leave too few free particles.
  report(mesh, "ridge across 45°", [&](int n) { return ridge_error(make, 2 * n, 45); });
  report(mesh, "ridge across -45°", [&](int n) { return ridge_error(make, 2 * n, -45); });
}

TEST(Continuum, IsApproachedByQuadsEvenAndGraded) {
  for (const double grading : {1, 4, 10}) {
    const Make make = [&](int cells, bool membrane) { return quads(grading, cells, membrane); };
    const std::string name = grading == 1 ? "quads" : "quads graded " + std::to_string(static_cast<int>(grading));
    report_all(name, make);
    report(name, "clamped, even load", [&](int n) { return clamped_quads_error(grading, n); });
  }
}

class Continuum : public ::testing::TestWithParam<testing::Meshing> {};

TEST_P(Continuum, IsApproachedByTriangles) {
  report_all(GetParam().name, [&](int cells, bool membrane) { return triangles(GetParam(), cells, membrane); });
  report(GetParam().name, "clamped, even load", [&](int n) { return clamped_triangles_error(GetParam(), n); });
}

INSTANTIATE_TEST_SUITE_P(On, Continuum, ::testing::ValuesIn(testing::kMeshings), [](const auto& instance) {
  std::string name = instance.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
}  // namespace weft::forces
