#include "cli/store.hpp"

#include <system_error>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"

namespace weft::cli {
namespace {

// Of the time in which it would be simulated again. States take some times the place of a frame, and most are replaced
// unused.
constexpr double kSaveShare = 0.01;

}  // namespace

Store::Store(std::filesystem::path folder, Need need, cache::Manifest manifest, std::string scene_text)
    : need_(need), manifest_(std::move(manifest)), scene_text_(std::move(scene_text)), lock_(std::move(folder)) {}

Store::~Store() {
  try {
    if (lock_.empty()) lock_.remove();
  } catch (const Error&) {
    return;  // a folder that cannot be looked at stays
  }
}

std::size_t Store::leftover_frames() const {
  try {
    return cache::Reader(lock_.folder()).frames().size();
  } catch (const Error&) {
    return 0;
  }
}

void Store::find_start() {
  if (!has_leftover())
    return log::info(fmt::format("note: {}: nothing to resume; starting at the beginning", folder().string()));
  try {
    auto reader = std::make_unique<cache::Reader>(folder());
    const cache::Manifest& found = reader->manifest();
    if (found.scene_hash != manifest_.scene_hash)
      throw Error(ExitCode::output_failed,
                  "--resume: {} is of scene {:016x}, which has changed since (now {:016x}); leave --resume away to "
                  "start again, or undo the change",
                  folder().string(), found.scene_hash, manifest_.scene_hash);
    if (found.program != manifest_.program)
      throw Error(ExitCode::output_failed,
                  "--resume: {} was made by another build of Weft ({}, for {}), which may compute other bits; leave "
                  "--resume away to start again",
                  folder().string(), found.weft_version, found.cpu_target);
    std::optional<cache::SolverState> state = reader->state();
    if (!state) return;
    for (int frame = 0; frame <= state->frame; ++frame) reader->verify(frame);
    start_ = std::move(*state);
    reader_ = std::move(reader);
  } catch (const Error& error) {
    if (error.code() != ExitCode::asset_unreadable) throw;
    log::info(fmt::format("note: {}; starting at the beginning", error.what()));
  }
}

// What is there stays: the output may fail for the same reason, and then nothing but this is left of the work.
void Store::give_up(const std::string& reason) {
  log::warn(reason + "; the run goes on, but from here on it would have to be simulated again if it is interrupted");
  writer_.reset();
  if (!can_resume()) lock_.clear();
}

template <class Write>
void Store::attempt(const Write& write) {
  if (!writer_) return;
  const WallTimer wall;
  const double cpu = thread_cpu_seconds();
  try {
    write();
  } catch (const Error& error) {
    if (need_ == Need::required) throw;
    give_up(error.what());
  }
  time_ += {wall.seconds(), thread_cpu_seconds() - cpu};
}

void Store::open(std::vector<frame::ObjectInfo> objects) {
  manifest_.objects = std::move(objects);
  try {
    writer_ = std::make_unique<cache::Writer>(lock_, manifest_, scene_text_);
  } catch (const Error& error) {
    if (need_ == Need::required) throw;
    give_up(error.what());
  }
}

void Store::add(const SimulatedFrame& frame) {
  attempt([&] {
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(folder(), error);
    if (need_ == Need::helpful && !error && space.available < bytes())
      return give_up(fmt::format("{}: the rest of the disk is left to the output", folder().string()));
    writer_->add(*frame.snapshot, frame.report);
  });
}

void Store::save_if_cheap(const simulation::Simulation& simulation, int frame) {
  if (!saved_frame_ || save_seconds_ <= kSaveShare * since_save_.seconds()) save(simulation, frame);
}

void Store::save(const simulation::Simulation& simulation, int frame) {
  if (saved_frame_ == frame) return;
  attempt([&] {
    const WallTimer timer;
    state_.clear();
    simulation.save(state_);
    writer_->save_state(frame, state_);
    saved_frame_ = frame;
    save_seconds_ = timer.seconds();
    since_save_ = WallTimer();
  });
}

void Store::remove() {
  writer_.reset();
  reader_.reset();
  lock_.remove();
}

StoredSimulation::StoredSimulation(const scene::Scene& scene, Store& store, std::function<bool()> proceed)
    : scene_(scene), store_(store), proceed_(std::move(proceed)) {
  if (!store.resumes()) {
    prepare_simulation();
    store.open(simulation_->objects());
  } else {
    store.open(store.earlier().manifest().objects);
  }
}

StoredSimulation::~StoredSimulation() {
  try {
    if (good_) store_.save(*simulation_, next_ - 1);
  } catch (...) {
    return;  // an earlier state is there
  }
}

SimulatedFrame StoredSimulation::next() {
  const bool stored = store_.resumes() && next_ <= store_.start().frame;
  SimulatedFrame frame;
  if (stored) {
    cache::CachedFrame cached = store_.earlier().read(next_);
    frame = {std::move(cached.snapshot), std::move(cached.report)};
  } else {
    frame = make();
    store_.add(frame);
  }
  for (const std::string& pinch : frame.report.pinches) log::warn(pinch);
  if (next_ == 0) first_frame_ = frame.snapshot;
  if (!stored) store_.save_if_cheap(*simulation_, next_);
  ++next_;
  return frame;
}

SimulatedFrame StoredSimulation::make() {
  good_ = false;
  if (!simulation_) prepare_simulation();
  simulation::FrameReport report;
  if (next_ == 0) {
    run_preroll();
    report = simulation_->initial_report();
  } else {
    report = simulation_->advance();
  }
  good_ = true;
  return {simulation_->snapshot(), std::move(report)};
}

void StoredSimulation::prepare_simulation() {
  simulation_ = std::make_unique<simulation::Simulation>(scene_);
  if (!store_.resumes()) return;
  try {
    simulation_->restore(store_.start().bytes);
  } catch (const std::runtime_error& error) {
    throw Error(ExitCode::asset_unreadable, "{}: the state of the solver is broken: {}; leave --resume away",
                store_.folder().string(), error.what());
  }
}

void StoredSimulation::run_preroll() {
  int frame = store_.resumes() ? store_.start().frame : -scene_.preroll_frames();
  const bool whole = simulation_->run_preroll([&] {
    if (frame > -scene_.preroll_frames()) store_.save_if_cheap(*simulation_, frame);
    const bool proceed = proceed_();
    // Nothing is drawn, but nothing is lost either.
    if (!proceed) store_.save(*simulation_, frame);
    ++frame;
    return proceed;
  });
  if (!whole) throw Error(ExitCode::interrupted, "interrupted before frame 0");
}

}  // namespace weft::cli
