// Systems of one or two particles with known motion.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "physics/integrator/stepper.hpp"
#include "physics/integrator/system.hpp"

namespace weft::integrator::testing {

/// Solves to rounding accuracy, so that only the error of the method remains.
inline const NewtonParameters kTight{
    .tolerance = 1e-12, .max_iterations = 40, .linear_tolerance = 1e-12, .max_linear_iterations = 1000};

inline constexpr Method kMethods[] = {Method::implicit_euler, Method::implicit_midpoint, Method::bdf2};

/// Particles without coupling, each with its own force.
class Particles : public System {
 public:
  explicit Particles(std::vector<double> masses) : masses_(std::move(masses)) {
    system_.matrix = solver::BlockMatrix(static_cast<Index>(masses_.size()), {});
  }

  std::span<const double> masses() const override { return masses_; }
  void constant_forces(std::span<Vec3>) const override {}
  void forces(const StagePoint& at, std::span<Vec3> force) override {
    for (std::size_t i = 0; i < masses_.size(); ++i) force[i] += force_on(at.x[i]);
  }
  void linearise(const StagePoint& at, int, std::span<Vec3> force) override {
    forces(at, force);
    std::ranges::fill(system_.matrix.values(), 0.0);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      const solver::Slot slot = system_.matrix.diagonal(static_cast<Index>(i));
      system_.matrix.add_scalar(slot, at.rate * at.rate * masses_[i]);
      system_.matrix.add(slot, stiffness_of(at.x[i]));
    }
  }
  solver::LinearSystem& linear_system() override { return system_; }

 protected:
  virtual Vec3 force_on(const Vec3& x) const = 0;      ///< [N]
  virtual Mat3 stiffness_of(const Vec3& x) const = 0;  ///< −df/dx [N/m]

 private:
  std::vector<double> masses_;
  solver::LinearSystem system_;
};

/// f = −k x for each particle; by default one of 1 kg.
class Spring : public Particles {
 public:
  explicit Spring(double k, std::vector<double> masses = {1}) : Particles(std::move(masses)), k_(k) {}

 protected:
  Vec3 force_on(const Vec3& x) const override { return -k_ * x; }
  Mat3 stiffness_of(const Vec3&) const override { return k_ * Mat3::Identity(); }

 private:
  double k_;
};

/// f = −(1 + ‖x‖²) x for each particle; by default one of 1 kg. Smooth, nonlinear, with a definite stiffness.
class HardeningSpring : public Particles {
 public:
  explicit HardeningSpring(std::vector<double> masses = {1}) : Particles(std::move(masses)) {}
  static Vec3 force_at(const Vec3& x) { return -(1 + x.squaredNorm()) * x; }

 protected:
  Vec3 force_on(const Vec3& x) const override { return force_at(x); }
  Mat3 stiffness_of(const Vec3& x) const override {
    return (1 + x.squaredNorm()) * Mat3::Identity() + 2 * x * x.transpose();
  }
};

/// State of a HardeningSpring of 1 kg after a time t [s], which may be negative, by `steps` steps of the classical
/// Runge-Kutta method.
inline State moved(State now, double t, int steps) {
  const auto a = [](const Vec3& x) { return HardeningSpring::force_at(x); };
  const double h = t / steps;
  Vec3 &x = now.x[0], &v = now.v[0];
  for (int s = 0; s < steps; ++s) {
    const Vec3 v1 = v, a1 = a(x);
    const Vec3 v2 = v + 0.5 * h * a1, a2 = a(x + 0.5 * h * v1);
    const Vec3 v3 = v + 0.5 * h * a2, a3 = a(x + 0.5 * h * v2);
    const Vec3 v4 = v + h * a3, a4 = a(x + h * v3);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return now;
}

/// Two particles of 1 kg with f0 = −s x1 and f1 = −s x0. If s > 0 they separate ever faster. If s > rate² (see
/// StagePoint), the matrix is indefinite although its diagonal is definite.
class Saddle : public System {
 public:
  explicit Saddle(double s) : s_(s) { system_.matrix = solver::BlockMatrix(2, {{0, 1}}); }
  std::span<const double> masses() const override { return masses_; }
  void constant_forces(std::span<Vec3>) const override {}
  void forces(const StagePoint& at, std::span<Vec3> force) override {
    force[0] -= s_ * at.x[1];
    force[1] -= s_ * at.x[0];
  }
  void linearise(const StagePoint& at, int, std::span<Vec3> force) override {
    forces(at, force);
    std::ranges::fill(system_.matrix.values(), 0.0);
    for (Index i : {0, 1}) {
      system_.matrix.add_scalar(system_.matrix.diagonal(i), at.rate * at.rate);
      system_.matrix.add_scalar(system_.matrix.slot(i, 1 - i), s_);
    }
  }
  solver::LinearSystem& linear_system() override { return system_; }

 private:
  double s_;
  solver::LinearSystem system_;
  std::vector<double> masses_{1, 1};
};

}  // namespace weft::integrator::testing
