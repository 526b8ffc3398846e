#include "cli/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/error.hpp"

namespace weft::cli {
namespace {

/// What a process is started with, besides its name.
class Files {
 public:
  Files() {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  ~Files() { posix_spawn_file_actions_destroy(&actions_); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

int spawn(std::vector<std::string> words, Files& files, pid_t& process) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return ::posix_spawnp(&process, arguments[0], files.get(), nullptr, arguments.data(), environ);
}

}  // namespace

std::filesystem::path own_program() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

pid_t start_process(const std::vector<std::string>& words, const std::filesystem::path& log) {
  Files files;
  if (!log.empty()) {
    posix_spawn_file_actions_addopen(files.get(), STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(files.get(), STDOUT_FILENO, STDERR_FILENO);
  }
  pid_t process = -1;
  const int problem = spawn(words, files, process);
  if (problem != 0) throw Error(ExitCode::internal, "{}: cannot be started: {}", words[0], std::strerror(problem));
  return process;
}

ProcessResult run_process(const std::vector<std::string>& words) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(ExitCode::internal, "{}: cannot be started: {}", words[0], std::strerror(errno));
  Files files;
  posix_spawn_file_actions_adddup2(files.get(), ends[1], STDOUT_FILENO);
  pid_t process = -1;
  const int problem = spawn(words, files, process);
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
