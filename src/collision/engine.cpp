#include "collision/engine.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/archive.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

// Contacts are prepared up to this multiple of the range: those that come into range during the step are then in its
// solve. Beyond, whatever would meet is found by the failing certificates.
constexpr double kReachOfRange = 1.5;
// Relative motion that kept closest points survive, in reaches: they are then a quarter of the reach farther apart than
// their features at most. With half of the reach twice as many are kept (tests/bench/README.md).
constexpr double kCoherenceBudget = 0.125;
// Pairs whose closest features a thread looks for at once.
constexpr std::size_t kPairsAtOnce = 64;

// Distance below which contacts are prepared [m].
double reach_of(const Bodies& bodies) {
  double range = 0;
  for (const Skin& skin : bodies.skins()) range = std::max(range, skin.thickness);
  return kReachOfRange * range;
}

}  // namespace

Engine::Engine(Bodies bodies, const EngineParameters& parameters, std::span<const Vec3> x,
               std::span<const double> masses)
    : bodies_(std::move(bodies)),
      candidates_(bodies_, parameters.search, x, reach_of(bodies_)),
      meets_itself_(parameters.search.self),
      separation_(bodies_.triangles(), meets_itself_ ? bodies_.deformable() : std::span<const Surface>()),
      finder_(bodies_.triangles(), bodies_.vertex_count()),
      builder_(bodies_, parameters.contact, masses),
      response_(parameters.response, {masses.begin(), masses.end()}, parameters.stick_speed),
      failures_(masses.size()),
      pinched_(static_cast<Index>(masses.size()), bodies_.body_of_vertices(), bodies_.limb_of_vertices()),
      carried_(static_cast<Index>(masses.size()), bodies_.body_of_vertices()) {
  const double reach = candidates_.reach();
  if (parameters.search.coherence)
    coherence_.emplace(bodies_.surfaces(), candidates_.wanted(), x,
                       CoherenceParameters{reach, kCoherenceBudget * reach, kFlattest});
}

void Engine::forget() {
  candidates_.forget();
  if (!coherence_) return;
  coherence_->forget();
  candidates_.drop();
}

// Pairs that can meet on the way from x_t0 to x_t1.
void Engine::collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (coherence_) return update_coherence(x_t0, x_t1);
  collect_by(x_t0, [&] { candidates_.collect(x_t0, x_t1); });
}

void Engine::update_coherence(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  coherence_->update(candidates_.hierarchies(), finder_, x_t0, x_t1);
  candidates_.cover(x_t0, x_t1, 0.5 * candidates_.reach());
  separation_.watch(coherence_->candidates().apart.view(), x_t0);
}

// Of the pairs only those whose separating planes leave them near can have features that are.
template <class Collect>
void Engine::collect_by(std::span<const Vec3> x_t0, const Collect& list_pairs) {
  // The long list of all pairs lives in one place, that of closer ones in another.
  CandidatePairs& pairs = candidates_.pairs();
  separation_.exchange(pairs.apart);
  list_pairs();
  separation_.exchange(pairs.apart);
  separation_.watch(x_t0);
  pairs.apart.clear();
  separation_.append_closer(candidates_.radius(), pairs.apart);
  gathered_ = false;
}

// Features of the candidates collected last, where these began. Many are only looked at for certificates: a
// handkerchief pulled through a ring collects 1,163 times in 40 frames, and 407 times for contacts.
void Engine::gather() {
  if (!gathered_)
    finder_.gather(candidates_.pairs().apart, meets_itself_ ? bodies_.deformable() : std::span<const Surface>(),
                   candidates_.from(), candidates_.radius(), kFlattest,
                   separation_.open_triangles(candidates_.radius()));
  gathered_ = true;
}

void Engine::begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double h,
                        std::span<const RigidMotion> motions) {
  step_ = h;
  x_t0_ = x_t0;
  pushed_.clear();
  pinched_pushes_.clear();
  std::ranges::fill(failures_, 0);
  carried_.begin_step(x_t0, x_t1, motions);
  find_near(x_t0, x_t1, proximities_);
  if (!pinched_.empty()) {
    pinched_.renew(bodies_.triangles(), candidates_.hierarchies(), x_t0);
    pinched_pushes_ = pinched_.find_pushes(candidates_.hierarchies(), x_t0, candidates_.reach());
  }
  const StepMotion motion{x_t0, x_t0, x_t1, h};
  add_contacts(proximities_, motion);
  add_late_contacts(motion);
  foresee(motion);
  if (response_.lean(x_t1, 0.5 * candidates_.reach(), leaning_)) foresee({x_t0, x_t0, leaning_, h});
  response_.prepare(x_t0, x_t1);
}

// What only a solve shows, the next one would show again: sheets that lay on each other were solved twice in each step
// (multi_sheet at rest, 76 frames: 3,551 iterations for 1,103). Features that are near have their contact without this.
void Engine::add_late_contacts(const StepMotion& motion) {
  std::erase_if(late_, [&](const CornerPair& pair) { return pinched_.exempts(pair); });
  late_ = add_failing(late_, motion, true);
}

// Adds their contacts; returns for which pairs they are new.
std::vector<CornerPair> Engine::add_failing(std::span<const CornerPair> pairs, const StepMotion& motion, bool again) {
  std::vector<ClosestFeatures> closest(pairs.size());
  parallel_for(pairs.size(), kPairsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) closest[p] = closest_features(pairs[p], motion.x_from);
  });
  std::vector<CornerPair> fresh;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (builder_.add_failing(pairs[p], closest[p], motion, response_, again)) fresh.push_back(pairs[p]);
  return fresh;
}

// Adds contacts of what might meet on this way: what only planes that turn can tell apart comes near. Where these count
// here too, contacts show late: 40 frames of sphere_drape, five starts, 2,116 iterations for 1,685 (1,761 where no
// planes turn), and threads of falling_band stretched by 13 % for 3.
void Engine::foresee(const StepMotion& motion) {
  if (!find_failing(motion.x_t0, motion.x_t1, Certificates::constant)) return;
  add_failing(failing_, motion);
}

void Engine::add_contacts(std::span<const Proximity> near, const StepMotion& motion) {
  const StepMotion from_start{x_t0_, x_t0_, motion.x_t1, motion.h};
  for (const PinchedPairs::Push& push : pinched_pushes_) builder_.add_pinched(push, from_start, response_);
  builder_.add(near, pinched_, motion, response_);
}

void Engine::go_on_from(std::span<const Vec3> x) {
  const StepMotion motion{x_t0_, x, x, step_, failures_};
  carried_.begin_step(x, x, {});
  if (coherence_) candidates_.drop();  // what is kept was closest where the step began
  find_near(x, x, near_bend_);
  add_contacts(near_bend_, motion);
  add_failing(pushed_, motion);
}

// Features near each other at x_from, and no contacts yet.
void Engine::find_near(std::span<const Vec3> x_from, std::span<const Vec3> x_t1, std::vector<Proximity>& near) {
  if (!candidates_.covers_start(x_from) || !candidates_.covers_end(x_t1)) collect(x_from, x_t1);
  if (coherence_) {
    near.clear();
    std::ranges::copy_if(coherence_->proximities(), std::back_inserter(near),
                         [&](const Proximity& proximity) { return proximity.distance < candidates_.reach(); });
  } else {
    gather();
    finder_.find(x_from, candidates_.reach(), near);
  }
  response_.begin_step(step_);
  builder_.begin_step();
}

bool Engine::apart(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  return !find_failing(x_t0, x_t1, Certificates::all);
}

// Whether any pair has none of these certificates.
bool Engine::find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, Certificates which) {
  if (!candidates_.covers_end(x_t1)) collect(x_t0, x_t1);
  failing_ = separation_.find_failing(x_t0, x_t1, &pinched_, &carried_, which);
  return !failing_.empty();
}

int Engine::adopt_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  const std::vector<CornerPair> fresh = add_failing(failing_, {x_t0, x_t0, x_t1, step_});
  append(late_, fresh);
  return static_cast<int>(fresh.size());
}

void Engine::accept(std::span<const Vec3> x) {
  response_.accept();
  const double range = candidates_.reach() / kReachOfRange;
  std::erase_if(late_, [&](const CornerPair& pair) {
    const double distance_sq = closest_features(pair, x).points.distance_sq;
    return distance_sq == 0 || distance_sq >= range * range;  // crossed where pinched
  });
}

std::span<const CornerPair> Engine::find_meetings(std::span<const Vec3> x) {
  collect(x, x);
  apart(x, x);
  return failing_;
}

// Of the particles of pairs that are to be pushed apart.
void Engine::count_failures() {
  std::vector<std::uint8_t> fails(failures_.size());
  for (const CornerPair& pair : failing_)
    for (const Triangle& corners : {pair.a, pair.b})
      for (Index v : corners)
        if (static_cast<std::size_t>(v) < fails.size()) fails[v] = 1;
  for (std::size_t i = 0; i < fails.size(); ++i) failures_[i] += fails[i];
  pushed_.insert(pushed_.end(), failing_.begin(), failing_.end());
}

SeparationReport Engine::push_apart(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                                    std::span<const std::uint8_t> movable_in_step, bool may_pinch, bool may_give_way) {
  // Corrections can carry vertices out of the bounds that the candidates stand for; then these are collected anew, at
  // last for all ways between start and end.
  constexpr int kCollections = 8, kTightCollections = 3;
  SeparationReport report;
  count_failures();
  PinchedPairs pinched = pinched_;
  std::vector<std::uint8_t> movable(movable_in_step.begin(), movable_in_step.end());
  for (int c = 0; c < kCollections; ++c) {
    const SeparationReport pass = separation_.enforce(x_t0, x_t1, movable, &pinched, &carried_, c > 0);
    report.gave_way.insert(report.gave_way.end(), pass.gave_way.begin(), pass.gave_way.end());
    for (const GivenWay& given : pass.gave_way) movable[given.particle] = kFree;
    report.corrected_pairs += pass.corrected_pairs;
    report.largest_push = std::max(report.largest_push, pass.largest_push);
    report.separated = pass.separated;
    report.stuck = pass.stuck;
    if (!report.gave_way.empty() && !may_give_way) {
      report.separated = false;
      report.stuck = report.gave_way.front().pair;
    }
    if (!report.separated) return report;
    if (!candidates_.covers_end(x_t1)) {
      if (coherence_)
        update_coherence(x_t0, x_t1);
      else
        collect_by(x_t0, [&] { candidates_.collect_more(x_t0, x_t1, c >= kTightCollections); });
      continue;
    }
    if (const auto fresh = first_fresh(pinched, pinched_, candidates_.hierarchies()); fresh && !may_pinch) {
      report.separated = false;
      report.stuck = *fresh;
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
  double least = std::numeric_limits<double>::infinity();
  for (const Proximity& proximity : proximities_) least = std::min(least, proximity.distance);
  return least;
}

template <class Archive>
void Engine::serialize(Archive& archive, std::span<const Vec3> x) {
  pinched_.serialize(archive);
  response_.serialize(archive);
  serialize_each(archive, late_, [&](CornerPair& pair) {
    for (Triangle* corners : {&pair.a, &pair.b}) {
      archive.value(*corners);
      if constexpr (Archive::kReads)
        require(std::ranges::all_of(*corners, [&](Index v) { return v >= 0 && v < bodies_.vertex_count(); }),
                "vertices of these bodies");
    }
  });
  bool kept = candidates_.covers_start(x);
  archive.value(kept);
  if (kept)
    serialize_candidates(archive);
  else if constexpr (Archive::kReads)
    candidates_.drop();
}

// Candidates and features follow from the positions that they were collected for.
template <class Archive>
void Engine::serialize_candidates(Archive& archive) {
  const auto copy = [](std::span<const Vec3> x) { return std::vector<Vec3>(x.begin(), x.end()); };
  std::vector<Vec3> from = copy(candidates_.from()), low = copy(candidates_.low_end()),
                    high = copy(candidates_.high_end());
  bool to_one_place = low == high;
  archive.value(to_one_place);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].moving) continue;
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

template void Engine::serialize(ByteWriter&, std::span<const Vec3>);
template void Engine::serialize(ByteReader&, std::span<const Vec3>);

}  // namespace weft::collision
