#include "core/isolated.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "core/error.hpp"

namespace weft {
namespace {

/// First byte of the answer. kDone: the bytes that `work` returned follow; kFailed: an error message follows.
constexpr char kDone = 'D', kFailed = 'F';

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::generic_category().message(errno)));
}

[[noreturn]] void throw_interrupted() {
  throw Error(ExitCode::interrupted, "interrupted");
}

/// Descriptors of a pipe, closed by the destructor.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) fail("no pipe to a child process");
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_write_end() { close_end(1); }

 private:
  void close_end(std::size_t k) {
    if (ends_[k] >= 0) ::close(ends_[k]);
    ends_[k] = -1;
  }
  std::array<int, 2> ends_{-1, -1};
};

void limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  const rlimit both{soft, hard};
  // If a stricter hard limit is in force, setrlimit() fails without privileges, and the stricter limit stays.
  static_cast<void>(::setrlimit(resource, &both));
}

void send(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::write(descriptor, bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) ::_exit(1);
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// Code of the child process. Never returns, and runs no destructors of the parent's objects, whose files and threads
/// belong to the parent.
[[noreturn]] void run_child(const std::function<std::string()>& work, const Isolation& isolation, int answer) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int crash : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGTERM}) std::signal(crash, SIG_DFL);
  // The terminal sends the signal of Ctrl-C to the child, too. The child ignores it; the parent kills the child once
  // `stop` is true.
  for (const int request : {SIGINT, SIGHUP}) std::signal(request, SIG_IGN);
  limit(RLIMIT_CORE, 0, 0);
  // At the soft limit, the kernel sends SIGXCPU; at the hard limit, a second later, SIGKILL.
  if (isolation.cpu_seconds > 0) limit(RLIMIT_CPU, isolation.cpu_seconds, isolation.cpu_seconds + 1);
#ifndef __SANITIZE_ADDRESS__  // the address sanitizer reserves terabytes of addresses
  if (isolation.max_address_space > 0) limit(RLIMIT_AS, isolation.max_address_space, isolation.max_address_space);
#endif
  char kind = kDone;
  std::string bytes;
  try {
    bytes = work();
  } catch (const std::bad_alloc&) {
    kind = kFailed;
    bytes = isolation.name + " exceeds its memory limit";
  } catch (const std::exception& error) {
    kind = kFailed;
    bytes = error.what();
  } catch (...) {
    kind = kFailed;
    bytes = "an exception without a message";
  }
  send(answer, {&kind, 1});
  send(answer, bytes);
  ::_exit(0);
}

// Receives bytes until the child closes its end of the pipe. Throws if `stop` becomes true or the wall time limit has
// passed.
std::string receive(int descriptor, const Isolation& isolation) {
  using Clock = std::chrono::steady_clock;
  constexpr int kPollInterval = 100;  // [ms]
  const auto deadline = Clock::now() + std::chrono::seconds(isolation.wall_seconds);
  std::string bytes;
  std::array<char, 1 << 16> buffer{};
  for (;;) {
    pollfd wait{descriptor, POLLIN, 0};
    while (::poll(&wait, 1, kPollInterval) <= 0) {
      if (isolation.stop != nullptr && *isolation.stop) throw_interrupted();
      if (isolation.wall_seconds > 0 && Clock::now() > deadline)
        throw std::runtime_error(fmt::format("{} was stopped after {} s", isolation.name, isolation.wall_seconds));
    }
    const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("reading from a child process");
    if (got == 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

/// A child process. If wait() was not called, the destructor kills and reaps the process.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

 private:
  pid_t process_;
};

}  // namespace

std::string run_isolated(const std::function<std::string()>& work, const Isolation& isolation) {
  Pipe pipe;
  const pid_t process = ::fork();
  if (process < 0) fail("no child process");
  if (process == 0) run_child(work, isolation, pipe.write_end());
  Child child(process);
  pipe.close_write_end();
  std::string answer = receive(pipe.read_end(), isolation);
  const int status = child.wait();
  // A SIGTERM to the process group sets `stop` in this process and also ends the child. This is no crash of the child.
  if (isolation.stop != nullptr && *isolation.stop) throw_interrupted();
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU)
      throw std::runtime_error(
          fmt::format("{} was stopped after {} s of processor time", isolation.name, isolation.cpu_seconds));
    if (signal == SIGKILL)
      throw std::runtime_error(isolation.name + " was killed by the system, perhaps because memory ran out");
    throw std::runtime_error(fmt::format("{} crashed: {}", isolation.name, ::strsignal(signal)));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    throw std::runtime_error(isolation.name + " ended without a result");
  const char kind = answer.front();
  answer.erase(0, 1);
  if (kind == kFailed) throw std::runtime_error(answer);
  return answer;
}

}  // namespace weft
