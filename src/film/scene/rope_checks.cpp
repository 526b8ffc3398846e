#include "film/scene/rope_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "film/scene/reader.hpp"
#include "film/scene/ropes.hpp"

namespace weft::scene {
namespace {

constexpr long kMaxRopeParticles = 1'000'000;  // maximum number for all ropes together

// Reports mistakes in the start path of a rope. Returns whether start_shape() can be computed, so that the pieces can
// be checked.
bool check_course(const Scene& scene, const Rope& rope, const std::string& path, Findings& findings) {
  if (rope.points.empty()) {
    for (const auto& [key, end] : {std::pair("from", rope.from), std::pair("to", rope.to)})
      if (!end && !findings.has_mistake(fmt::format("{}.{}", path, key)) && !findings.has_mistake(path + ".points"))
        findings.report(fmt::format("{}.{}", path, key), "expected points, or from and to, got none");
    if (!rope.from || !rope.to) return false;
    if ((*rope.to - *rope.from).norm() < kRoundoff) {
      findings.report(path + ".to", "expected another place than from, got the same");
      return false;
    }
    if (rope.closed) findings.report(path + ".closed", "expected points for a closed rope, got from and to");
    const Vec3 up = up_vector(scene.up), way = *rope.to - *rope.from;
    const double span = (way - up.dot(way) * up).norm(), least = kMinRopeSpan * rope.diameter;
    if (hangs_slack(rope) && span < least) {
      findings.report(
          path + ".to",
          fmt::format("expected a place at least {:.4g} m ({:g} diameters) beside `from`, measured horizontally, as "
                      "the rope is longer than the distance of its ends and hangs between them; got {:.4g} m; "
                      "move one end aside, or give points",
                      least, kMinRopeSpan, span));
      return false;
    }
    return true;
  }
  const std::size_t least = rope.closed ? 3 : 2;
  if (rope.points.size() < least) {
    findings.report(path + ".points", fmt::format("expected at least {} points, got {}", least, rope.points.size()));
    return false;
  }
  const std::size_t count = rope.points.size();
  for (std::size_t i = 0; i < (rope.closed ? count : count - 1); ++i)
    if ((rope.points[(i + 1) % count] - rope.points[i]).norm() < kRoundoff) {
      findings.report(path + ".points",
                      fmt::format("expected points that differ from the one before, got point {} again", i));
      return false;
    }
  return true;
}

// Reports too many particles, and pieces that are too short at the start or at a key frame. `particles`: number of
// particles of all ropes so far.
void check_pieces(const Scene& scene, const Rope& rope, const std::string& path, long& particles, Findings& findings) {
  const RopeShape shape = start_shape(rope, scene.up);
  particles += static_cast<long>(shape.places.size());
  if (particles > kMaxRopeParticles)
    findings.report(path + ".segments", fmt::format("expected at most {} particles in all ropes together, got {}",
                                                    kMaxRopeParticles, particles));
  const double piece = *std::ranges::min_element(shape.lengths), least = kMinRopePiece * rope.diameter;
  if (piece < (1 - kRoundoff) * least) {
    const bool chosen = rope.segments.has_value();
    findings.report(
        path + (chosen ? ".segments" : ".diameter"),
        fmt::format("expected pieces between particles of at least {:.4g} m, {:g} diameters, got {} of which "
                    "the shortest has {:.4g} m",
                    least, kMinRopePiece, shape.lengths.size(), piece));
    return;
  }
  // A change of the length changes all pieces by the same factor.
  const double start = std::accumulate(shape.lengths.begin(), shape.lengths.end(), 0.0);
  for (std::size_t k = 0; k < rope.keys.size(); ++k)
    if (const double length = rope.keys[k].length; piece * length < (1 - kRoundoff) * least * start)
      findings.report(
          fmt::format("{}.keys.{}.length", path, k),
          fmt::format("expected at least {:.4g} m, at which the shortest of {} pieces between particles has "
                      "{:g} diameters, got {}; fewer segments can be shorter together",
                      least * start / piece, shape.lengths.size(), kMinRopePiece, length));
}

}  // namespace

void check_ropes(const Scene& scene, Findings& findings) {
  long particles = 0;
  for (std::size_t i = 0; i < scene.ropes.size(); ++i) {
    const Rope& rope = scene.ropes[i];
    const std::string& path = findings.entry("rope", i);
    const auto is_sheet = [&](const Cloth& cloth) { return !cloth.rope && cloth.name == rope.name; };
    if (!rope.name.empty() && std::ranges::any_of(scene.cloths, is_sheet))
      findings.report(path + ".name",
                      fmt::format("expected a name used once, got {}, which a cloth has", in_quotes(rope.name)));
    if (check_course(scene, rope, path, findings)) check_pieces(scene, rope, path, particles, findings);
  }
}

}  // namespace weft::scene
