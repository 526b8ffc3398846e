#include "tools/cli/child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/error.hpp"
#include "core/installation.hpp"

namespace weft::cli {
namespace {

/// Output descriptors of a child process; -1: the child uses that of its parent.
struct Outputs {
  int out = -1, err = -1;
};

/// Replaces the child process by the program. If this fails, returns with the reason in errno. Calls only
/// async-signal-safe functions, since another thread of the parent may have held a lock at the fork.
void exec_program(const std::vector<char*>& argv, Outputs outputs, pid_t parent) {
  // If the parent is killed, the child must end too, since a resumed command would write the same files. posix_spawn()
  // has no option for this.
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return;
  if (::getppid() != parent) ::_exit(127);  // the parent has died before prctl()
  int input[2];  // a pipe without a writer is empty input (a container may lack /dev/null); exec closes the write end
  if (::pipe2(input, O_CLOEXEC) != 0 || ::dup2(input[0], STDIN_FILENO) < 0) return;
  if (outputs.out >= 0 && ::dup2(outputs.out, STDOUT_FILENO) < 0) return;
  if (outputs.err >= 0 && ::dup2(outputs.err, STDERR_FILENO) < 0) return;
  ::execvp(argv[0], argv.data());
}

/// Returns 0, or the errno if the process could not be started.
int start(std::vector<std::string> arguments, Outputs outputs, pid_t& process) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::array<int, 2> exec_error_pipe{};
  if (::pipe2(exec_error_pipe.data(), O_CLOEXEC) != 0) return errno;
  const pid_t parent = ::getpid();
  process = ::fork();
  int problem = process < 0 ? errno : 0;
  if (process == 0) {
    exec_program(argv, outputs, parent);
    problem = errno;
    ::_exit(::write(exec_error_pipe[1], &problem, sizeof problem) < 0 ? 126 : 127);
  }
  ::close(exec_error_pipe[1]);
  // If the program starts, exec closes the pipe, and read() returns 0.
  while (process > 0 && ::read(exec_error_pipe[0], &problem, sizeof problem) < 0 && errno == EINTR) continue;
  ::close(exec_error_pipe[0]);
  if (process > 0 && problem != 0) ::waitpid(process, nullptr, 0);
  return problem;
}

[[noreturn]] void fail(const std::string& program, int problem) {
  throw Error(ExitCode::output_failed, "{}: cannot be started: {}", program, std::strerror(problem));
}

}  // namespace

std::filesystem::path own_program() {
  std::filesystem::path program = own_installation().program;
  if (program.empty())
    throw Error(ExitCode::usage,
                "/proc/self/exe: cannot be read: expected /proc to be mounted, to start this program again");
  if (program.filename() == kToolsName) program.replace_filename("weft");
  return program;
}

std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

pid_t start_process(const std::vector<std::string>& arguments, const std::filesystem::path& log) {
  Outputs outputs;
  if (!log.empty()) {
    // If `log` is a named pipe, opening it without O_NONBLOCK would wait for a reader.
    outputs.out = outputs.err = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666);
    if (outputs.out < 0)
      throw Error(ExitCode::output_failed, "{}: cannot be written: {}", log.string(), std::strerror(errno));
  }
  pid_t process = -1;
  const int problem = start(arguments, outputs, process);
  if (outputs.out >= 0) ::close(outputs.out);
  if (problem != 0) fail(arguments[0], problem);
  return process;
}

ProcessResult run_process(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(arguments[0], errno);
  pid_t process = -1;
  const int problem = start(arguments, {.out = ends[1]}, process);
  ::close(ends[1]);
  ProcessResult result{127, {}};
  std::array<char, 4096> bytes;
  for (ssize_t count = 0; problem == 0 && (count = ::read(ends[0], bytes.data(), bytes.size())) != 0;) {
    if (count > 0) result.output.append(bytes.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) break;
  }
  ::close(ends[0]);
  int status = 0;
  while (problem == 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  if (problem == 0) result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace weft::cli
