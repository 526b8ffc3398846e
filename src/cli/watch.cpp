// weft watch: draws a scene again whenever one of its files changes.
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/child_process.hpp"
#include "cli/commands.hpp"
#include "cli/own_files.hpp"
#include "cli/scene_input.hpp"
#include "cli/signals.hpp"
#include "core/error.hpp"
#include "core/log.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto kFilePollPause = 100'000;  // also of the process [microseconds]

/// When which files were changed; those that are not there have no time.
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
    // What is drawn takes the place of what was drawn before, and of nothing else.
    const auto option = std::ranges::find(options.passed_on, "--output");
    const std::string scene = options.scene.stem().string();
    const fs::path output = option != options.passed_on.end()
                                ? fs::path(*(option + 1))
                                : fs::path("output") / (scene + (options.film ? ".mp4" : ".png"));
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(output, ignored)) && !is_output_of(output, scene))
      throw Error(ExitCode::output_failed, "{}: exists already, and is no picture of {}; give another name",
                  output.string(), scene);
  }

  ExitCode look() {
    for (int times = 0; !stop_.requested() && (options_.times == 0 || times < options_.times); ++times) {
      // A scene that is wrong names what it could: its own file at least.
      const scene::LoadResult loaded = scene::load(options_.scene, options_.overrides);
      files_ = {options_.scene};
      files_.insert(files_.end(), loaded.scene.files.begin(), loaded.scene.files.end());
      drawn_ = stamps_of(files_);
      draw();
      if (options_.times != 0 && times + 1 == options_.times) break;
      while (!stop_.requested() && !changed()) ::usleep(kFilePollPause);
    }
    return ExitCode::ok;
  }

 private:
  bool changed() const { return stamps_of(files_) != drawn_; }

  /// In a process of its own, which says itself what is wrong; ended where a file changes meanwhile.
  void draw() const {
    std::vector<std::string> words{own_program().string(),
                                   options_.film ? "run" : "thumbnail",
                                   options_.scene.string(),
                                   "--overwrite",
                                   "--progress",
                                   "none"};
    words.insert(words.end(), options_.passed_on.begin(), options_.passed_on.end());
    for (const std::string& text : options_.overrides) words.insert(words.end(), {"--set", text});
    const pid_t process = start_process(words, "");
    bool told = false;
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
      if (!told && (stop_.requested() || changed())) {
        ::kill(process, SIGKILL);  // what it writes gets its name when it is whole
        told = true;
      }
      ::usleep(kFilePollPause);
    }
  }

  const WatchOptions& options_;
  const StopSignals stop_{"ending"};
  std::vector<fs::path> files_;
  Stamps drawn_;
};

}  // namespace

ExitCode watch(const WatchOptions& options) {
  return Watch(options).look();
}

}  // namespace weft::cli
