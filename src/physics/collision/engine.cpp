#include "physics/collision/engine.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/archive.hpp"
#include "core/numerics.hpp"
#include "core/parallel_append.hpp"
#include "physics/mesh/rigid_frame.hpp"

namespace weft::collision {
namespace {

// Distance below which features are near and may get contacts [m].
double detection_distance_of(const Bodies& bodies) {
  double max_thickness = 0;
  for (const ContactMaterial& material : bodies.materials())
    max_thickness = std::max(max_thickness, material.thickness);
  return numerics.contact.detection_ratio * max_thickness;
}

// Lists the rigid bodies that have triangles and frame particles (mesh::RigidFrame).
std::vector<RigidGroup> rigid_groups(const Bodies& bodies, std::span<const double> masses) {
  std::vector<RigidGroup> groups;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Index frame = bodies[b].frame;
    const Surface& surface = bodies.surfaces()[b];
    if (frame < 0 || surface.triangles.empty()) continue;
    const auto of_frame = masses.subspan(static_cast<std::size_t>(frame), mesh::RigidFrame::kParticles);
    // The vertices of the body may begin with its frame particles, which belong to no triangle.
    Index first = bodies.vertex_count(), last = 0;
    for (const Triangle& corners : surface.triangles)
      for (const Index v : corners) first = std::min(first, v), last = std::max(last, v);
    groups.push_back({first, last + 1 - first, frame, std::accumulate(of_frame.begin(), of_frame.end(), 0.0)});
  }
  return groups;
}

}  // namespace

Engine::Engine(Bodies bodies, const EngineParameters& parameters, std::span<const Vec3> x,
               std::span<const double> masses)
    : bodies_(std::move(bodies)),
      candidates_(bodies_, parameters.search, x, detection_distance_of(bodies_)),
      has_self_collision_(parameters.search.self),
      separation_(bodies_.triangles(), has_self_collision_ ? bodies_.deformable() : std::span<const Surface>(), masses),
      finder_(bodies_.triangles(), bodies_.vertex_count()),
      builder_(bodies_, parameters.contact, masses),
      response_(parameters.response, {masses.begin(), masses.end()}, parameters.stick_speed),
      pinched_(static_cast<Index>(masses.size()), bodies_.body_of_vertices(), bodies_.limb_of_vertices()),
      carried_(static_cast<Index>(masses.size()), bodies_.body_of_vertices()) {
  separation_.set_rigid(rigid_groups(bodies_, masses), bodies_.vertex_count());
  const double detection_distance = candidates_.detection_distance();
  if (parameters.search.coherence)
    coherence_.emplace(
        bodies_.surfaces(), candidates_.surface_pairs(), x,
        CoherenceParameters{detection_distance, 0.5 * numerics.contact.verlet_margin * detection_distance,
                            numerics.contact.flat_fold()});
}

void Engine::forget() {
  candidates_.forget();
  if (!coherence_) return;
  coherence_->forget();
  candidates_.invalidate();
}

// Collects pairs that can meet on the trajectory from x_t0 to x_t1.
void Engine::collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (coherence_) return update_coherence(x_t0, x_t1);
  collect_by(x_t0, [&] { candidates_.collect(x_t0, x_t1); });
}

void Engine::update_coherence(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  coherence_->update(candidates_.hierarchies(), finder_, x_t0, x_t1);
  candidates_.cover(x_t0, x_t1, 0.5 * candidates_.detection_distance());
  separation_.watch(coherence_->candidates().apart.view(), x_t0);
  gathered_at_.clear();
}

template <class Collect>
void Engine::collect_by(std::span<const Vec3> x_t0, const Collect& list_pairs) {
  // Swap the list of pairs between candidates_ and separation_, so that only one copy exists.
  CandidatePairs& pairs = candidates_.pairs();
  separation_.swap_pairs(pairs.apart);
  list_pairs();
  separation_.swap_pairs(pairs.apart);
  separation_.watch(x_t0);
  pairs.apart.clear();
  gathered_at_.clear();
}

// Gathers the pairs of features that may be near while no vertex is farther from x than the Verlet
// margin of near pairs (Numerics::Contact::verlet_margin). Skips pairs of triangles that a separating
// plane keeps far enough apart. Does nothing if no vertex is farther than that from its position in
// the last search. So a pair of edges whose surfaces were flat there (Numerics::Contact::flat_fold) and fold since then
// is missing until the next search.
void Engine::gather(std::span<const Vec3> x) {
  const double verlet_margin = numerics.contact.verlet_margin * candidates_.detection_distance();
  const auto is_near = [&] {
    return parallel_all_of(x.size(), [&](std::size_t v) {
      return (x[v] - gathered_at_[v]).squaredNorm() <= verlet_margin * verlet_margin ||
             candidates_.is_kept_clear(v, x[v]);
    });
  };
  if (!gathered_at_.empty() && is_near()) return;
  const double radius = candidates_.detection_distance() + 2 * verlet_margin;
  separation_.measure_motion(x);
  const auto append_closer = [&](std::size_t begin, std::size_t end, PairList& pairs) {
    separation_.append_closer(radius, begin, end, pairs);
  };
  const auto gather_from = [&](std::span<const Surface> deformable, std::span<const std::uint8_t> clear) {
    finder_.gather(separation_.pair_count(), append_closer, deformable, x, radius, numerics.contact.flat_fold(), clear);
  };
  if (has_self_collision_)
    gather_from(bodies_.deformable(), separation_.find_clear_triangles(radius, x));
  else
    gather_from({}, {});
  gathered_at_.assign(x.begin(), x.end());
}

bool Engine::begin_step(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable,
                        double h, std::span<const RigidMotion> motions, bool is_repeated) {
  step_ = h;
  x_t0_ = x_t0;
  gathered_at_.clear();  // so that near pairs do not depend on earlier steps
  pinched_pushes_.clear();
  carried_.begin_step(x_t0, x_t1, motions);
  begin_contacts(x_t0, x_t1);
  if (!pinched_.empty()) {
    // The way out of pinched cloth is compared with all obstacles, also with those that are clear.
    if (!candidates_.bounds_contain(x_t0)) collect(x_t0, x_t1);
    pinched_.update_exempted(bodies_.triangles(), candidates_.hierarchies(), x_t0, is_repeated);
    pinched_pushes_ = pinched_.find_pushes(candidates_.hierarchies(), x_t0, candidates_.detection_distance());
  }
  const bool is_moved = separate_guess(x_t0, x_t1, movable);
  pushed_pairs_.clear();
  // Find the pairs that might meet on the expected trajectory; they get contacts below. Test only planes of constant
  // direction: a pair that only a turning plane separates comes close and needs a contact, too. Exception: a pair for
  // which the last test of separate_guess() found a turning plane is not tested again and gets no contact here, unless
  // the guess could not be corrected.
  const StepMotion motion{x_t0, x_t0, x_t1, h};
  find_failing(x_t0, x_t1, PlaneKinds::constant);
  if (response_.form() == ResponseForm::springs)
    find_near_at_expected_end(x_t0, x_t1);
  else
    find_near(x_t0, proximities_);
  add_contacts(proximities_, motion);
  add_failing(failing_, motion);
  if (response_.predict_wall_contacts(x_t1, 0.5 * candidates_.detection_distance(), predicted_walls_x_t1_) &&
      find_failing(x_t0, predicted_walls_x_t1_, PlaneKinds::constant))
    add_failing(failing_, {x_t0, x_t0, predicted_walls_x_t1_, h});
  response_.prepare(x_t0, x_t1);
  return is_moved;
}

// Pushes apart surfaces that would meet on the way to the estimate x_t1, because contacts found at intersecting
// positions have meaningless directions. Exempts no further cloth, because x_t1 is only an estimate. Between cloths,
// does not search for planes that hold for a part of the step, because most of these searches find none. If the
// surfaces cannot be pushed apart, restores x_t1 and returns false.
bool Engine::separate_guess(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable) {
  if (movable.empty() || response_.form() != ResponseForm::springs || !find_failing(x_t0, x_t1, PlaneKinds::turning))
    return false;
  const std::vector<Vec3> expected(x_t1.begin(), x_t1.end());
  PinchedPairs pinched = pinched_;
  const bool is_apart = push_apart(x_t0, x_t1, movable, false, false, PlaneKinds::turning).separated;
  pinched_ = std::move(pinched);
  if (is_apart) return true;
  std::ranges::copy(expected, x_t1.begin());
  // If push_apart() has collected pairs, all tests are forgotten; whether it has depends on the parts of the search.
  separation_.forget_tests();
  return false;
}

// Finds near pairs at the expected end of the step. On a curved surface, contact directions found
// at the start would oppose sliding and take energy. Exception: if no plane of constant direction
// separates two triangles on the trajectory, their features are searched at the start, where each
// is still on its own side.
void Engine::find_near_at_expected_end(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  // If separate_guess() has moved x_t1, features that are near there may be missing from the pairs.
  if (!candidates_.lists_near(x_t1)) collect(x_t0, x_t1);
  std::vector<FeatureKey> failing;
  for (const auto& [a, b] : failing_)
    for (std::size_t k = 0; k < 3; ++k) {
      failing.push_back(feature_key(ProximityKind::vertex_face, {a[k], b[0], b[1], b[2]}));
      failing.push_back(feature_key(ProximityKind::vertex_face, {b[k], a[0], a[1], a[2]}));
      for (std::size_t l = 0; l < 3; ++l)
        failing.push_back(feature_key(ProximityKind::edge_edge, {a[k], a[(k + 1) % 3], b[l], b[(l + 1) % 3]}));
    }
  std::ranges::sort(failing);
  const auto fails = [&](const Proximity& proximity) {
    return std::ranges::binary_search(failing, feature_key(proximity.kind, proximity.vertices));
  };
  std::vector<Proximity> at_start;
  if (!failing.empty()) find_near(x_t0, at_start);
  gather(x_t1);
  finder_.find(x_t1, candidates_.detection_distance(), proximities_);
  std::erase_if(proximities_, fails);
  std::ranges::copy_if(at_start, std::back_inserter(proximities_), fails);
}

// Adds contacts for failing pairs. Returns the number of pairs for which ContactBuilder::add_failing() returned true.
int Engine::add_failing(std::span<const CornerPair> pairs, const StepMotion& motion) {
  std::vector<ClosestFeatures> closest(pairs.size());
  parallel_for(pairs.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) closest[p] = closest_features(pairs[p], motion.x_from);
  });
  int added = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    added += builder_.add_failing(pairs[p], closest[p], motion, response_) ? 1 : 0;
  return added;
}

void Engine::add_contacts(std::span<const Proximity> near, const StepMotion& motion) {
  const StepMotion from_start{x_t0_, x_t0_, motion.x_t1, motion.h};
  for (const PinchedPairs::Push& push : pinched_pushes_) builder_.add_pinched(push, from_start, response_);
  builder_.add(near, pinched_, motion, response_);
}

void Engine::continue_from(std::span<const Vec3> x) {
  const StepMotion motion{x_t0_, x, x, step_};
  carried_.begin_step(x, x, {});
  if (coherence_) candidates_.invalidate();  // the kept pairs belong to the start of the step
  begin_contacts(x, x);
  std::vector<Proximity> near;
  find_near(x, near);
  add_contacts(near, motion);
  // push_apart() may have exempted some of the pairs. Their contacts might push cloth deeper into the limb.
  std::erase_if(pushed_pairs_, [&](const CornerPair& pair) { return pinched_.exempts(pair); });
  add_failing(pushed_pairs_, motion);
}

// Clears the contacts. Collects candidate pairs again if the kept ones do not cover the start
// x_from, or if features that are near at x_t1 may be missing from them.
void Engine::begin_contacts(std::span<const Vec3> x_from, std::span<const Vec3> x_t1) {
  if (!candidates_.covers_start(x_from) || !candidates_.lists_near(x_t1)) collect(x_from, x_t1);
  response_.begin_step(step_);
  builder_.begin_step();
}

// Finds near pairs at x. CandidateCache::covers_start(x) must be true.
void Engine::find_near(std::span<const Vec3> x, std::vector<Proximity>& near) {
  if (coherence_) {
    near.clear();
    std::ranges::copy_if(coherence_->proximities(), std::back_inserter(near), [&](const Proximity& proximity) {
      return proximity.distance < candidates_.detection_distance();
    });
  } else {
    gather(x);
    finder_.find(x, candidates_.detection_distance(), near);
  }
}

bool Engine::is_separated(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  return !find_failing(x_t0, x_t1, PlaneKinds::all);
}

// Sets failing_ to the pairs that are not exempted and have no separating plane of the allowed
// kinds. Returns whether there are any.
bool Engine::find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, PlaneKinds which) {
  if (!candidates_.covers_end(x_t1)) collect(x_t0, x_t1);
  failing_ = separation_.find_failing(x_t0, x_t1, &pinched_, &carried_, which);
  return !failing_.empty();
}

int Engine::add_failing_contacts(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  return add_failing(failing_, {x_t0, x_t0, x_t1, step_});
}

std::span<const CornerPair> Engine::find_intersections(std::span<const Vec3> x) {
  collect(x, x);
  is_separated(x, x);
  return failing_;
}

bool Engine::fails_anew() const {
  return std::ranges::any_of(
      failing_, [&](const CornerPair& pair) { return std::ranges::find(pushed_pairs_, pair) == pushed_pairs_.end(); });
}

SeparationReport Engine::push_apart(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                                    std::span<const std::uint8_t> movable_in_step, bool may_pinch, bool may_move_pins,
                                    PlaneKinds which) {
  // If corrections move vertices out of the bounds of the candidate pairs, collect the pairs again.
  // Each of the first kTightCollections collections enlarges the bounds of these vertices only.
  // Later ones enlarge the bounds of all vertices to contain their starts and ends. After
  // kCollections collections, the correction fails.
  constexpr int kCollections = 8, kTightCollections = 3;
  SeparationReport report;
  if (!failing_.empty()) report.unseparated_pair = failing_.front();  // in case that the last collection fails
  pushed_pairs_.insert(pushed_pairs_.end(), failing_.begin(), failing_.end());
  failing_ = {};  // enforce() overwrites the list
  PinchedPairs pinched = pinched_;
  std::vector<std::uint8_t> movable(movable_in_step.begin(), movable_in_step.end());
  for (int c = 0; c < kCollections; ++c) {
    const SeparationReport pass = separation_.enforce(x_t0, x_t1, movable, &pinched, &carried_, c > 0, which);
    report.obstructed_pins.insert(report.obstructed_pins.end(), pass.obstructed_pins.begin(),
                                  pass.obstructed_pins.end());
    for (const ObstructedPin& pin : pass.obstructed_pins) movable[pin.particle] = kFree;
    report.separated = pass.separated;
    if (!pass.separated) report.unseparated_pair = pass.unseparated_pair;
    if (!report.obstructed_pins.empty() && !may_move_pins) {
      report.separated = false;
      report.unseparated_pair = report.obstructed_pins.front().pair;
    }
    if (!report.separated) return report;
    if (!candidates_.covers_end(x_t1)) {
      if (coherence_)
        update_coherence(x_t0, x_t1);
      else
        collect_by(x_t0, [&] { candidates_.collect_more(x_t0, x_t1, c >= kTightCollections); });
      continue;
    }
    if (const auto new_pinch = find_new_pinch(pinched, pinched_); new_pinch && !may_pinch) {
      report.separated = false;
      report.unseparated_pair = *new_pinch;
      return report;
    }
    pinched.note_origins(candidates_.hierarchies(), x_t0);
    pinched_ = std::move(pinched);
    return report;
  }
  report.separated = false;
  return report;
}

double Engine::min_distance() const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Proximity& proximity : proximities_) smallest = std::min(smallest, proximity.distance);
  return smallest;
}

template <class Archive>
void Engine::serialize_events(Archive& archive) {
  pinched_.serialize(archive);
  response_.serialize(archive);
}

template <class Archive>
void Engine::serialize(Archive& archive, std::span<const Vec3> x) {
  serialize_events(archive);
  bool kept = candidates_.covers_start(x);
  archive.value(kept);
  if (kept)
    serialize_candidates(archive);
  else if constexpr (Archive::kReads)
    candidates_.invalidate();
}

// Saves the positions for which candidate pairs were collected, and the planes that do not follow from these positions.
// Restoring collects the pairs again.
template <class Archive>
void Engine::serialize_candidates(Archive& archive) {
  const auto copy = [](std::span<const Vec3> x) { return std::vector<Vec3>(x.begin(), x.end()); };
  std::vector<Vec3> from = copy(candidates_.from()), low = copy(candidates_.low_end()),
                    high = copy(candidates_.high_end());
  bool to_one_place = low == high;
  archive.value(to_one_place);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].may_move) continue;
    for (std::vector<Vec3>* x : {&from, &low, &high}) {
      if (x == &high && to_one_place) continue;
      const std::span<Vec3> part = bodies_.part(b, std::span(*x));
      archive.raw(part.data(), part.size_bytes());
    }
  }
  if constexpr (Archive::kReads) {
    const auto finite = [](const Vec3& x) { return x.allFinite(); };
    for (const std::vector<Vec3>* x : {&from, &low, &high}) require(std::ranges::all_of(*x, finite), "finite points");
    if (coherence_)
      update_coherence(from, low);
    else
      collect_by(from, [&] { candidates_.collect(from, low, to_one_place ? low : high); });
  }
  separation_.serialize(archive);
}

template void Engine::serialize_events(ByteWriter&);
template void Engine::serialize_events(ByteReader&);
template void Engine::serialize(ByteWriter&, std::span<const Vec3>);
template void Engine::serialize(ByteReader&, std::span<const Vec3>);

}  // namespace weft::collision
