#include "tools/cli/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <variant>

#include "core/input_file.hpp"
#include "core/installation.hpp"
#include "core/log.hpp"
#include "film/garment/pattern.hpp"
#include "film/scene/loader.hpp"
#include "tools/cli/child_process.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/main.hpp"
#include "tools/cli/signals.hpp"
#include "tools/cli/standard_output.hpp"

namespace weft::cli {
namespace {

ExitCode print_all(const std::string& text) {
  write_standard_output(text);
  return ExitCode::ok;
}

struct Dispatch {
  ExitCode operator()(const RunOptions& options) const { return run(options); }
  ExitCode operator()(const SimulateOptions& options) const { return simulate(options); }
  ExitCode operator()(const RenderOptions& options) const { return render(options); }
  ExitCode operator()(const CheckOptions& options) const { return check(options); }
  ExitCode operator()(const ThumbnailOptions& options) const { return thumbnail(options); }
  ExitCode operator()(const SheetOptions& options) const { return sheet(options); }
  ExitCode operator()(const NewOptions& options) const { return make_new(options); }
  ExitCode operator()(const WatchOptions& options) const { return watch(options); }
  ExitCode operator()(const SchemaOptions& options) const {
    return print_all(options.pattern ? scene::json_schema(garment::pattern_rules(), "Weft pattern")
                                     : scene::json_schema());
  }
  ExitCode operator()(const PrintText& text) const { return print_all(text.text); }
  template <class ToolOptions>
  ExitCode operator()(const ToolOptions&) const {
    return run_other(command, argv);
  }

  const Command& command;
  char** argv;
  ExitCode (*run_other)(const Command&, char**);
};

// Corrects what a process inherits from its caller: closed standard streams and ignored signals.
void prepare_streams_and_signals() {
  // If a standard stream is closed, the next opened file would get its number, and messages would be written into that
  // file. Opening "/" takes the number instead: "/" always exists, and each write to it fails.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && ::open("/", O_RDONLY) < 0) break;
  // If SIGCHLD is ignored, the exit codes of child processes are lost, and failures would count as successes.
  ::signal(SIGCHLD, SIG_DFL);
  // If a pipe is closed or a file exceeds its size limit, write() must return an error. By default, a signal kills the
  // process, which then leaves an incomplete file.
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  end_on_signals();
}

// Throws if the working folder, from which relative paths start, does not exist.
void check_working_folder() {
  std::error_code error;
  if (std::filesystem::current_path(error).empty())
    throw Error(ExitCode::usage, "the working folder cannot be used: {}; go to one that exists", error.message());
}

// Replaces this process by weft-tools in the folder of weft. Throws Error(usage) if weft-tools cannot be started.
ExitCode become_tools(const Command& /*command*/, char** argv) {
  const std::filesystem::path tools = own_program().replace_filename(kToolsName);
  ::execv(tools.c_str(), argv);
  throw Error(ExitCode::usage,
              "{}: cannot be started: {}; this command needs it beside the program, where ./weft builds it",
              tools.string(), std::strerror(errno));
}

}  // namespace

int run_program(int argc, char** argv, ExitCode (*run_other)(const Command& command, char** argv)) noexcept {
  try {
    prepare_streams_and_signals();
    // If the program comes from an archive, the dynamic loader starts it. Without this call, the process would have the
    // name of the loader.
    if (const Installation own = own_installation(); !own.libraries.empty())
      ::prctl(PR_SET_NAME, own.code.filename().c_str());
    const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    const Command command = parse_command_line(arguments);
    if (!std::holds_alternative<PrintText>(command)) check_working_folder();
    return static_cast<int>(std::visit(Dispatch{command, argv, run_other}, command));
  } catch (...) {
    const Failure failure = describe_failure(std::current_exception());
    report(failure);
    return static_cast<int>(failure.code);
  }
}

int run_weft(int argc, char** argv) noexcept {
  return run_program(argc, argv, become_tools);
}

}  // namespace weft::cli
