#include "tools/cli/options.hpp"

#include <utility>

#include "core/error.hpp"
#include "tools/cli/manual.hpp"
#include "tools/cli/option_values.hpp"
#include "tools/cli/parser.hpp"

namespace weft::cli {
namespace {

// All long and short option names of a command, with dashes.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

// Checks that the first argument is a command or an option of the program; CLI11 would only report a missing command.
void check_command_name(const Parser& parser, const std::vector<std::string>& arguments) {
  const std::vector<std::string> known = parser.command_names();
  const std::string list = fmt::format("{}", fmt::join(known, ", "));
  if (arguments.empty()) {
    throw Error(ExitCode::usage, "expected a command: {}; see weft --help", list);
  }
  const std::string& first = arguments.front();
  if (first.starts_with('-')) {
    const std::vector<std::string> options = option_names(parser.app);
    if (std::find(options.begin(), options.end(), first) != options.end()) return;
    throw Error(ExitCode::usage, "unknown option {} before the command{}; see weft --help", first,
                did_you_mean(first, options));
  }
  const auto is_it = [&](const CLI::App* command) { return command->check_name(first); };  // includes aliases
  if (std::ranges::any_of(parser.app.get_subcommands(nullptr), is_it)) return;
  if (std::filesystem::path(first).extension() == ".toml") {
    throw Error(ExitCode::usage, "expected a command before {}; did you mean weft run {}?", first, first);
  }
  throw Error(ExitCode::usage, "unknown command {}{}; the commands are {}", first, did_you_mean(first, known), list);
}

// Hint for an unknown option that may be the name of a file; empty if it cannot be one.
std::string as_file(const std::string& argument) {
  const std::filesystem::path file = argument;
  std::error_code none;
  if (!file.has_extension() && !std::filesystem::exists(file, none)) return "";
  return fmt::format("; for a file of this name, write ./{}, or put it after --", argument);
}

// Refuses options of scenes for commands that read the frames of a cache.
void check_option_of_scenes(const CLI::App& command, const std::string& option, const std::string& prefix) {
  const std::string name = command.get_name();
  if (name != "render" && name != "export") return;
  if (option == "--fps")
    throw Error(ExitCode::usage,
                "{}: --fps: the frames of a cache are simulated for one rate; weft simulate SCENE --cache NEW --fps N "
                "simulates them for another; --frames ::STEP uses fewer frames",
                prefix);
  if (option == "--set")
    throw Error(ExitCode::usage,
                "{}: --set: the frames of a cache are simulated already; weft simulate SCENE --cache CACHE --resume "
                "--set KEY=VALUE gives them other colours, cameras and lights without simulating them again; other "
                "changes need a new cache",
                prefix);
}

// Throws if the command was given an unknown option.
void check_unknown(const CLI::App& command, const std::string& prefix) {
  for (const std::string& argument : command.remaining(true)) {
    if (!argument.starts_with('-')) continue;
    const std::string name = argument.substr(0, argument.find('='));
    check_option_of_scenes(command, name, prefix);
    throw Error(ExitCode::usage, "{}: unknown option {}{}{}; see {} --help", prefix, name,
                did_you_mean(name, option_names(command)), as_file(argument), prefix);
  }
}

// Throws for a parse error. Unknown options and surplus arguments are reported first, since a misspelt option may be
// the cause of another error of CLI11.
[[noreturn]] void throw_usage(const CLI::App* command, const CLI::ParseError& error) {
  if (command == nullptr) throw Error(ExitCode::usage, "weft: {}; see weft --help", error.what());
  const std::string prefix = "weft " + command->get_name();
  check_unknown(*command, prefix);
  if (const std::vector<std::string> rest = command->remaining(true); !rest.empty())
    throw Error(ExitCode::usage, "{}: unexpected argument {}; see {} --help", prefix, rest.front(), prefix);
  throw Error(ExitCode::usage, "{}: {}; see {} --help", prefix, error.what(), prefix);
}

std::string_view name_of(BenchOptions::Kind kind) {
  return kind == BenchOptions::Kind::speed ? "speed" : "accuracy";  // only these kinds have options of their own
}

BenchOptions checked(BenchOptions bench, const std::vector<BenchOption>& options) {
  using Kind = BenchOptions::Kind;
  if (bench.kind == Kind::fabrics && (!bench.scene.empty() || !bench.overrides.empty()))
    throw Error(ExitCode::usage, "weft bench fabrics: expected no SCENE and no --set, since its scenes are built in");
  if (bench.kind == Kind::stability && bench.scene.empty() && !bench.overrides.empty())
    throw Error(ExitCode::usage,
                "weft bench stability: expected a SCENE for --set, since the built-in scenes cannot be changed");
  for (const BenchOption& option : options) {
    if (std::ranges::find(option.kinds, bench.kind) != option.kinds.end()) continue;
    std::vector<std::string_view> names;
    for (const Kind kind : option.kinds) names.push_back(name_of(kind));
    throw Error(ExitCode::usage, "weft bench: {} is for weft bench {}", option.name, fmt::join(names, " or "));
  }
  return bench;
}

SweepOptions checked(SweepOptions sweep) {
  // With --report, a sweep needs no changes, since a farm may run a single unchanged scene.
  if (sweep.axes.empty() && sweep.list.empty() && !sweep.only_report)
    throw Error(ExitCode::usage, "weft sweep: expected --set KEY=A,B,... or --list; see weft sweep --help");
  return sweep;
}

// Refuses options that the drawing command would refuse each time.
WatchOptions checked(WatchOptions watch) {
  const std::vector<std::string>& words = watch.passed_on;
  const auto given = [&](const char* name) { return std::ranges::find(words, name) != words.end(); };
  for (const char* name : {"--frame", "--start"})
    if (watch.film && given(name))
      throw Error(ExitCode::usage, "weft watch: {} is for a still; expected it without --film", name);
  if (!watch.film && given("--frames"))
    throw Error(ExitCode::usage, "weft watch: --frames is for a video; expected it with --film");
  if (given("--start") && given("--frame"))
    throw Error(ExitCode::usage, "weft watch: expected --start or --frame, got both");
  if (const auto option = std::ranges::find(words, "--output"); option != words.end()) {
    const std::filesystem::path output = *(option + 1);
    if (watch.film && parse_output(output.string(), "").kind != OutputTarget::Kind::video)
      throw Error(ExitCode::usage, "-o: expected a video with --film, got {}", output.string());
    if (!watch.film && output.has_extension() && output.extension() != ".png")
      throw Error(ExitCode::usage, "-o: expected a name ending in .png without --film, got {}", output.string());
  }
  return watch;
}

FarmOptions checked(FarmOptions farm) {
  const bool submits = farm.action == FarmOptions::Action::submit;
  if (submits && farm.sweep.output.empty())
    throw Error(ExitCode::usage, "weft farm submit: expected -o DIR, a folder that all machines share");
  if (!submits && !farm.sweep.output.empty())
    throw Error(ExitCode::usage, "weft farm: -o is for weft farm submit; expected the folder of the runs alone");
  if (!submits && !farm.program.empty())
    throw Error(ExitCode::usage,
                "weft farm: --program is for weft farm submit, which writes it into the folder of the runs");
  if (!submits) farm.sweep.output = farm.sweep.scene;
  return farm;
}

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  Parser parser;
  check_command_name(parser, arguments);
  if (std::ranges::find(arguments, std::string()) != arguments.end())
    throw Error(ExitCode::usage, "weft {}: expected no empty argument, got one; is a variable of the shell empty?",
                arguments.front());
  try {
    // CLI11 expects the arguments in reverse order.
    parser.app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    return PrintText{parser.app.help()};
  } catch (const CLI::CallForVersion& version) {
    return PrintText{fmt::format("{}\n", version.what())};
  } catch (const CLI::ParseError& error) {
    throw_usage(parser.selected(), error);
  }
  const std::string name = parser.selected()->get_name();
  if (name == "run") return parser.run;
  if (name == "simulate") return parser.simulate;
  if (name == "render") return parser.render;
  if (name == "check") return parser.check;
  if (name == "thumbnail") return parser.thumbnail;
  if (name == "sheet") return parser.sheet;
  if (name == "join") return parser.join;
  if (name == "sweep") return checked(parser.sweep);
  if (name == "farm") return checked(parser.farm);
  if (name == "new") return parser.new_scene;
  if (name == "watch") return checked(parser.watch);
  if (name == "completion") return PrintText{completion(parser.app, parser.shell)};
  if (name == "man") return PrintText{manual(parser.app)};
  if (name == "schema") return parser.schema;
  if (name == "bench") return checked(parser.bench, parser.bench_options);
  if (name == "diff") return parser.diff;
  if (name == "accept") return parser.accept;
  if (name == "review") return parser.review;
  if (name == "export") return parser.export_frames;
  return parser.doctor;
}

}  // namespace weft::cli
