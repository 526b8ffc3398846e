#include "tools/cli/farm_scripts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "core/version.hpp"
#include "embedded_cli.hpp"
#include "tools/cli/child_process.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

std::string quoted_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " " + quoted(word);
  return text;
}

// The options of `passed_on` whose names are in `names`, with their values.
std::vector<std::string> select_options(const std::vector<std::string>& passed_on,
                                        std::initializer_list<const char*> names) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < passed_on.size(); ++i) {
    const bool has_value = i + 1 < passed_on.size() && !passed_on[i + 1].starts_with("--");
    if (std::find(names.begin(), names.end(), passed_on[i]) != names.end())
      words.insert(words.end(), passed_on.begin() + static_cast<std::ptrdiff_t>(i),
                   passed_on.begin() + static_cast<std::ptrdiff_t>(i + (has_value ? 2 : 1)));
    i += has_value ? 1 : 0;
  }
  return words;
}

// Arguments of the command that reports the results of all tasks: the same sweep with --report.
std::vector<std::string> report_words(const SweepOptions& sweep) {
  std::vector<std::string> words{"sweep", fs::absolute(sweep.scene).string()};
  for (const Axis& axis : sweep.axes)
    words.insert(words.end(), {"--set", fmt::format("{}={}", axis.key, fmt::join(axis.values, ","))});
  if (!sweep.list.empty()) words.insert(words.end(), {"--list", fs::absolute(sweep.list).string()});
  if (sweep.frame) words.insert(words.end(), {"--frame", std::to_string(*sweep.frame)});
  words.insert(words.end(), sweep.passed_on.begin(), sweep.passed_on.end());
  words.insert(words.end(), {"--report", "-o", "."});
  return words;
}

std::string_view embedded(std::string_view name) {
  return std::ranges::find(kEmbeddedCli, name, &EmbeddedFile::name)->text;
}

/// Indices in Slurm's notation, such as 0-3,7.
std::string array_text(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    fmt::format_to(std::back_inserter(text), "{}{}", text.empty() ? "" : ",", indices[i]);
    if (last > i) fmt::format_to(std::back_inserter(text), "-{}", indices[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace

std::string program_tar(const std::string& archive) {
  return "farm/program/" + archive + ".tar";
}

std::string task_script(const FarmOptions& options, const FarmPlan& plan) {
  const SweepOptions& sweep = options.sweep;
  const std::vector<std::string>& passed_on = sweep.passed_on;
  const std::string unpacked =
      plan.archive.empty() ? "" : fs::path(program_tar(plan.archive)).replace_extension().string();
  const std::string program = plan.archive.empty() ? own_program().string() : "./" + unpacked + "/weft/bin/weft";
  std::string text = fmt::format(
      "#!/bin/sh\n# A task of the runs in this folder, by Weft {}; farm/tasks.tsv has all of them.\n"
      "weft=${{WEFT:-{}}}\ncd {} || exit 6\nunpacked={}\nretries={}\nframes_each={}\n",
      kVersion, quoted(program), quoted(fs::absolute(sweep.output).lexically_normal().string()), quoted(unpacked),
      options.retries, plan.part);
  const auto define = [&](const char* name, const std::vector<std::string>& words) {
    fmt::format_to(std::back_inserter(text), "{}() {{ unpack && exec \"$weft\"{} \"$@\"; }}\n", name,
                   quoted_words(words));
  };
  const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const std::string threads = std::to_string(options.threads);
  // The simulation task needs size and camera too, since the cache stores them.
  define("simulate", with({"simulate", fs::absolute(sweep.scene).string(), "--threads", threads},
                          select_options(passed_on, {"--size", "--camera", "--error"})));
  define("draw",
         with({"render", "--threads", threads}, select_options(passed_on, {"--size", "--camera", "--quality"})));
  define("join", {"join"});
  define("report", report_words(sweep));
  text +=
      "\ntask=$1 run=${2:-$SLURM_ARRAY_TASK_ID} part=${3:-$SLURM_ARRAY_TASK_ID}\n"
      "case $run in *+) run=$((${run%+} + SLURM_ARRAY_TASK_ID)) ;; esac # from this one on\n"
      "label=$task${run:+_$run}\n"
      "case $task in\n  draw) label=${label}_$part ;;\n  report | unpack) label=$task ;;\nesac\n"
      "exec >>\"farm/log/$label.log\" 2>&1\n\n"
      "case $run in\n";
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (plan.jobs[i].equal_job) continue;
    const SweepJob& job = plan.jobs[i];
    std::vector<std::string> words;
    for (const std::string& set : job.overrides()) words.insert(words.end(), {"--set", set});
    fmt::format_to(std::back_inserter(text),
                   "  {}) name={} scene={} begin={} end={} step={} simulated={}\n     set --{} ;;\n", i,
                   quoted("./" + job.run.name), quoted(job.scene), job.drawn.begin, job.drawn.end, job.drawn.step,
                   job.simulated_count(), quoted_words(words));
  }
  text += "esac\n\n";
  return text.append(embedded("task.sh"));
}

std::string submit_script(const FarmOptions& options, const FarmPlan& plan) {
  std::string text = fmt::format(
      "#!/bin/sh\n# Hands the tasks of this folder to Slurm; their numbers go to farm/jobs.\ncd {}\n"
      "run_sbatch() {{ sbatch --cpus-per-task={} --mem={}M{} \"$@\"; }}\n{}",
      quoted(fs::absolute(options.sweep.output).lexically_normal().string()), options.threads, plan.needs.memory,
      quoted_words(options.for_scheduler), embedded("submit.sh"));
  const auto out = std::back_inserter(text);
  std::string after;
  if (!plan.archive.empty()) {
    fmt::format_to(out, "submit_task unpack unpack --time={}\nunpack=$job\n", plan.needs.draw_minutes);
    after = " --dependency=\"afterok:$unpack\"";
  }
  // The simulations of up to kMaxArrayTasks runs form one job array. The drawing tasks of a run wait only for the
  // element of the array that simulates this run.
  for (std::size_t at = 0; at < plan.submitted.size();) {
    const std::size_t base = plan.submitted[at];
    std::vector<std::size_t> offsets;
    std::size_t end = at;
    for (; end < plan.submitted.size() && plan.submitted[end] - base < std::size_t{kMaxArrayTasks}; ++end)
      offsets.push_back(plan.submitted[end] - base);
    fmt::format_to(out, "submit_task simulate 'simulate {}+' --time={} --array={}{}\nsimulate=$job\n", base,
                   plan.needs.simulate_minutes, array_text(offsets), after);
    for (; at < end; ++at) {
      const std::size_t run = plan.submitted[at];
      fmt::format_to(
          out,
          "submit_task draw_{0} 'draw {0}' --time={1} --array=0-{2} --dependency=\"afterok:${{simulate}}_{3}\"\n"
          "submit_task join_{0} 'join {0}' --time={1} --dependency=\"afterok:$job\"\njoins=$joins:$job\n",
          run, plan.needs.draw_minutes, plan.parts(run) - 1, run - base);
    }
  }
  if (!plan.submitted.empty()) after = " --dependency=\"afterany$joins\"";
  fmt::format_to(out, "submit_task report report --time={}{}\n", plan.needs.draw_minutes, after);
  return text;
}

std::string task_list(const FarmOptions& options, const FarmPlan& plan) {
  const std::string script = quoted((fs::absolute(options.sweep.output) / "farm/task.sh").lexically_normal().string());
  std::string text = "name\twaits for\tcommand\n";
  std::string joins;
  const auto add = [&](const std::string& name, const std::string& before, const std::string& words) {
    fmt::format_to(std::back_inserter(text), "{}\t{}\tsh {} {}\n", name, before, script, words);
  };
  if (!plan.archive.empty()) add("unpack", "", "unpack");
  for (const std::size_t run : plan.submitted) {
    add(fmt::format("simulate_{}", run), plan.archive.empty() ? "" : "unpack", fmt::format("simulate {}", run));
    std::string parts;
    for (int part = 0; part < plan.parts(run); ++part) {
      const std::string name = fmt::format("draw_{}_{}", run, part);
      add(name, fmt::format("simulate_{}", run), fmt::format("draw {} {}", run, part));
      parts += (parts.empty() ? "" : " ") + name;
    }
    add(fmt::format("join_{}", run), parts, fmt::format("join {}", run));
    joins += (joins.empty() ? "" : " ") + fmt::format("join_{}", run);
  }
  add("report", plan.submitted.empty() && !plan.archive.empty() ? "unpack" : joins, "report");
  return text;
}

}  // namespace weft::cli
