// The commands of weft-tools that weft does not have.
#include <variant>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/main.hpp"
#include "tools/cli/program.hpp"

namespace weft::cli {
namespace {

struct Dispatch {
  ExitCode operator()(const JoinOptions& options) const { return join(options); }
  ExitCode operator()(const SweepOptions& options) const { return sweep(options); }
  ExitCode operator()(const FarmOptions& options) const { return farm(options); }
  ExitCode operator()(const DoctorOptions& options) const { return doctor(options); }
  ExitCode operator()(const BenchOptions& options) const { return bench(options); }
  ExitCode operator()(const DiffOptions& options) const { return diff(options); }
  ExitCode operator()(const AcceptOptions& options) const { return accept(options); }
  ExitCode operator()(const ReviewOptions& options) const { return review(options); }
  ExitCode operator()(const ExportOptions& options) const {
    return read_checked(options.cache, [&] { return export_frames(options); });
  }
  template <class FilmOptions>
  ExitCode operator()(const FilmOptions&) const {
    throw Error(ExitCode::internal, "a command that makes films came to the tools");
  }
};

}  // namespace

int run_weft_tools(int argc, char** argv) noexcept {
  return run_program(argc, argv, [](const Command& command, char**) { return std::visit(Dispatch{}, command); });
}

}  // namespace weft::cli
