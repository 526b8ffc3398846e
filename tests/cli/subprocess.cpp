#include "cli/subprocess.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "core/installation.hpp"
#include "tools/cli/main.hpp"

namespace weft::cli {
namespace {

// Runs in the child process: makes standard input empty, and connects the outputs to the pipes.
void prepare(const std::filesystem::path& folder, int out, int err, std::size_t file_size_limit) {
  const int in = ::open("/dev/null", O_RDONLY);
  if (in < 0 || ::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0 || ::chdir(folder.c_str()) != 0) {
    ::_exit(126);
  }
  const rlimit limit{file_size_limit, file_size_limit};
  if (file_size_limit > 0 && ::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(126);
}

// Whether a fork may run the command without exec. If this process has several threads, the child could wait for a lock
// that another thread holds, which does not exist in the child. Builds with sanitizers need exec, since they report
// leaks only if a program ends by itself.
bool can_run_in_fork() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  const std::filesystem::directory_iterator threads("/proc/self/task");
  return std::distance(begin(threads), end(threads)) == 1;
#endif
}

// Loads OpenGL in this process, so that forks need not load it: loading takes a fifth of the time of a small picture.
// If a library cannot be loaded here, each fork searches for it.
void load_opengl_once() {
  static void* const library = [] {
    for (const char* file : {"libOSMesa.so.8", "/usr/lib/x86_64-linux-gnu/dri/swrast_dri.so"})
      if (void* const opened = ::dlopen(file, RTLD_NOW | RTLD_LOCAL)) return opened;
    return static_cast<void*>(nullptr);
  }();
  static_cast<void>(library);
}

bool draws(const std::vector<std::string>& arguments) {
  constexpr std::array<std::string_view, 4> kDrawing{"run", "render", "thumbnail", "sheet"};
  return !arguments.empty() && std::find(kDrawing.begin(), kDrawing.end(), arguments[0]) != kDrawing.end();
}

[[noreturn]] void run_program_and_exit(const std::vector<char*>& argv) {
  set_own_installation({WEFT_PROGRAM, WEFT_PROGRAM, {}});
  const int code = run_weft_tools(static_cast<int>(argv.size()) - 1, const_cast<char**>(argv.data()));
  std::fflush(nullptr);
  ::_exit(code);
}

}  // namespace

Subprocess::Subprocess(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       std::size_t file_size_limit, Start start) {
  std::array<int, 2> out{}, err{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2");
  std::vector<char*> argv{const_cast<char*>(WEFT_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const bool in_fork = start == Start::fork && can_run_in_fork();
  if (in_fork && draws(arguments)) load_opengl_once();
  std::fflush(nullptr);  // otherwise the child would write the buffered text again
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork");
  if (pid_ == 0) {
    prepare(folder, out[1], err[1], file_size_limit);
    if (in_fork) run_program_and_exit(argv);
    ::execv(WEFT_PROGRAM, argv.data());
    ::_exit(127);
  }
  ::close(out[1]);
  ::close(err[1]);
  out_ = out[0];
  err_ = err[0];
}

Subprocess::~Subprocess() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (out_ >= 0) ::close(out_);
  if (err_ >= 0) ::close(err_);
}

bool Subprocess::read_some(int timeout_ms) {
  std::array<pollfd, 2> ready{pollfd{out_, POLLIN, 0}, pollfd{err_, POLLIN, 0}};  // poll skips negative descriptors
  if (out_ < 0 && err_ < 0) return false;
  if (::poll(ready.data(), ready.size(), timeout_ms) <= 0) return true;
  for (const pollfd& entry : ready) {
    if ((entry.revents & (POLLIN | POLLHUP)) == 0) continue;
    std::array<char, 4096> buffer{};
    const ssize_t size = ::read(entry.fd, buffer.data(), buffer.size());
    if (size > 0) {
      (entry.fd == out_ ? outcome_.out : outcome_.err).append(buffer.data(), static_cast<std::size_t>(size));
    } else if (size == 0 || errno != EINTR) {
      ::close(entry.fd);
      (entry.fd == out_ ? out_ : err_) = -1;
    }
  }
  return true;
}

bool Subprocess::wait_for_output(const std::string& text) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  const auto found = [&] {
    return outcome_.out.find(text) != std::string::npos || outcome_.err.find(text) != std::string::npos;
  };
  while (!found()) {
    if (std::chrono::steady_clock::now() > deadline || !read_some(200)) return found();
  }
  return true;
}

void Subprocess::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

Outcome Subprocess::wait() {
  while (read_some(1000)) {
  }
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  outcome_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome_;
}

Outcome run_weft(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  return Subprocess(arguments, folder, 0, Subprocess::Start::fork).wait();
}

}  // namespace weft::cli
