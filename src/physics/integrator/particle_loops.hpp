// Loops and sums over particles, divided among threads.
#pragma once

#include <cstddef>
#include <span>

#include "core/parallel_append.hpp"
#include "core/types.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::integrator {

/// Calls body(i) for all of `count` particles.
template <class Body>
void for_each_particle(std::size_t count, const Body& body) {
  parallel_for(count, kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}
/// Calls body(i) for the particles of a diagonal block.
template <class Body>
void for_each_particle(const solver::DiagonalBlock& rows, const Body& body) {
  for_each_particle(static_cast<std::size_t>(rows.end - rows.begin),
                    [&](std::size_t i) { body(static_cast<std::size_t>(rows.begin) + i); });
}

/// Σ body(i) over the particles of a diagonal block.
template <class Body>
double sum_over_particles(const solver::DiagonalBlock& rows, const Body& body) {
  const auto first = static_cast<std::size_t>(rows.begin), count = static_cast<std::size_t>(rows.end) - first;
  return parallel_sum(count, kGrainSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = first + begin; i < first + end; ++i) sum += body(i);
    return sum;
  });
}

inline double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  return sum_over_particles({0, static_cast<Index>(a.size())}, [&](std::size_t i) { return a[i].dot(b[i]); });
}

}  // namespace weft::integrator
