#include "tools/cli/signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <string_view>

#include "core/error.hpp"
#include "core/stop.hpp"
#include "core/temporary_file.hpp"

namespace weft::cli {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
constexpr long long kRepeatWindow = 1'000'000'000;  // [ns]

std::atomic<bool> g_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
std::string_view g_promise;  // set before on_signal() is installed
std::array<struct sigaction, kSignals.size()> g_previous;

// Signal handlers make only async-signal-safe calls (POSIX.1-2017, 2.4.3): write, clock_gettime, unlink, _exit.

void write_message(std::string_view text) {
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // if standard error is closed, nothing can be done
}

[[noreturn]] void exit_now(int) {
  remove_temporary_files();
  ::_exit(static_cast<int>(ExitCode::interrupted));
}

void on_signal(int signal) {
  const long long now = monotonic_ns();
  long long first = 0;
  if (stop_requested_at.compare_exchange_strong(first, now)) {
    g_requested = true;
    write_message("\n");
    write_message(g_promise);
    write_message("; press again to quit at once\n");
  } else if (now - first > kRepeatWindow) {
    write_message("\nquit at once; unfinished files are removed\n");
    exit_now(signal);
  }
}

/// Installs a handler for those of kSignals that are not ignored, and stores the previous handlers.
void install(void (*handler)(int), std::array<struct sigaction, kSignals.size()>& previous) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // interrupted system calls continue
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) sigaddset(&action.sa_mask, signal);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &previous[i]);
    if (previous[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

}  // namespace

void end_on_signals() {
  std::array<struct sigaction, kSignals.size()> ignored;
  install(exit_now, ignored);
}

StopSignals::StopSignals(std::string_view promise) {
  g_promise = promise;
  g_requested = false;
  stop_requested_at = 0;
  install(on_signal, g_previous);
}

StopSignals::~StopSignals() {
  stop_requested_at = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &g_previous[i], nullptr);
}

const std::atomic<bool>& StopSignals::requested() const {
  return g_requested;
}

}  // namespace weft::cli
