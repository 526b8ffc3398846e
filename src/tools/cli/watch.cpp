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
#include "core/stop.hpp"
#include "film/cache/writer.hpp"
#include "tools/cli/child_process.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/output_target.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/signals.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto kFilePollPause = 100'000;  // between checks of the files and of the drawing process [microseconds]

/// Modification times of files; a missing file has the earliest time.
using Stamps = std::map<fs::path, fs::file_time_type>;

Stamps stamps_of(const std::vector<fs::path>& files) {
  Stamps stamps;
  for (const fs::path& file : files) {
    std::error_code none;
    stamps[file] = fs::last_write_time(file, none);
  }
  return stamps;
}

class Watch {
 public:
  explicit Watch(const WatchOptions& options) : options_(options), passed_on_(options.passed_on) {
    const bool start = std::ranges::find(passed_on_, "--start") != passed_on_.end();
    const std::string scene = options.scene.stem().string();
    fs::path output = "output";
    if (const auto option = std::ranges::find(passed_on_, "--output"); option != passed_on_.end()) {
      output = *(option + 1);
      passed_on_.erase(option, option + 2);
    }
    if (!output.has_extension())
      output /= scene + (start ? ".start" : "") + (options.film ? ".watch.mp4" : ".watch.png");
    passed_on_.insert(passed_on_.end(), {"--output", output.string()});
    if (options.film) cache_ = working_cache(parse_output(output.string(), scene), scene);
    // Each drawing replaces the output. Drawings of earlier calls are recognised by their names, because `weft run` and
    // `weft thumbnail` make the same videos and pictures.
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(output, ignored))) return;
    const std::string kind = options.film ? "film" : "picture";
    if (!is_output_of(output, scene))
      throw Error(ExitCode::output_failed, "{}: exists already, and is no {} of {}; give another name", output.string(),
                  kind, scene);
    if (output.stem().extension() != ".watch")
      throw Error(ExitCode::output_failed,
                  "{}: exists already, and may be a {} of weft {}; give a name that ends in .watch{}, which is "
                  "replaced, or remove the {}",
                  output.string(), kind, options.film ? "run" : "thumbnail", output.extension().string(), kind);
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

  /// Draws in a child process, which reports its own errors. Ends the child if a file changes or a stop is requested.
  /// Returns the exit code of the child, or ExitCode::interrupted if it was ended here.
  ExitCode draw() const {
    std::vector<std::string> words{own_program().string(), options_.film ? "run" : "thumbnail", "--overwrite",
                                   "--progress", "none"};
    words.insert(words.end(), passed_on_.begin(), passed_on_.end());
    for (const std::string& text : options_.overrides) words.insert(words.end(), {"--set", text});
    words.insert(words.end(), {"--", options_.scene.string()});  // its name may begin with a dash
    const pid_t process = start_process(words, "");
    bool is_ended = false;
    long long next_signal_at = 0;  // [ns]
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
      if (stop_.requested() && monotonic_ns() >= next_signal_at) {
        // The first signal ends the child after its current frame, which may take kStopGrace and the drawing; the
        // second one ends it at once. With either, the child removes its temporary files.
        ::kill(process, SIGTERM);
        next_signal_at = monotonic_ns() + 2 * kStopGrace;
        is_ended = true;
      } else if (!is_ended && changed()) {
        // Leaves no partial output: outputs get their names when they are complete. The next drawing, which need not
        // wait for a frame, removes the temporary files.
        ::kill(process, SIGKILL);
        is_ended = true;
      }
      ::usleep(kFilePollPause);
    }
    if (is_ended) {
      remove_cache();
      return ExitCode::interrupted;
    }
    return WIFEXITED(status) ? static_cast<ExitCode>(WEXITSTATUS(status)) : ExitCode::internal;
  }

  /// Removes the cache of an unfinished film, since the next drawing does not resume it.
  void remove_cache() const {
    std::error_code ignored;
    if (cache_.empty() || !fs::is_directory(cache_, ignored)) return;
    try {
      cache::Lock(cache_).remove();
    } catch (const Error& error) {
      log::warn(error.what());
    }
  }

  const WatchOptions& options_;
  std::vector<std::string> passed_on_;  // those of options_, with the output as a file
  fs::path cache_;                      // working cache of the child; empty: it has none, as it draws a still
  const StopSignals stop_{"ending"};
  std::vector<fs::path> files_;
  Stamps drawn_;
};

}  // namespace

ExitCode watch(const WatchOptions& options) {
  return Watch(options).draw_repeatedly();
}

}  // namespace weft::cli
