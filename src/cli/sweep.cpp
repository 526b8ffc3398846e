// weft sweep: many runs of one scene. Each is `weft run` in a process of its own, so that what befalls one is nothing
// to the others, and anybody can do one of them again.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "cli/commands.hpp"
#include "cli/path_ledger.hpp"
#include "cli/scene_input.hpp"
#include "cli/signals.hpp"
#include "cli/sweep_report.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "core/temporary_file.hpp"
#include "core/timer.hpp"
#include "review/review.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kIndexFile = "sweep.json";  // also the mark of a folder that sweeps fill
constexpr auto kPause = 20'000;                   // between looks at the processes [microseconds]

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Json read_json(const fs::path& file) {
  Json json = Json::parse(read_text(file), nullptr, false);
  return json.is_discarded() ? Json() : json;
}

/// A run and its process.
struct Job {
  SweepRun run;
  std::uint64_t scene_hash = 0;
  const Job* twin = nullptr;  ///< an earlier run of the same scene, which is not simulated again
  fs::path folder = {};
  std::string scene = {};
  pid_t process = -1;
  ExitCode code = ExitCode::ok;
  bool tried = false;

  fs::path video() const { return folder / (scene + ".mp4"); }
  fs::path stats() const { return folder / (scene + ".json"); }
  fs::path log() const { return folder / "run.log"; }

  /// Of this very scene, to its end.
  bool is_done() const {
    const Json json = read_json(stats());
    return fs::exists(video()) && json.is_object() && json.value("exit_code", -1) == 0 &&
           json.value("scene_hash", "") == fmt::format("{:016x}", scene_hash);
  }

  std::string last_words() const {
    std::string last;
    std::ifstream in(log());
    for (std::string line; std::getline(in, line);)
      if (!line.empty()) last = line;
    return last;
  }
};

class Sweep {
 public:
  explicit Sweep(const SweepOptions& options) : options_(options) {
    const std::vector<Changes> list = options.list.empty() ? std::vector<Changes>{} : read_list(options.list);
    for (SweepRun& run : plan_sweep(list, options.axes)) jobs_.push_back({.run = std::move(run)});
    check_scenes();
    check_folder();
  }

  ExitCode make() {
    write_file(options_.output / kIndexFile, index().dump(2) + "\n");
    run_all();
    const std::vector<SweepResult> results = collect();
    write_reports(results);
    return tell(results);
  }

 private:
  /// Reads all scenes before the first is run: what is wrong with one ends the sweep at once.
  void check_scenes() {
    std::string mistakes;
    std::map<std::uint64_t, const Job*> known;
    for (Job& job : jobs_) {
      const scene::LoadResult loaded = scene::load(options_.scene, overrides(job));
      if (!loaded.ok()) {
        mistakes += (mistakes.empty() ? "" : "\n") + mistakes_text(loaded);
        continue;
      }
      job.scene_hash = loaded.scene.hash;
      job.scene = loaded.scene.name;
      job.folder = options_.output / job.run.name;
      const auto [twin, fresh] = known.emplace(job.scene_hash, &job);
      if (!fresh) job.twin = twin->second;
      if (&job == &jobs_.front()) add_inputs(paths_, loaded.scene);
    }
    if (!mistakes.empty()) throw Error(ExitCode::scene_invalid, mistakes);
  }

  void check_folder() {
    if (!options_.list.empty()) paths_.reads(options_.list, "the list of runs");
    paths_.fills("-o", options_.output);
    const fs::path& folder = options_.output;
    if (!fs::exists(folder) || fs::is_empty(folder)) return;
    const Json before = read_json(folder / kIndexFile);
    if (!before.is_object())
      throw Error(ExitCode::output_failed, "{}: is no folder of a sweep, and not empty; give another name",
                  folder.string());
    if (!options_.overwrite && before["options"] != Json(options_.passed_on))
      throw Error(ExitCode::output_failed,
                  "{}: holds runs with other options ({}); give these, --overwrite to start again, or another name",
                  folder.string(), fmt::join(before.value("options", std::vector<std::string>{}), " "));
  }

  static std::vector<std::string> overrides(const Job& job) {
    std::vector<std::string> texts;
    for (const auto& [key, value] : job.run.changes) texts.push_back(fmt::format("{}={}", key, value));
    return texts;
  }

  std::vector<std::string> command(const Job& job) const {
    std::vector<std::string> words{"weft", "run", options_.scene.string()};
    for (const std::string& text : overrides(job)) words.insert(words.end(), {"--set", text});
    words.insert(words.end(), options_.passed_on.begin(), options_.passed_on.end());
    words.insert(words.end(), {"-o", job.video().string(), "--stats", job.stats().string(), "--progress", "none"});
    words.emplace_back(options_.overwrite ? "--overwrite" : "--resume");
    return words;
  }

  void start(Job& job) const {
    fs::create_directories(job.folder);
    std::vector<std::string> words = command(job);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, job.log().c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    const int problem = ::posix_spawn(&job.process, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (problem != 0)
      throw Error(ExitCode::internal, "{}: cannot be started: {}", job.run.name, std::strerror(problem));
  }

  void run_all() {
    std::vector<Job*> running;
    std::size_t next = 0, ended = 0;
    bool told = false;
    while (next < jobs_.size() || !running.empty()) {
      if (stop_.requested()) {
        next = jobs_.size();
        // The terminal tells the whole group; whoever tells this process alone means them as well.
        if (!std::exchange(told, true))
          for (const Job* job : running) ::kill(job->process, SIGTERM);
      }
      while (next < jobs_.size() && static_cast<int>(running.size()) < options_.jobs) {
        Job& job = jobs_[next++];
        job.tried = true;
        const bool done = !job.twin && !options_.overwrite && job.is_done();
        if (job.twin || done) {
          log::info(fmt::format("[{}/{}] {}: {}", ++ended, jobs_.size(), label_of(job.run),
                                done ? "done already" : "the same scene as " + label_of(job.twin->run)));
          continue;
        }
        start(job);
        running.push_back(&job);
      }
      std::erase_if(running, [&](Job* job) {
        int status = 0;
        if (::waitpid(job->process, &status, WNOHANG) == 0) return false;
        // Killed from outside, or for want of memory: our own code leaves by exit().
        job->code = WIFEXITED(status) ? static_cast<ExitCode>(WEXITSTATUS(status)) : ExitCode::internal;
        const std::string how = job->code == ExitCode::ok
                                    ? "done"
                                    : fmt::format("exit code {}: {}", static_cast<int>(job->code), job->last_words());
        log::info(fmt::format("[{}/{}] {}: {}", ++ended, jobs_.size(), label_of(job->run), how));
        return true;
      });
      if (!running.empty()) ::usleep(kPause);
    }
  }

  std::vector<SweepResult> collect() const {
    std::vector<SweepResult> results;
    for (const Job& job : jobs_) {
      const Job& made = job.twin ? *job.twin : job;
      const ExitCode code = made.tried ? made.code : ExitCode::interrupted;
      results.push_back({job.run, made.video(), read_json(made.stats()), code});
    }
    return results;
  }

  Json index() const {
    Json runs = Json::array();
    for (const Job& job : jobs_) {
      Json set = Json::object();
      for (const auto& [key, value] : job.run.changes) set[key] = value;
      runs.push_back({{"folder", (job.twin ? job.twin : &job)->run.name}, {"set", std::move(set)}});
    }
    return {{"scene", options_.scene.string()}, {"options", options_.passed_on}, {"runs", std::move(runs)}};
  }

  void write_reports(const std::vector<SweepResult>& results) const {
    const fs::path& folder = options_.output;
    const bench::Table table = sweep_table(results);
    write_file(folder / "table.csv", bench::csv(table));
    write_file(folder / "table.md", bench::markdown(table));
    write_sweep_sheet(folder / "sheet.png", results, fmt::format("{}   {} runs", jobs_.front().scene, results.size()),
                      options_.frame);
    const auto has_video = [](const SweepResult& result) { return fs::exists(result.video); };
    if (stop_.requested() || !std::ranges::any_of(results, has_video)) return;
    review::write_review({.folders = {folder}, .reference = {}, .output = folder / "page", .overwrite = true});
  }

  ExitCode tell(const std::vector<SweepResult>& results) const {
    const std::string where =
        fmt::format("{}: {}", options_.output.string(), "sheet.png, table.md, table.csv, page/index.html");
    const auto failed = std::ranges::find_if(results, [](const auto& r) { return r.code != ExitCode::ok; });
    const auto count = std::ranges::count_if(results, [](const auto& r) { return r.code != ExitCode::ok; });
    if (stop_.requested()) {
      log::info(fmt::format("weft: interrupted: {} of {} runs are not done; the same command goes on", count,
                            results.size()));
      return ExitCode::interrupted;
    }
    log::info(where);
    if (failed == results.end()) return ExitCode::ok;
    log::info(fmt::format("weft: {} of {} runs failed:", count, results.size()));
    for (const SweepResult& result : results)
      if (result.code != ExitCode::ok)
        log::info(fmt::format("  {}: exit code {}, {}", label_of(result.run), static_cast<int>(result.code),
                              (options_.output / result.run.name / "run.log").string()));
    return failed->code;
  }

  const SweepOptions& options_;
  const StopSignals stop_{"ending the runs after their current frames"};
  std::vector<Job> jobs_;
  PathLedger paths_;
};

}  // namespace

ExitCode sweep(const SweepOptions& options) {
  return Sweep(options).make();
}

}  // namespace weft::cli
