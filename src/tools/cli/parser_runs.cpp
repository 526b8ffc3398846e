// Options of the commands that start many runs.
#include "core/error.hpp"
#include "tools/cli/option_groups.hpp"
#include "tools/cli/parser.hpp"

namespace weft::cli {
namespace {

constexpr std::array kFarmActions{Choice<FarmOptions::Action>{"submit", FarmOptions::Action::submit},
                                  Choice<FarmOptions::Action>{"status", FarmOptions::Action::status},
                                  Choice<FarmOptions::Action>{"cancel", FarmOptions::Action::cancel}};

/// Adds the options that define the runs or are passed on to them. `frames` (may be null) receives the value of
/// --frames.
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
  add_value(command, "--list", "FILE",
            "File that lists the runs: CSV with keys in its first line, or TOML with [[run]]",
            [&sweep](const std::string& text) { sweep.list = text; });
  command.add_option("-o,--output", sweep.output, "Folder of all runs")->type_name("DIR");
  add_value(command, "--frame", "N", "Picture of each video that the sheet shows, counted from 0 [the last]",
            [&sweep](const std::string& text) { sweep.frame = parse_integer("--frame", text, 0, 1'000'000'000); });
  const auto passed_on = std::bind_front(add_passed_on, std::ref(command), std::ref(sweep.passed_on));
  passed_on("--frames", "A:B[:STEP]", "Draw frames A to B - 1, counted from 0 [all]",
            [frames](const std::string& text) {
              const FrameSelection selection = parse_frames(text);
              if (frames != nullptr) *frames = selection;
            });
  passed_on("--size", "WxH", "Size of the picture in pixels [the scene's, or 1280x720]",
            [&sweep](const std::string& text) { sweep.pictures.size = parse_size(text); });
  passed_on("--camera", "NAME", "Camera of the scene that draws [render.camera, the first one, or automatic framing]",
            [&sweep](const std::string& text) { sweep.pictures.camera = text; });
  passed_on("--quality", "draft|preview|final", "Quality of the pictures [final]", [&sweep](const std::string& text) {
    sweep.pictures.quality = parse_choice("--quality", text, kQualities);
  });
  command.add_flag_callback(
      "--error", [&sweep] { sweep.passed_on.emplace_back("--error"); },
      "Also estimate the error of each run, from runs with other steps, solver settings and starts");
}

}  // namespace

void Parser::add_sweep() {
  CLI::App& command =
      *app.add_subcommand("sweep", "Run a scene with many values, and compare them on a sheet and in a table");
  add_argument(command, "SCENE", sweep.scene, "The scene, a TOML file");
  add_runs(command, sweep, nullptr);
  command.get_option("--output")->required();
  add_value(command, "--jobs", "N", "Number of runs at the same time [1]",
            [this](const std::string& text) { sweep.jobs = parse_integer("--jobs", text, 1, kMaxThreads); });
  add_passed_on(command, sweep.passed_on, "--threads", "N",
                "Maximum number of threads of each run [all cores]; results do not depend on it",
                [](const std::string& text) { parse_integer("--threads", text, 1, kMaxThreads); });
  command.add_flag("--report", sweep.only_report,
                   "Run nothing; only make sheet, table and page of the runs that exist");
  command.add_flag("--overwrite", sweep.overwrite, "Repeat all runs, finished ones included");
  command.footer(
      "\nExamples:\n"
      "  weft sweep scenes/falling_band.toml --set cloth.band.material.bend=1e-6,1e-5,1e-4 -o bends --quality draft\n"
      "  weft sweep scenes/falling_band.toml --set cloth.band.material.fabric=silk,denim --set time.step=0.01,0.02 -o "
      "s\n"
      "  weft sweep scenes/falling_band.toml --list runs.csv -o runs\n"
      "\nEach run has a folder named by its values; beside these folders are sheet.png, table.csv, table.md and\n"
      "page/index.html. The same command continues a stopped sweep and skips finished runs. Runs that fail are\n"
      "named, and the exit code is that of the first of them.");
}

void Parser::add_farm() {
  CLI::App& command = *app.add_subcommand("farm", "Run a scene or a sweep as jobs of a Slurm cluster");
  command
      .add_option_function<std::string>(
          "WHAT", [this](const std::string& text) { farm.action = parse_choice("WHAT", text, kFarmActions); },
          "submit: submit the jobs of all unfinished runs; status: print their progress; cancel: cancel the jobs and "
          "keep what is finished")
      ->required()
      ->type_name("submit|status|cancel");
  add_argument(command, "SCENE|DIR", farm.sweep.scene,
               "For submit: the scene, a TOML file; otherwise the folder of the runs");
  add_runs(command, farm.sweep, &farm.frames);
  add_value(command, "--part", "N", fmt::format("Frames that one task draws [{}]", farm.part),
            [this](const std::string& text) { farm.part = parse_integer("--part", text, 1, 1'000'000); });
  add_value(command, "--threads", "N", fmt::format("Threads and processors of a task [{}]", farm.threads),
            [this](const std::string& text) { farm.threads = parse_integer("--threads", text, 1, kMaxThreads); });
  add_value(command, "--retries", "N",
            fmt::format("How often a task that was killed, or ran out of disk space, is repeated [{}]", farm.retries),
            [this](const std::string& text) { farm.retries = parse_integer("--retries", text, 0, 100); });
  add_value(command, "--memory", "MB", "Memory of a task [from a trial of some seconds]",
            [this](const std::string& text) { farm.memory = parse_integer("--memory", text, 1, 100'000'000); });
  add_value(command, "--time", "MINUTES", "Time limit of a task, which then continues in another place [from a trial]",
            [this](const std::string& text) { farm.minutes = parse_integer("--time", text, 2, 10'000'000); });
  add_value(command, "--program", "FILE.tar.zst",
            "Archive made by ninja bundle, which tasks unpack and run [this program, installed on all machines]",
            [this](const std::string& text) { farm.program = text; });
  command
      .add_option("--sbatch", farm.for_scheduler, "Option for sbatch, such as --sbatch=--partition=long; repeatable")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  command.add_flag("--dry-run", farm.dry_run,
                   "Only write and print the scripts, also for other schedulers; submit nothing");
  command.footer(
      "\nExamples:\n"
      "  weft farm submit scenes/catwalk.toml -o catwalk --threads 4\n"
      "  weft farm submit scenes/falling_band.toml --set cloth.band.material.bend=1e-6,1e-5,1e-4 -o bends\n"
      "  weft farm submit scenes/catwalk.toml -o catwalk --program weft-x86_64.tar.zst\n"
      "  weft farm status bends\n"
      "  weft farm cancel bends\n"
      "\nFor each run, one task simulates, several draw and one joins; a last task makes sheet, table and page. All\n"
      "machines must share the folder. Tasks continue where they were stopped, and submit submits only what is\n"
      "missing. status ends with exit code 0 if all runs are finished, else with 9.");
}

}  // namespace weft::cli
