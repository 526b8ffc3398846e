// weft farm: runs a scene or a sweep as jobs of a Slurm cluster. Each task is a weft command that resumes where it was
// stopped. All state of the tasks is in the folder of the sweep, which the machines share.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/input_file.hpp"
#include "core/json.hpp"
#include "core/log.hpp"
#include "core/temporary_file.hpp"
#include "film/cache/reader.hpp"
#include "tools/cli/child_process.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/estimate.hpp"
#include "tools/cli/farm_scripts.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/program_archive.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/standard_output.hpp"
#include "tools/cli/sweep_report.hpp"
#include "tools/cli/table.hpp"
#include "tools/review/find_runs.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

// Factors on the time and memory that a trial has used; the products are what tasks request. Frames with contact take
// longer than the first frames. A task near its time limit stops and is queued again (scripts/task.sh); a task that
// exceeds its memory is killed.
constexpr double kTimeFactor = 4, kMemoryFactor = 1.5;
constexpr int kMinTaskMinutes = 10, kExtraMemory = 256;  // [min], [MB]

void check_slurm_found(const char* program, const ProcessResult& result) {
  if (result.exit_code == 127)
    throw Error(ExitCode::output_failed,
                "{} is not found: expected a machine that can submit jobs to Slurm; weft farm submit --dry-run writes "
                "scripts for other schedulers",
                program);
}

/// Numbers of the Slurm jobs of this folder that wait or run. Adds to `states` the number of tasks of these jobs in
/// each state. Throws Error(output_failed) if jobs were submitted and Slurm does not answer.
std::vector<std::string> active_jobs(const fs::path& folder, std::map<std::string, int>& states) {
  std::vector<std::string> numbers, active;
  std::istringstream jobs(read_start(folder / "farm/jobs", kMaxTextBytes));  // number, tab and name in each line
  for (std::string line; std::getline(jobs, line);)
    if (const auto tab = line.find('\t'); tab != std::string::npos) numbers.push_back(line.substr(0, tab));
  if (numbers.empty()) return active;
  const ProcessResult queue = run_process({"squeue", "--noheader", "--array", "--format=%A %F %T"});
  check_slurm_found("squeue", queue);
  if (queue.exit_code != 0)
    throw Error(ExitCode::output_failed, "squeue ended with {}; its output is above", queue.exit_code);
  std::istringstream lines(queue.output);
  for (std::string own, array, state; lines >> own >> array >> state;) {
    if (std::ranges::find(numbers, array) == numbers.end()) continue;
    ++states[state];
    if (std::ranges::find(active, array) == active.end()) active.push_back(array);
  }
  return active;
}

/// Progress of a run.
struct State {
  std::string text;
  bool done = false;
};

std::size_t count_files(const fs::path& folder, const char* ending) {
  std::size_t count = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) count += entry.path().extension() == ending ? 1 : 0;
  return count;
}

State state_of(const fs::path& folder, const nlohmann::ordered_json& run) {
  const std::string scene = value_or(run, "scene", std::string());
  const nlohmann::ordered_json stats = read_json_or_null(folder / (scene + ".json"));
  const bool simulated = value_or(stats, "exit_code", -1) == 0;
  const fs::path video = folder / (scene + ".mp4");  // may show an earlier version of the scene
  if (simulated && fs::is_regular_file(video) && scene_hash_of(video) == value_or(stats, "scene_hash", std::string()))
    return {"done", true};
  const auto progress = [&](std::size_t count, const char* all, const char* done) {
    return State{fmt::format("{} of {} frames {}", count, value_or(run, all, 0), done), false};
  };
  if (simulated) return progress(count_files(folder / "frames", ".png"), "drawn_frames", "drawn");
  try {
    return progress(cache::Reader(folder / "cache").frames().size(), "simulated_frames", "simulated");
  } catch (const Error&) {
    return {"not begun", false};
  }
}

class Farm {
 public:
  explicit Farm(const FarmOptions& options) : options_(options), folder_(options.sweep.output) {}

  ExitCode submit() {
    PathLedger paths;
    if (!options_.program.empty()) paths.reads(options_.program, "the program");
    plan_.jobs = read_sweep(options_.sweep, paths);
    check_sweep_folder(options_.sweep, paths, false);
    if (!options_.program.empty()) program_.emplace(options_.program);
    std::map<std::string, int> states;
    if (!options_.dry_run && !active_jobs(folder_, states).empty())
      throw Error(ExitCode::output_failed, "{}: has jobs that wait or run; weft farm cancel {} ends them",
                  folder_.string(), folder_.string());
    plan_.part = options_.part;
    for (std::size_t i = 0; i < plan_.jobs.size(); ++i) {
      SweepJob& job = plan_.jobs[i];
      job.drawn = resolve_frames(options_.frames, job.frame_count);
      plan_.part = std::max(plan_.part, (job.drawn.count() + kMaxArrayTasks - 1) / kMaxArrayTasks);
      if (!job.equal_job && !job.is_done()) plan_.submitted.push_back(i);
    }
    if (plan_.submitted.empty() && is_reported()) {
      log::info(fmt::format("{}: all runs are done", folder_.string()));
      return ExitCode::ok;
    }
    check_pictures();
    find_needs();
    write();
    if (options_.dry_run) return ExitCode::ok;
    const ProcessResult submission = run_process({"sh", (folder_ / "farm/submit.sh").string()});
    check_slurm_found("sbatch", submission);
    if (submission.exit_code != 0)
      throw Error(ExitCode::output_failed, "{}: ended with {}; weft farm cancel {} cancels the submitted jobs",
                  (folder_ / "farm/submit.sh").string(), submission.exit_code, folder_.string());
    if (plan_.submitted.empty())
      log::info(fmt::format("{}: all runs are done; the report on them is submitted", folder_.string()));
    else
      log::info(fmt::format("{}: {} of {} runs submitted; weft farm status {} reports their progress", folder_.string(),
                            plan_.submitted.size(), plan_.jobs.size(), folder_.string()));
    return ExitCode::ok;
  }

  ExitCode status() const {
    const nlohmann::ordered_json index = read_index();
    std::vector<std::vector<std::string>> rows;
    std::size_t done = 0;
    for (const auto& run : index["runs"]) {
      const std::string name = value_or(run, "folder", std::string());
      const State state = state_of(folder_ / name, run);
      done += state.done ? 1 : 0;
      rows.push_back({name, state.text});
    }
    print("{}", format_table(rows, "ll", 2));
    for (const std::string& line : failures()) print("{}\n", line);
    std::map<std::string, int> states;
    try {
      active_jobs(folder_, states);
    } catch (const Error& error) {
      log::warn(error.what());  // the rows above show the progress without Slurm
    }
    std::string queue;
    for (const auto& [state, count] : states) queue += fmt::format(", {} {}", count, state);
    print("{} of {} runs are done{}\n", done, rows.size(), queue);
    return done == rows.size() ? ExitCode::ok : ExitCode::frames_missing;
  }

  ExitCode cancel() const {
    read_index();
    std::map<std::string, int> states;
    std::vector<std::string> words{"scancel"};
    for (const std::string& job : active_jobs(folder_, states)) words.push_back(job);
    if (words.size() > 1) {
      const ProcessResult result = run_process(words);
      check_slurm_found("scancel", result);
      if (result.exit_code != 0)
        throw Error(ExitCode::output_failed, "scancel ended with {}; its output is above", result.exit_code);
    }
    log::info(fmt::format("{}: {} jobs cancelled; finished results are kept, and weft farm submit continues from there",
                          folder_.string(), words.size() - 1));
    return ExitCode::ok;
  }

 private:
  nlohmann::ordered_json read_index() const {
    nlohmann::ordered_json index = read_json_or_null(folder_ / review::kSweepName);
    if (!index.is_object() || !index.contains("runs"))
      throw Error(ExitCode::asset_unreadable, "{}: expected the folder that weft farm submit was given with -o",
                  folder_.string());
    if (index["runs"].size() > kMaxRuns)
      throw Error(ExitCode::asset_unreadable, "{}: expected at most {} runs, got {}",
                  (folder_ / review::kSweepName).string(), kMaxRuns, index["runs"].size());
    return index;
  }

  /// The last message of weft in a log, on a line of its own; empty if there is none.
  static std::string last_error(const fs::path& log) {
    std::string last;
    std::istringstream in(read_end(log, kMaxTextBytes));
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("weft: ")) last = "\n  " + line.substr(6);
    return last;
  }

  /// One text, with the path of the log, for each task that ended with an exit code other than 0 or
  /// could not write its exit code.
  std::vector<std::string> failures() const {
    std::vector<std::string> lines;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_ / "farm/log", none)) {
      if (entry.path().extension() != ".code") continue;
      const std::string task = entry.path().stem().string();
      const fs::path log = fs::path(entry.path()).replace_extension(".log");
      int code = 0;
      std::istringstream(read_start(entry.path(), 16)) >> code;
      if (entry.file_size(none) == 0)
        lines.push_back(fmt::format("{} could not write its exit code: is the disk full? {}", task, log.string()));
      else if (code != 0)
        lines.push_back(fmt::format("{} ended with exit code {}: {}{}", task, code, log.string(), last_error(log)));
    }
    std::ranges::sort(lines);
    return lines;
  }

  /// Whether the report on all runs is there. The task that makes it fails if it finds a run that is not done.
  bool is_reported() const {
    std::error_code none;
    for (const char* file : {"table.csv", "table.md", "page/index.html"})
      if (!fs::is_regular_file(folder_ / file, none)) return false;
    const fs::path file = folder_ / "farm/log/report.code";  // absent if `weft sweep` has made the report
    std::string code;
    std::istringstream(read_start(file, 16)) >> code;
    return code == "0" || !fs::exists(file, none);
  }

  /// Throws Error(output_failed) if pictures show another version of the scene, for example before a change of a
  /// colour; a dry run only warns. Drawing tasks do not replace files, so all of them would fail.
  void check_pictures() const {
    std::vector<std::string> folders;
    for (const std::size_t i : plan_.submitted) {
      const SweepJob& job = plan_.jobs[i];
      const fs::path pictures = job.folder / "frames";
      const std::string hash = fmt::format("{:016x}", job.scene_hash);
      const std::vector<fs::path> files = FramePattern((pictures / "").string(), 5, ".png").names(job.drawn);
      std::error_code none;
      if (std::ranges::any_of(files, [&](const fs::path& file) {
            return fs::is_regular_file(file, none) && scene_hash_of(file) != hash;
          }))
        folders.push_back(pictures.string());
    }
    if (folders.empty()) return;
    const std::string others = folders.size() == 1 ? "" : fmt::format(" and {} more folders", folders.size() - 1);
    const std::string text = fmt::format(
        "{}{}: expected pictures of the scene as it is now, got others, which drawing tasks do not replace; remove "
        "each of these folders",
        folders.front(), others);
    if (!options_.dry_run) throw Error(ExitCode::output_failed, "{}", text);
    log::warn(text);
  }

  // Estimates the resources from trials of the first and the last submitted run, which usually have the smallest and
  // the largest values of the sweep.
  void find_needs() {
    plan_.needs.simulate_minutes = plan_.needs.draw_minutes = options_.minutes.value_or(0);
    plan_.needs.memory = options_.memory.value_or(0);
    if (options_.minutes && options_.memory) return;
    double simulate = 0, picture = 0, peak = 0;
    std::set<std::size_t> tried{0};
    if (!plan_.submitted.empty()) tried = {plan_.submitted.front(), plan_.submitted.back()};
    for (const std::size_t i : tried) {
      SceneOptions scene = options_.sweep.pictures;
      scene.scene = options_.sweep.scene;
      scene.overrides = plan_.jobs[i].overrides();
      // The camera may be missing in this run: then its tasks report it, since other runs may have the camera.
      const std::string camera = std::exchange(scene.camera, {});
      const scene::Scene loaded = load_scene(scene);
      render::Settings settings = render_settings(loaded, scene);
      if (std::ranges::find(loaded.cameras, camera, &scene::Camera::name) != loaded.cameras.end())
        settings.camera = camera;
      const Estimate estimate = estimate_run(loaded, settings);
      simulate = std::max(simulate, estimate.simulate_total());
      picture = std::max(picture, estimate.draw);
      peak = std::max(peak, static_cast<double>(estimate.peak));
    }
    const auto minutes = [](double seconds) { return kMinTaskMinutes + static_cast<int>(kTimeFactor * seconds / 60); };
    if (!options_.minutes) plan_.needs.simulate_minutes = minutes(simulate);
    if (!options_.minutes) plan_.needs.draw_minutes = minutes(picture * plan_.part);
    if (!options_.memory) plan_.needs.memory = kExtraMemory + static_cast<int>(kMemoryFactor * 1e-6 * peak);
    log::info(fmt::format("by a trial: {} min at most to simulate a run, {} min to draw {} frames, {} MB",
                          plan_.needs.simulate_minutes, plan_.needs.draw_minutes, plan_.part, plan_.needs.memory));
  }

  /// Whether submitted jobs wait or run; true also if Slurm does not answer.
  bool may_have_jobs() const {
    try {
      std::map<std::string, int> states;
      return !active_jobs(folder_, states).empty();
    } catch (const Error&) {
      return true;
    }
  }

  /// Writes the scripts, and prints them in a dry run. Tasks read the scripts when they start, so a dry run writes none
  /// while submitted tasks may still wait.
  void write() {
    const bool only_prints = options_.dry_run && may_have_jobs();
    if (program_) plan_.archive = program_->fingerprint();
    if (only_prints) {
      log::info(fmt::format("note: {}: has jobs that may wait or run; the scripts are printed, not written",
                            folder_.string()));
    } else {
      fs::create_directories(folder_ / "farm/log");
      if (program_) write_program();
      write_sweep_index(options_.sweep, plan_.jobs);
      for (const std::size_t i : plan_.submitted) fs::create_directories(folder_ / plan_.jobs[i].run.name);
    }
    for (const auto& [name, text] :
         {std::pair("task.sh", task_script(options_, plan_)), std::pair("submit.sh", submit_script(options_, plan_)),
          std::pair("tasks.tsv", task_list(options_, plan_))}) {
      if (!only_prints) write_file(folder_ / "farm" / name, text);
      if (options_.dry_run) print("==> {} <==\n{}\n", (folder_ / "farm" / name).string(), text);
    }
    if (!options_.dry_run) write_file(folder_ / "farm/jobs", "");  // jobs of an earlier submission may still run
  }

  // Writes the program archive, unless the file exists or a task has unpacked it already.
  void write_program() {
    const fs::path tar = folder_ / program_tar(plan_.archive);
    if (!fs::exists(fs::path(tar).replace_extension()) && !fs::exists(tar)) program_->write_tar(tar);
  }

  const FarmOptions& options_;
  const fs::path folder_;
  FarmPlan plan_;
  std::optional<ProgramArchive> program_;
};

}  // namespace

ExitCode farm(const FarmOptions& options) {
  Farm farm(options);
  switch (options.action) {
    case FarmOptions::Action::submit:
      return farm.submit();
    case FarmOptions::Action::status:
      return farm.status();
    case FarmOptions::Action::cancel:
      break;
  }
  return farm.cancel();
}

}  // namespace weft::cli
