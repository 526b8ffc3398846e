// weft sweep: many runs of one scene. Each run is a process `weft run`, so that a failure does not affect other runs,
// and each run can be repeated alone.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <system_error>

#include "core/input_file.hpp"
#include "core/json.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "core/temporary_file.hpp"
#include "core/timer.hpp"
#include "tools/cli/child_process.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/signals.hpp"
#include "tools/cli/sweep_jobs.hpp"
#include "tools/cli/sweep_report.hpp"
#include "tools/review/find_runs.hpp"
#include "tools/review/review.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto kProcessPollPause = 20'000;  // [microseconds]

struct Job : SweepJob {
  pid_t process = -1;
  ExitCode code = ExitCode::ok;
  bool was_reached = false;

  fs::path log() const { return folder / "run.log"; }

  /// Returns `ok` if the run is done, else the exit code of its failure from the statistics.
  /// Returns frames_missing if the statistics name no failure: the statistics or the video are
  /// missing, or the statistics belong to another scene.
  ExitCode outcome() const {
    if (is_done()) return ExitCode::ok;
    const auto reported = static_cast<ExitCode>(value_or(read_json_or_null(stats()), "exit_code", 0));
    constexpr std::array kFailures{ExitCode::internal,          ExitCode::usage,         ExitCode::scene_invalid,
                                   ExitCode::asset_unreadable,  ExitCode::output_failed, ExitCode::frames_missing,
                                   ExitCode::simulation_failed, ExitCode::interrupted};
    return std::ranges::find(kFailures, reported) != kFailures.end() ? reported : ExitCode::frames_missing;
  }

  std::string last_log_line() const {
    std::string last;
    std::istringstream in(read_end(log(), kMaxTextBytes));
    for (std::string line; std::getline(in, line);)
      if (!line.empty()) last = line;
    return last;
  }
};

class Sweep {
 public:
  explicit Sweep(const SweepOptions& options) : options_(options) {
    plan_ = read_sweep(options_, paths_);
    for (const SweepJob& job : plan_) jobs_.push_back({job});
    check_sweep_folder(options_, paths_, true);
    if (options_.only_report && !fs::exists(options_.output / review::kSweepName))
      throw Error(ExitCode::asset_unreadable, "{}: expected the folder of a sweep, whose runs --report gathers",
                  options_.output.string());
  }

  ExitCode make() {
    if (!options_.only_report) {
      if (options_.overwrite) remove_results();
      write_sweep_index(options_, plan_);
      run_all();
    }
    const std::vector<SweepResult> results = collect();
    write_reports(results);
    return report_results(results);
  }

 private:
  /// Removes statistics and videos of all runs, by which a sweep and `weft run --resume` recognise finished runs.
  /// Without this, if the sweep is stopped, the next sweep would accept results that were made with earlier options, or
  /// videos whose statistics are missing.
  void remove_results() const {
    std::error_code none;  // what cannot be removed is reported by the run that replaces it
    for (const Job& job : jobs_)
      for (const fs::path& file : {job.stats(), job.video()})
        if (!fs::is_directory(file, none)) fs::remove(file, none);
  }

  std::vector<std::string> command(const Job& job) const {
    std::vector<std::string> words{own_program().string(), "run"};
    for (const std::string& text : job.overrides()) words.insert(words.end(), {"--set", text});
    words.insert(words.end(), options_.passed_on.begin(), options_.passed_on.end());
    words.insert(words.end(), {"-o", job.video().string(), "--stats", job.stats().string(), "--progress", "none"});
    // The name of the scene may begin with a dash.
    words.insert(words.end(), {options_.overwrite ? "--overwrite" : "--resume", "--", options_.scene.string()});
    return words;
  }

  void start(Job& job) const {
    fs::create_directories(job.folder);
    job.process = start_process(command(job), job.log());
  }

  void run_all() {
    std::vector<Job*> running;
    std::size_t next = 0, ended = 0;
    bool has_sent_signals = false;
    while (next < jobs_.size() || !running.empty()) {
      if (stop_.requested()) {
        next = jobs_.size();
        // A terminal signals the whole process group, but other senders may signal this process alone. So each run gets
        // SIGTERM from here.
        if (!std::exchange(has_sent_signals, true))
          for (const Job* job : running) ::kill(job->process, SIGTERM);
      }
      while (next < jobs_.size() && static_cast<int>(running.size()) < options_.jobs) {
        Job& job = jobs_[next++];
        job.was_reached = true;
        const bool done = !job.equal_job && !options_.overwrite && job.is_done();
        if (job.equal_job || done) {
          log::info(fmt::format("[{}/{}] {}: {}", ++ended, jobs_.size(), label_of(job.run),
                                done ? "done already" : "the same scene as " + label_of(jobs_[*job.equal_job].run)));
          continue;
        }
        start(job);
        running.push_back(&job);
      }
      std::erase_if(running, [&](Job* job) {
        int status = 0;
        if (::waitpid(job->process, &status, WNOHANG) == 0) return false;
        // A process without an exit code was killed by a signal, for example for lack of memory.
        job->code = WIFEXITED(status) ? static_cast<ExitCode>(WEXITSTATUS(status)) : ExitCode::internal;
        const std::string how = job->code == ExitCode::ok ? "done"
                                                          : fmt::format("exit code {}: {}", static_cast<int>(job->code),
                                                                        job->last_log_line());
        log::info(fmt::format("[{}/{}] {}: {}", ++ended, jobs_.size(), label_of(job->run), how));
        return true;
      });
      if (!running.empty()) ::usleep(kProcessPollPause);
    }
  }

  std::vector<SweepResult> collect() const {
    std::vector<SweepResult> results;
    for (const Job& job : jobs_) {
      const Job& made = job.equal_job ? jobs_[*job.equal_job] : job;
      const ExitCode code = options_.only_report ? made.outcome()
                            : made.was_reached   ? made.code
                                                 : ExitCode::interrupted;
      results.push_back({job.run, made.video(), read_json_or_null(made.stats()), code});
    }
    return results;
  }

  void write_reports(const std::vector<SweepResult>& results) const {
    const fs::path& folder = options_.output;
    const bench::Table table = sweep_table(results);
    write_file(folder / "table.csv", bench::csv(table));
    write_file(folder / "table.md", bench::markdown(table));
    write_sweep_sheet(folder / "sheet.png", results, fmt::format("{}   {} runs", jobs_.front().scene, results.size()),
                      options_.frame);
    const auto is_shown = [](const SweepResult& r) { return r.stats.is_object() || fs::is_regular_file(r.video); };
    if (stop_.requested() || !std::ranges::any_of(results, is_shown)) return;
    review::write_review({.folders = {folder}, .reference = {}, .output = folder / "page", .overwrite = true});
  }

  ExitCode report_results(const std::vector<SweepResult>& results) const {
    const auto failed = std::ranges::find_if(results, [](const auto& r) { return r.code != ExitCode::ok; });
    const auto count = std::ranges::count_if(results, [](const auto& r) { return r.code != ExitCode::ok; });
    if (stop_.requested()) {
      log::info(fmt::format("weft: interrupted: {} of {} runs are not finished; the same command {}", count,
                            results.size(), options_.overwrite ? "starts again" : "continues"));
      return ExitCode::interrupted;
    }
    std::vector<std::string> made;  // files that exist; if no run has a picture, there is no sheet
    for (const char* file : {"sheet.png", "table.md", "table.csv", "page/index.html"})
      if (fs::is_regular_file(options_.output / file)) made.emplace_back(file);
    log::info(fmt::format("{}: {}", options_.output.string(), fmt::join(made, ", ")));
    if (failed == results.end()) return ExitCode::ok;
    log::info(fmt::format("weft: {} of {} runs {}:", count, results.size(),
                          options_.only_report ? "are not done" : "failed"));
    for (const SweepResult& result : results)
      if (result.code != ExitCode::ok && options_.only_report)
        log::info(fmt::format("  {}", label_of(result.run)));
      else if (result.code != ExitCode::ok)
        log::info(fmt::format("  {}: exit code {}, {}", label_of(result.run), static_cast<int>(result.code),
                              (options_.output / result.run.name / "run.log").string()));
    return failed->code;
  }

  const SweepOptions& options_;
  const StopSignals stop_{"ending the runs after their current frames"};
  std::vector<SweepJob> plan_;
  std::vector<Job> jobs_;
  PathLedger paths_;
};

}  // namespace

ExitCode sweep(const SweepOptions& options) {
  return Sweep(options).make();
}

}  // namespace weft::cli
