// weft watch: draws a scene again whenever one of its files changes.
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "core/log.hpp"
#include "tools/cli/child_process.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/signals.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto kFilePollPause = 100'000;  // between checks of the files and of the drawing process [microseconds]

/// Modification times of files; a missing file has the default time.
using Stamps = std::map<fs::path, fs::file_time_type>;

Stamps stamps_of(const std::vector<fs::path>& files) {
  Stamps stamps;
  for (const fs::path& file : files) {
    std::error_code none;
    stamps[file] = fs::last_write_time(file, none);
    if (none) stamps[file] = {};
  }
  return stamps;
}

class Watch {
 public:
  explicit Watch(const WatchOptions& options) : options_(options) {
    // Each drawing replaces the output. Checks that an existing output is an earlier drawing of the scene. Films of
    // `weft watch` are recognised by their names, because `weft run` makes the same ones.
    const auto option = std::ranges::find(options.passed_on, "--output");
    const bool start = std::ranges::find(options.passed_on, "--start") != options.passed_on.end();
    const std::string scene = options.scene.stem().string();
    const char* ending = options.film ? ".watch.mp4" : start ? ".start.png" : ".png";
    const fs::path output =
        option != options.passed_on.end() ? fs::path(*(option + 1)) : fs::path("output") / (scene + ending);
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(output, ignored)) && !is_output_of(output, scene))
      throw Error(ExitCode::output_failed, "{}: exists already, and is no picture of {}; give another name",
                  output.string(), scene);
    if (options.film && fs::exists(output, ignored) && output.stem().extension() != ".watch")
      throw Error(ExitCode::output_failed,
                  "{}: exists already, and may be a film of weft run; give a name that ends in .watch{}, which is "
                  "replaced, or remove the film",
                  output.string(), output.extension().string());
    if (options.film && option == options.passed_on.end()) film_output_ = {"--output", output.string()};
  }

  /// Returns the exit code of the last drawing if the number of drawings is limited, and `ok` after a stop request.
  ExitCode draw_repeatedly() {
    for (int times = 0; !stop_.requested() && (options_.times == 0 || times < options_.times); ++times) {
      // If the scene is invalid, its list of files is incomplete, so the scene file is always added.
      const scene::LoadResult loaded = scene::load(options_.scene, options_.overrides);
      files_ = {options_.scene};
      files_.insert(files_.end(), loaded.scene.files.begin(), loaded.scene.files.end());
      drawn_ = stamps_of(files_);
      const ExitCode code = draw();
      if (options_.times != 0 && times + 1 == options_.times) return code;
      while (!stop_.requested() && !changed()) ::usleep(kFilePollPause);
    }
    return ExitCode::ok;
  }

 private:
  bool changed() const { return stamps_of(files_) != drawn_; }

  /// Draws in a separate process, which reports its own errors. Kills this process if a file changes or a stop is
  /// requested. Returns the exit code of the process; if it was killed here, ExitCode::interrupted.
  ExitCode draw() const {
    std::vector<std::string> words{own_program().string(),
                                   options_.film ? "run" : "thumbnail",
                                   options_.scene.string(),
                                   "--overwrite",
                                   "--progress",
                                   "none"};
    words.insert(words.end(), options_.passed_on.begin(), options_.passed_on.end());
    words.insert(words.end(), film_output_.begin(), film_output_.end());
    for (const std::string& text : options_.overrides) words.insert(words.end(), {"--set", text});
    const pid_t process = start_process(words, "");
    bool is_killed = false;
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
      if (!is_killed && (stop_.requested() || changed())) {
        ::kill(process, SIGKILL);  // leaves no partial output: outputs get their names when they are complete
        is_killed = true;
      }
      ::usleep(kFilePollPause);
    }
    if (is_killed) return ExitCode::interrupted;
    return WIFEXITED(status) ? static_cast<ExitCode>(WEXITSTATUS(status)) : ExitCode::internal;
  }

  const WatchOptions& options_;
  std::vector<std::string> film_output_;  // option for the default name of a film; empty if a name is given
  const StopSignals stop_{"ending"};
  std::vector<fs::path> files_;
  Stamps drawn_;
};

}  // namespace

ExitCode watch(const WatchOptions& options) {
  return Watch(options).draw_repeatedly();
}

}  // namespace weft::cli
