#include "core/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "core/log.hpp"
#include "core/timer.hpp"

namespace weft {
namespace {

// Time over which the pace is averaged [s]: long enough for a steady estimate, and short enough to
// follow the pace when contacts slow down the simulation.
constexpr double kPaceWindow = 30;
constexpr std::chrono::milliseconds kBarInterval{200};
constexpr std::chrono::milliseconds kHeartbeatInterval{5000};  // a log of one hour stays below a thousand lines

constexpr auto kSimulate = static_cast<std::size_t>(Stage::simulate);
constexpr auto kDraw = static_cast<std::size_t>(Stage::draw);
constexpr auto kWrite = static_cast<std::size_t>(Stage::write);

Progress::Style resolve(Progress::Style style) {
  if (style != Progress::Style::automatic) return style;
  const char* terminal = std::getenv("TERM");
  const bool capable = ::isatty(STDERR_FILENO) != 0 && terminal != nullptr && std::string_view(terminal) != "dumb";
  return capable ? Progress::Style::bar : Progress::Style::plain;
}

int terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string format_duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
}

void RemainingTime::sample(double seconds, const StageCounts& done) {
  samples_.push_back({seconds, done});
  while (samples_.size() > 2 && samples_[1].seconds <= seconds - kPaceWindow) samples_.pop_front();
}

std::optional<double> RemainingTime::seconds() const {
  if (samples_.size() < 2) return std::nullopt;
  const Sample &first = samples_.front(), &last = samples_.back();
  const double span = last.seconds - first.seconds;
  bool all_done = true;
  std::optional<double> slowest;
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    const int left = totals_[stage] - last.done[stage];
    const int advanced = last.done[stage] - first.done[stage];
    if (left <= 0) continue;
    all_done = false;
    // The pace of a stage without progress is not known, for example of drawing before the first
    // frame to draw is simulated.
    if (advanced > 0) slowest = std::max(slowest.value_or(0.0), left * span / advanced);
  }
  return all_done ? 0.0 : slowest;
}

std::string progress_bar(const StageCounts& done, const StageCounts& totals, std::optional<double> seconds_left,
                         int columns) {
  // The bar gives each frame of each stage the same weight. Thus the bar moves from the start, and
  // is full only when all frames are written.
  const int all = std::max(1, totals[kSimulate] + totals[kDraw] + totals[kWrite]);
  const double fraction = static_cast<double>(done[kSimulate] + done[kDraw] + done[kWrite]) / all;
  constexpr int kCells = 12;
  const int filled = std::clamp(static_cast<int>(fraction * kCells), 0, kCells);
  std::string line =
      fmt::format("[{:#>{}}{:->{}}] {:3.0f} %", "", filled, "", kCells - filled, std::floor(100 * fraction));
  // The remaining time comes before the counts, because a narrow terminal cuts the end of the line.
  if (seconds_left) line += fmt::format("  {} left", format_duration(*seconds_left));
  if (totals[kSimulate] > 0) line += fmt::format("  sim {}", done[kSimulate]);
  if (totals[kWrite] > 0) line += fmt::format("  drawn {}  written {}", done[kDraw], done[kWrite]);
  line += fmt::format(" of {}", totals[totals[kWrite] > 0 ? kWrite : kSimulate]);
  // One column less than available: a full line would wrap and could not be redrawn in place.
  if (columns > 0 && line.size() >= static_cast<std::size_t>(columns))
    line.resize(static_cast<std::size_t>(columns - 1));
  return line;
}

std::string progress_line(const StageCounts& done, const StageCounts& totals, double seconds,
                          std::optional<double> seconds_left) {
  std::vector<std::string> parts;
  if (totals[kSimulate] > 0)
    parts.push_back(fmt::format("{} of {} frames simulated", done[kSimulate], totals[kSimulate]));
  if (totals[kDraw] > 0) {
    parts.push_back(fmt::format("{} of {} drawn", done[kDraw], totals[kDraw]));
    parts.push_back(fmt::format("{} written", done[kWrite]));
  }
  std::string line = fmt::format("{} after {}", fmt::join(parts, ", "), format_duration(seconds));
  if (seconds_left) line += fmt::format(", about {} left", format_duration(*seconds_left));
  return line;
}

Progress::Progress(Style style, StageCounts totals) : style_(resolve(style)), totals_(totals) {
  if (style_ != Style::none) thread_ = std::thread([this] { run(); });
}

Progress::~Progress() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

StageCounts Progress::done() const {
  StageCounts counts{};
  for (std::size_t stage = 0; stage < kStages; ++stage) counts[stage] = done_[stage].load(std::memory_order_relaxed);
  return counts;
}

void Progress::run() {
  const WallTimer timer;
  RemainingTime remaining(totals_);
  remaining.sample(0, StageCounts{});
  const bool bar = style_ == Style::bar;
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, bar ? kBarInterval : kHeartbeatInterval, [&] { return stopping_; })) {
    const StageCounts now = done();
    remaining.sample(timer.seconds(), now);
    if (bar) {
      log::status(progress_bar(now, totals_, remaining.seconds(), terminal_columns()));
    } else {
      log::info(progress_line(now, totals_, timer.seconds(), remaining.seconds()));
    }
  }
  log::status("");
}

}  // namespace weft
