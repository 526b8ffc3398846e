// Motion of bodies whose vertex positions are stored for each key frame (Etzmuß et al. 2001, "System").
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::motion {

/// Motion of one vertex in world space [m, m/s, m/s²].
struct VertexMotion {
  Vec3 position, velocity, acceleration;
};

/// Interpolates vertices between key frames at equal intervals: linearly, or by cubic splines with a continuous second
/// derivative. Before the first key and from the last one on, the body does not move.
class KeyFrames {
 public:
  /// `first_time`: time of the first key; `interval`: time between keys, positive [s]. `keys`: positions of all
  /// vertices at each key, at least one. `from_rest`: if true, cubic splines start with zero
  /// velocity, so that the velocity is continuous at the first key; if false, they start with zero
  /// acceleration. Cubic splines always end with zero acceleration.
  KeyFrames(Interpolation interpolation, double first_time, double interval, std::vector<std::vector<Vec3>> keys,
            bool from_rest);

  /// Writes the positions of all vertices at t [s], in parallel; allocates nothing.
  void at(double t, std::span<Vec3> positions) const;

  /// Motion of one vertex, with exact derivatives; at a key of a linear motion, those of the later segment.
  VertexMotion at(double t, std::size_t vertex) const { return at(find_piece(t), vertex); }

  bool is_moving() const { return keys_.size() > 1; }
  std::vector<double> times() const;  ///< of the keys [s]
  std::size_t bytes() const;          ///< memory of the keys [bytes]

 private:
  /// Position of a time among the keys: `s` [s] after key i. `is_still`: before the first key, or from the last one on.
  struct Piece {
    std::size_t i;
    double s;
    bool is_still;
  };
  Piece find_piece(double t) const;
  VertexMotion at(const Piece& piece, std::size_t vertex) const;
  void compute_second_derivatives(bool from_rest);

  double first_time_, interval_;  // [s]
  std::vector<std::vector<Vec3>> keys_;
  std::vector<std::vector<Vec3>> second_derivatives_;  // at the keys [m/s²]; empty for linear motion
};

}  // namespace weft::motion
