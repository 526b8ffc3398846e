#include "tools/cli/store.hpp"

#include <sstream>
#include <system_error>
#include <utility>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/log.hpp"
#include "core/temporary_file.hpp"
#include "film/cache/names.hpp"

namespace weft::cli {
namespace {

// A state is saved again only if the last save took at most this fraction of the wall time since then. Saving is
// limited since a state is several times as large as a frame, and most states are never read.
constexpr double kMaxSaveTimeRatio = 0.01;

}  // namespace

Store::Store(std::filesystem::path folder, Need need, cache::Manifest manifest, std::string scene_text)
    : need_(need), manifest_(std::move(manifest)), scene_text_(std::move(scene_text)), lock_(std::move(folder)) {}

Store::~Store() {
  try {
    if (lock_.empty()) lock_.remove();
  } catch (const Error&) {
    return;  // keeps a folder that cannot be accessed
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
    auto reader = std::make_unique<cache::Reader>(folder(), cache::AcceptedLooks::any);
    const cache::Manifest& found = reader->manifest();
    if (found.simulation_hash != manifest_.simulation_hash)
      throw Error(ExitCode::output_failed,
                  "--resume: {} is of scene {:016x}, which has changed since (now {:016x}); omit --resume to start "
                  "again, or undo the change",
                  folder().string(), found.scene_hash, manifest_.scene_hash);
    if (found.program != manifest_.program)
      throw Error(ExitCode::output_failed,
                  "--resume: {} was made by another build of Weft ({}, for {}), which may compute slightly different "
                  "results; omit --resume to start again",
                  folder().string(), found.weft_version, found.cpu_target);
    std::optional<cache::SolverState> state = reader->state();
    if (!state)
      return log::info(
          fmt::format("note: {}: has no state from which the simulation could continue; starting at the "
                      "beginning",
                      folder().string()));
    for (int frame = 0; frame <= state->frame; ++frame)
      if (reader->verify(frame) == manifest_.scene_hash && current_frames_ == frame) ++current_frames_;
    start_ = std::move(*state);
    note_former_looks(found);
    reader_ = std::move(reader);
  } catch (const Error& error) {
    if (error.code() != ExitCode::asset_unreadable) throw;
    log::info(fmt::format("note: {}; starting at the beginning", error.what()));
  }
}

// Adds the hashes of former scenes to the manifest. The stored frames have the looks of these scenes until the run
// reads and stores them again.
void Store::note_former_looks(const cache::Manifest& found) {
  std::set<std::uint64_t> former(found.former_hashes.begin(), found.former_hashes.end());
  former.insert(found.scene_hash);
  former.erase(manifest_.scene_hash);
  manifest_.former_hashes.assign(former.begin(), former.end());
  if (found.scene_hash != manifest_.scene_hash)
    log::info(
        fmt::format("note: {}: only the look of the scene has changed; its simulation continues", folder().string()));
}

std::set<std::string> Store::outputs() const {
  std::set<std::string> outputs;
  std::istringstream in(read_start(folder() / cache::kOutputsFile, kMaxTextBytes));
  for (std::string line; std::getline(in, line);) outputs.insert(line);
  return outputs;
}

bool Store::holds_scene(const std::filesystem::path& file) const {
  return weft::holds(file, read_start(folder() / cache::kSceneFile, kMaxTextBytes));
}

void Store::note_outputs(std::set<std::string> outputs) const {
  outputs.merge(this->outputs());
  if (outputs.empty()) return;
  try {
    write_file(folder() / cache::kOutputsFile, fmt::format("{}\n", fmt::join(outputs, "\n")), Flush::no);
  } catch (const Error&) {
    if (need_ == Need::required) throw;
  }
}

// Ends storing. Keeps the stored frames if --resume can use them: if the output then fails too, for example because the
// disk is full, these frames are the only result.
void Store::stop_storing(const std::string& reason) {
  log::warn(reason + "; the run continues, but if it is interrupted, frames from here on must be simulated again");
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
    // If the user has removed the folder of the output, the run must end.
    std::error_code ignored;
    if (need_ == Need::required || !std::filesystem::exists(folder().parent_path(), ignored)) throw;
    stop_storing(error.what());
  }
  time_ += {wall.seconds(), thread_cpu_seconds() - cpu};
}

void Store::open(std::vector<frame::ObjectInfo> objects) {
  manifest_.objects = std::move(objects);
  try {
    writer_ = std::make_unique<cache::Writer>(lock_, manifest_, scene_text_);
  } catch (const Error& error) {
    if (need_ == Need::required) throw;
    stop_storing(error.what());
  }
}

void Store::keep(const MadeFrame& frame) {
  if (frame.needs_storing)
    attempt([&] {
      std::error_code error;
      const std::filesystem::space_info space = std::filesystem::space(folder(), error);
      if (need_ == Need::helpful && !error && space.available < bytes())
        return stop_storing(
            fmt::format("{}: the disk is nearly full; its space is left to the output", folder().string()));
      writer_->add(*frame.snapshot, frame.report);
    });
  simulation_ = frame.simulation;
  last_ = frame.snapshot->frame;
  if (simulation_) save_if_cheap(*simulation_, last_);
}

frame::SnapshotPtr Store::stored(int frame) {
  if (!now_reader_) now_reader_ = std::make_unique<cache::Reader>(folder(), cache::AcceptedLooks::any);
  return now_reader_->snapshot(frame);
}

void Store::keep_last_state() {
  try {
    if (simulation_) save(*simulation_, last_);
  } catch (const Error&) {
    return;
  }
}

void Store::save_if_cheap(const production::SceneSimulation& simulation, int frame) {
  if (!saved_frame_ || save_seconds_ <= kMaxSaveTimeRatio * since_save_.seconds()) save(simulation, frame);
}

void Store::save(const production::SceneSimulation& simulation, int frame) {
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

}  // namespace weft::cli
