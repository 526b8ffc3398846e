// Bodies whose vertices are stored as key frames before the simulation starts (seed, "System").
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// State of one vertex in world space [m, m/s, m/s²].
struct VertexMotion {
  Vec3 position, velocity, acceleration;
};

/// Vertices through equally spaced key frames, as Spline does it: along straight lines, or along cubic splines that are
/// twice continuously differentiable. Before the first key the body stands, after the last one it stands again.
class KeyFrames {
 public:
  /// `from_rest`: it stands before the first key, so the spline starts with no velocity there; else with no
  /// acceleration, as it ends. At least one key; `interval` [s] is positive.
  KeyFrames(scene::Interpolation interpolation, double first_time, double interval, std::vector<std::vector<Vec3>> keys,
            bool from_rest);

  /// Writes the positions of all vertices. Parallel over them, allocates nothing.
  void at(double t, std::span<Vec3> positions) const;

  /// A single vertex with its exact derivatives; at a corner of linear motion those of the later piece.
  VertexMotion at(double t, std::size_t vertex) const { return at(piece(t), vertex); }

  bool moving() const { return keys_.size() > 1; }
  std::vector<double> times() const;  ///< of the keys [s]
  std::size_t bytes() const;

 private:
  /// Where a time is among the keys: `s` [s] after key i; standing before the first and after the last.
  struct Piece {
    std::size_t i;
    double s;
    bool stands;
  };
  Piece piece(double t) const;
  VertexMotion at(const Piece& piece, std::size_t vertex) const;
  void bend(bool from_rest);

  double first_time_, interval_;  // [s]
  std::vector<std::vector<Vec3>> keys_;
  std::vector<std::vector<Vec3>> bends_;  // second derivatives at the keys [m/s²]; none for linear motion
};

}  // namespace weft::environment
