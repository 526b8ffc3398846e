// Commands that start many runs.
#include "cli/option_groups.hpp"
#include "cli/parser.hpp"
#include "core/error.hpp"

namespace weft::cli {
namespace {

constexpr std::array kFarmActions{Choice<FarmOptions::Action>{"submit", FarmOptions::Action::submit},
                                  Choice<FarmOptions::Action>{"status", FarmOptions::Action::status},
                                  Choice<FarmOptions::Action>{"cancel", FarmOptions::Action::cancel}};

/// Adds the options that choose the runs and those that are passed on to them. `frames` may be null.
void add_runs(CLI::App& command, SweepOptions& sweep, FrameSelection* frames) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&sweep](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) sweep.axes.push_back(parse_axis(text));
          },
          "Values of one key of the scene; given several times: all combinations")
      ->type_name("KEY=A,B,...")
      ->allow_extra_args(false);
  add_value(command, "--list", "FILE", "Runs one by one: CSV with keys in its first line, or TOML with [[run]]",
            [&sweep](const std::string& text) { sweep.list = text; });
  command.add_option("-o,--output", sweep.output, "Folder of all runs")->type_name("DIR");
  add_value(command, "--frame", "N", "Which picture of each run the sheet shows, counted from 0 [the last]",
            [&sweep](const std::string& text) { sweep.frame = parse_integer("--frame", text, 0, 1'000'000'000); });
  const auto passed_on = [&](const char* name, const char* value, const char* description,
                             std::function<void(const std::string&)> examine) {
    add_value(command, name, value, description, [&sweep, name, examine](const std::string& text) {
      examine(text);
      sweep.passed_on.insert(sweep.passed_on.end(), {name, text});
    });
  };
  passed_on("--frames", "A:B[:STEP]", "Draw frames A up to but without B, counted from 0 [all]",
            [frames](const std::string& text) {
              const FrameSelection selection = parse_frames(text);
              if (frames != nullptr) *frames = selection;
            });
  passed_on("--size", "WxH", "Size of the picture in pixels [the scene's, or 1280x720]", parse_size);
  passed_on("--camera", "NAME", "A camera of the scene [its choice, or automatic framing]", [](const std::string&) {});
  passed_on("--quality", "draft|preview|final", "Care taken in drawing [final]",
            [](const std::string& text) { parse_choice("--quality", text, kQualities); });
  command.add_flag_callback(
      "--error", [&sweep] { sweep.passed_on.emplace_back("--error"); },
      "Also tell how far off each run is, by simulating it with other steps, solver settings and starts");
}

}  // namespace

void Parser::add_sweep() {
  CLI::App& command =
      *app.add_subcommand("sweep", "Run a scene with many values, side by side on a sheet and in a table");
  command.add_option("SCENE", sweep.scene, "The scene, a TOML file")->required()->type_name("");
  add_runs(command, sweep, nullptr);
  command.get_option("--output")->required();
  add_value(command, "--jobs", "N", "Runs at once [1]",
            [this](const std::string& text) { sweep.jobs = parse_integer("--jobs", text, 1, kMaxThreads); });
  add_value(command, "--threads", "N", "Threads of each run at most [all cores]; results do not depend on it",
            [this](const std::string& text) {
              parse_integer("--threads", text, 1, kMaxThreads);
              sweep.passed_on.insert(sweep.passed_on.end(), {"--threads", text});
            });
  command.add_flag("--report", sweep.gather, "Make no run, only sheet, table and page of what is there");
  command.add_flag("--overwrite", sweep.overwrite, "Make all runs anew");
  command.footer(
      "\nExamples:\n"
      "  weft sweep scenes/falling_band.toml --set cloth.band.material.bend=1e-6,1e-5,1e-4 -o bends --quality draft\n"
      "  weft sweep scenes/falling_band.toml --set cloth.band.material.fabric=silk,denim --set time.step=0.01,0.02 -o "
      "s\n"
      "  weft sweep scenes/falling_band.toml --list runs.csv -o runs\n"
      "\nEach run has a folder named by its values; beside them lie sheet.png, table.csv, table.md and "
      "page/index.html.\n"
      "The same command goes on with what was stopped, and passes over what is done. Runs that fail are named, and "
      "the\n"
      "exit code is that of the first of them.");
}

void Parser::add_farm() {
  CLI::App& command = *app.add_subcommand("farm", "Run a scene or a sweep as jobs of a Slurm cluster");
  command
      .add_option_function<std::string>(
          "WHAT", [this](const std::string& text) { farm.action = parse_choice("WHAT", text, kFarmActions); },
          "submit: hand in what is not done yet; status: tell how far it is; cancel: take it back, and keep what is "
          "made")
      ->required()
      ->type_name("submit|status|cancel");
  command.add_option("SCENE|DIR", farm.sweep.scene, "Of submit: the scene, a TOML file; else the folder of the runs")
      ->required()
      ->type_name("");
  add_runs(command, farm.sweep, &farm.frames);
  add_value(command, "--part", "N", fmt::format("Frames that one task draws [{}]", farm.part),
            [this](const std::string& text) { farm.part = parse_integer("--part", text, 1, 1'000'000); });
  add_value(command, "--threads", "N", fmt::format("Threads and processors of a task [{}]", farm.threads),
            [this](const std::string& text) { farm.threads = parse_integer("--threads", text, 1, kMaxThreads); });
  add_value(
      command, "--retries", "N",
      fmt::format("How often a task that was killed, or ran out of disk space, is tried again [{}]", farm.retries),
      [this](const std::string& text) { farm.retries = parse_integer("--retries", text, 0, 100); });
  add_value(command, "--memory", "MB", "Of a task [from a trial of some seconds]",
            [this](const std::string& text) { farm.memory = parse_integer("--memory", text, 1, 100'000'000); });
  add_value(command, "--time", "MINUTES", "Of a task at most, after which it goes on in a new place [from a trial]",
            [this](const std::string& text) { farm.minutes = parse_integer("--time", text, 2, 10'000'000); });
  add_value(command, "--program", "FILE.tar.zst",
            "Archive of ninja bundle that tasks unpack and run [this program, installed on all machines]",
            [this](const std::string& text) { farm.program = text; });
  command.add_option("--sbatch", farm.for_scheduler, "An option for sbatch, as --sbatch=--partition=long; repeatable")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  command.add_flag("--dry-run", farm.dry_run, "Only write and print the scripts, for other schedulers too");
  command.footer(
      "\nExamples:\n"
      "  weft farm submit scenes/catwalk.toml -o catwalk --threads 4\n"
      "  weft farm submit scenes/falling_band.toml --set cloth.band.material.bend=1e-6,1e-5,1e-4 -o bends\n"
      "  weft farm submit scenes/catwalk.toml -o catwalk --program weft-x86_64.tar.zst\n"
      "  weft farm status bends\n"
      "  weft farm cancel bends\n"
      "\nEach run is simulated by one task, drawn by several, joined by one, and a last one makes sheet, table and "
      "page.\n"
      "The folder is one that all machines share. Tasks go on where they were stopped, and submit hands in what is\n"
      "missing. status ends with 0 when all runs are done, else with 9.");
}

}  // namespace weft::cli
