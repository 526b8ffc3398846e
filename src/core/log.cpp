#include "core/log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <utility>

#include "core/names.hpp"

namespace weft::log {
namespace {

struct State {
  std::mutex mutex;
  std::string status;
  std::vector<std::string> warnings, notes;
  std::function<void(std::string_view)> handle;
};

State& state() {
  static State instance;
  return instance;
}

// Carriage return and "erase to the end of the line" (ECMA-48 EL).
constexpr std::string_view kEraseLine = "\r\x1b[K";

// Writes a text by one call, so that it is not mixed with lines of other processes on the same
// terminal. Ignores failures, because a failure of standard error cannot be reported and must not
// stop a run.
void write(std::string_view text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
}

// If there is no handler, returns false. Otherwise releases the lock, passes the text to the
// handler, and returns true. The lock is released first, because the handler may wait for a thread
// that itself waits for the lock.
bool handled(std::string_view text, const State& s, std::unique_lock<std::mutex>& lock) {
  const auto handle = s.handle;
  if (!handle) return false;
  lock.unlock();
  handle(text);
  return true;
}

void print(State& s, std::string_view text) {
  const std::string line = without_controls(text);
  if (s.status.empty()) {
    write(fmt::format("{}\n", line));
  } else {
    write(fmt::format("{}{}\n{}", kEraseLine, line, s.status));
  }
}

/// Passes a text to the handler. Without a handler, prints the text and adds it to `list`; does
/// nothing if `list` contains it already.
void keep(std::string_view text, const char* kind, std::vector<std::string> State::*list) {
  State& s = state();
  std::unique_lock lock(s.mutex);
  if (handled(text, s, lock)) return;
  if (std::find((s.*list).begin(), (s.*list).end(), text) != (s.*list).end()) return;
  (s.*list).emplace_back(text);
  print(s, fmt::format("{}: {}", kind, text));
}

}  // namespace

std::string without_controls(std::string_view text, std::string_view kept) {
  std::string plain;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = control_size(text.substr(i));
    if (size == 0 || kept.find(text[i]) != std::string_view::npos) {
      plain += text[i++];
      continue;
    }
    for (const std::size_t end = i + size; i < end; ++i)
      plain += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
  }
  return plain;
}

void info(std::string_view line) {
  State& s = state();
  std::unique_lock lock(s.mutex);
  if (!handled(line, s, lock)) print(s, line);
}

void warn(std::string_view text) {
  keep(text, "warning", &State::warnings);
}

void note(std::string_view text) {
  keep(text, "note", &State::notes);
}

void set_handler(std::function<void(std::string_view text)> handle) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  s.handle = std::move(handle);
}

std::vector<std::string> warnings() {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  return s.warnings;
}

std::vector<std::string> notes() {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  return s.notes;
}

void status(std::string_view line) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  if (line.empty() && s.status.empty()) return;
  s.status = line;
  write(fmt::format("{}{}", kEraseLine, line));
}

}  // namespace weft::log
