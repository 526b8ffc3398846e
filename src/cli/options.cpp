#include "cli/options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <utility>

#include "cli/option_values.hpp"
#include "core/error.hpp"
#include "core/version.hpp"

namespace weft::cli {
namespace {

constexpr int kMaxThreads = 1024;

constexpr std::array kBenches{Choice<BenchOptions::Kind>{"stability", BenchOptions::Kind::stability},
                              Choice<BenchOptions::Kind>{"accuracy", BenchOptions::Kind::accuracy},
                              Choice<BenchOptions::Kind>{"speed", BenchOptions::Kind::speed},
                              Choice<BenchOptions::Kind>{"fabrics", BenchOptions::Kind::fabrics}};
constexpr std::array kQualities{Choice<render::Quality>{"draft", render::Quality::draft},
                                Choice<render::Quality>{"preview", render::Quality::preview},
                                Choice<render::Quality>{"final", render::Quality::final}};
constexpr std::array kBackends{Choice<render::Backend>{"auto", render::Backend::automatic},
                               Choice<render::Backend>{"osmesa", render::Backend::osmesa},
                               Choice<render::Backend>{"egl", render::Backend::egl}};
constexpr std::array kFormats{
    Choice<exporter::Format>{"ply", exporter::Format::ply}, Choice<exporter::Format>{"obj", exporter::Format::obj},
    Choice<exporter::Format>{"pc2", exporter::Format::pc2}, Choice<exporter::Format>{"gltf", exporter::Format::gltf}};
constexpr std::array kProgressStyles{
    Choice<Progress::Style>{"auto", Progress::Style::automatic}, Choice<Progress::Style>{"bar", Progress::Style::bar},
    Choice<Progress::Style>{"plain", Progress::Style::plain}, Choice<Progress::Style>{"none", Progress::Style::none}};

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&overrides](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) overrides.push_back(check_override(text));
          },
          "Change one value of the scene, checked like the file; may be given several times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

// One option with one value, handed to `read` as text.
void add_value(CLI::App& command, const char* name, const char* value, const std::string& description,
               std::function<void(const std::string&)> read) {
  command.add_option_function<std::string>(name, read, description)->type_name(value);
}

void add_backend(CLI::App& command, render::Backend& backend) {
  add_value(command, "--backend", "auto|osmesa|egl", "How the OpenGL context is made [auto]",
            [&](const std::string& text) { backend = parse_choice("--backend", text, kBackends); });
}

void add_picture(CLI::App& command, SceneOptions& options) {
  add_value(command, "--size", "WxH", "Size of the picture in pixels [the scene's, or 1280x720]",
            [&](const std::string& text) { options.size = parse_size(text); });
  add_value(command, "--camera", "NAME", "A camera of the scene [its choice, or automatic framing]",
            [&](const std::string& text) { options.camera = text; });
  const char* quality = options.quality == render::Quality::preview ? "preview" : "final";
  add_value(command, "--quality", "draft|preview|final", fmt::format("Care taken in drawing [{}]", quality).c_str(),
            [&](const std::string& text) { options.quality = parse_choice("--quality", text, kQualities); });
  add_backend(command, options.backend);
}

void add_process(CLI::App& command, SceneOptions& options) {
  add_value(command, "--threads", "N", "Threads to use at most [all cores]; results do not depend on it",
            [&](const std::string& text) { options.threads = parse_integer("--threads", text, 1, kMaxThreads); });
  add_value(command, "--progress", "auto|bar|plain|none", "Progress on standard error [auto]",
            [&](const std::string& text) { options.progress = parse_choice("--progress", text, kProgressStyles); });
  command.add_flag("--overwrite", options.overwrite, "Replace files that exist already");
}

void add_common(CLI::App& command, SceneOptions& options, const char* what = "The scene, a TOML file") {
  command.add_option("SCENE", options.scene, what)->required()->type_name("");
  add_value(command, "--fps", "N", "Frames a second [the scene's]",
            [&](const std::string& text) { options.fps = parse_fps(text); });
  add_overrides(command, options.overrides);
  add_picture(command, options);
  add_process(command, options);
}

void add_output(CLI::App& command, RunOptions& options) {
  add_value(command, "-o,--output", "FILE", "Video (.mp4), pictures ('out/{frame:05}.png') or layers of pictures (.exr) [output/<scene>.mp4]",
            [&](const std::string& text) { options.output = text; });
}

void add_frames(CLI::App& command, RunOptions& options, const char* description) {
  add_value(command, "--frames", "A:B[:STEP]", description,
            [&](const std::string& text) { options.frames = parse_frames(text); });
}

void add_side_files(CLI::App& command, RunOptions& options) {
  add_value(command, "--meshes", "DIR", "Also write each cloth and obstacle of each such frame as PLY",
            [&](const std::string& text) { options.meshes = text; });
  add_value(command, "--stats", "FILE", "Also write times, iterations and energies as JSON",
            [&](const std::string& text) { options.stats = text; });
  add_value(command, "--log-json", "FILE|-", "Also write events as JSON lines (-: standard output)",
            [&](const std::string& text) { options.log_json = text; });
}

void add_error(CLI::App& command, RunOptions& options) {
  command.add_flag("--error", options.error,
                   "Also tell how far off the run is, by simulating it with other steps, solver settings and starts");
  command.add_flag("--mesh-error", options.mesh_error, "Likewise, and with half and a quarter of the cells");
}

constexpr const char* kSceneOrCache = "The scene, a TOML file, or the folder of a cache";

// The program's commands and the values that CLI11 writes into while parsing.
struct Parser {
  CLI::App app{"Weft: cloth scenes to video, on any machine, without a window.", "weft"};
  RunOptions run;
  SimulateOptions simulate;
  RenderOptions render;
  CheckOptions check;
  ThumbnailOptions thumbnail;
  SheetOptions sheet;
  SchemaOptions schema;
  DoctorOptions doctor;
  BenchOptions bench;
  std::string option_of_speed;  // one that was given; empty: none
  DiffOptions diff;
  AcceptOptions accept;
  ReviewOptions review;
  ExportOptions exported;

  Parser() {
    app.set_version_flag("--version", fmt::format("weft {}", kVersion), "Print the version");
    app.set_help_flag("-h,--help", "Print this help");
    app.get_formatter()->column_width(34);
    app.require_subcommand(1);
    app.footer(
        "\nExamples:\n"
        "  weft run scenes/falling_band.toml\n"
        "  weft simulate scenes/falling_band.toml --cache band.cache && weft render band.cache -o band.mp4\n"
        "  weft check --plan scenes/falling_band.toml\n"
        "  weft thumbnail scenes/falling_band.toml -o band.png --frame 60\n"
        "\nExit codes: 0 well, 1 our own fault, 2 command line, 3 scene, 4 asset, 5 simulation,\n"
        "  6 output or encoder, 7 images differ, 8 reference missing, 75 interrupted.");
    add_run();
    add_simulate();
    add_render();
    add_check();
    add_thumbnail();
    add_sheet();
    add_schema();
    add_doctor();
    add_bench();
    add_diff();
    add_accept();
    add_review();
    add_export();
  }

  void add_run() {
    CLI::App& command = *app.add_subcommand("run", "Simulate a scene, draw it and encode the video");
    add_output(command, run);
    add_frames(command, run, "Draw frames A up to but without B, counted from 0 [all]");
    add_common(command, run.common);
    add_side_files(command, run);
    add_error(command, run);
    command.add_flag("--resume", run.resume, "Go on with a run of the same output that did not end well");
    command.footer(
        "\nExamples:\n"
        "  weft run scenes/falling_band.toml\n"
        "  weft run scenes/falling_band.toml -o band.mp4 --quality preview --size 640x360\n"
        "  weft run scenes/falling_band.toml --frames 0:50 -o 'out/{frame:05}.png' --overwrite\n"
        "  weft run scenes/falling_band.toml --set cloth.band.material.stretch=1e4 --stats band.json\n"
        "\nCtrl-C or SIGTERM ends the run after the current frame with a playable video (exit code 75);\n"
        "a second one quits at once. What was simulated is kept, also when the run is killed: --resume goes\n"
        "on from there, to the same frames as without the interruption. With a STEP the video keeps the true speed at "
        "fewer frames a second.");
  }

  void add_simulate() {
    CLI::App& command = *app.add_subcommand("simulate", "Simulate a scene into a frame cache, to be drawn later");
    command.add_option("--cache", simulate.cache, "Folder of the cache")->required()->type_name("DIR");
    add_frames(command, simulate, "Simulate up to but without frame B; A and STEP are for --meshes [all]");
    add_common(command, simulate.common);
    add_side_files(command, simulate);
    add_error(command, simulate);
    command.add_flag("--resume", simulate.resume, "Go on where the cache ends");
    command.footer(
        "\nExamples:\n"
        "  weft simulate scenes/falling_band.toml --cache band.cache\n"
        "  weft simulate scenes/falling_band.toml --cache band.cache --resume\n"
        "\nSize and camera become those that weft render draws with if it is told nothing else.");
  }

  void add_render() {
    CLI::App& command = *app.add_subcommand("render", "Draw the frames of a cache");
    command.add_option("CACHE", render.common.scene, "The folder that weft simulate has filled")
        ->required()
        ->type_name("");
    add_output(command, render);
    add_frames(command, render, "Draw frames A up to but without B, counted from 0 [all that are there]");
    add_picture(command, render.common);
    add_process(command, render.common);
    add_side_files(command, render);
    command.footer(
        "\nExamples:\n"
        "  weft render band.cache -o band.mp4\n"
        "  weft render band.cache --frames 50:100 --camera side --size 1920x1080 -o 'side/{frame:05}.png'\n"
        "\nSeveral processes may draw from one cache at once, also while it is filled.");
  }

  void add_check() {
    CLI::App& command = *app.add_subcommand("check", "Print every mistake of one or more scenes");
    command.add_option("SCENE", check.scenes, "Scenes, TOML files")->required()->type_name("");
    command.add_flag("--plan", check.plan, "Also print which parts the scene needs and which are left out");
    add_overrides(command, check.overrides);
    command.footer("\nExample:\n  weft check scenes/*.toml");
  }

  void add_thumbnail() {
    CLI::App& command = *app.add_subcommand("thumbnail", "Draw one still of a scene or a cache");
    add_value(command, "-o,--output", "FILE.png", "The picture [output/<scene>.png]",
              [this](const std::string& text) { thumbnail.output = text; });
    add_value(command, "--frame", "N", "Which frame, counted from 0 [the one that tells most]",
              [this](const std::string& text) { thumbnail.frame = parse_integer("--frame", text, 0, 1'000'000'000); });
    command.add_flag("--start", thumbnail.start,
                     "Instead of a frame: how the scene is given, with all that touches or crosses marked in red");
    add_common(command, thumbnail.common, kSceneOrCache);
    command.footer(
        "\nExamples:\n"
        "  weft thumbnail scenes/falling_band.toml -o band.png --frame 60 --quality draft\n"
        "  weft thumbnail dress.toml --start -o start.png");
  }

  void add_sheet() {
    CLI::App& command = *app.add_subcommand("sheet", "Draw evenly spaced frames of a scene or a cache on one picture");
    add_value(command, "-o,--output", "FILE.png", "The picture [output/<scene>.sheet.png]",
              [this](const std::string& text) { sheet.output = text; });
    add_value(command, "--count", "N", "How many frames, the first and the last among them [12]",
              [this](const std::string& text) { sheet.count = parse_integer("--count", text, 1, 400); });
    add_value(command, "--columns", "N", "How many side by side [4]",
              [this](const std::string& text) { sheet.columns = parse_integer("--columns", text, 1, 40); });
    add_common(command, sheet.common, kSceneOrCache);
    command.footer(
        "\nExample:\n  weft sheet scenes/falling_band.toml -o sheet.png --count 20 --columns 5\n"
        "\n--size is that of each small picture [400 wide].");
  }

  void add_schema() {
    CLI::App& command = *app.add_subcommand("schema", "Print the JSON schema of the scene format");
    command.add_flag("--pattern", schema.pattern, "That of sewing patterns instead");
    command.footer("\nExample:\n  weft schema > weft.schema.json\n  weft schema --pattern > pattern.schema.json");
  }

  void add_doctor() {
    CLI::App& command = *app.add_subcommand("doctor", "Test this machine: processor, OpenGL, encoder");
    add_backend(command, doctor.backend);
  }

  void add_bench() {
    CLI::App& command = *app.add_subcommand("bench", "Measure: stability, error against run time, speed, or fabrics");
    command
        .add_option_function<std::string>(
            "WHAT", [this](const std::string& text) { bench.kind = parse_choice("WHAT", text, kBenches); },
            "stability: what comes of stiff and extreme scenes; accuracy: error against run time of a scene; speed: "
            "time by stage, iterations and memory over sizes, threads and steps; fabrics: drape, bending and extension "
            "against what was published")
        ->required()
        ->type_name("");
    command
        .add_option("SCENE", bench.scene, "For accuracy and speed: the scene, a TOML file [a swinging sheet; a drape]")
        ->type_name("");
    add_overrides(command, bench.overrides);
    add_value(command, "-o,--output", "DIR", "Folder for tables and plots [output/bench]",
              [this](const std::string& text) { bench.output = text; });
    command.add_flag("--overwrite", bench.overwrite, "Replace files that exist already");
    const auto of_speed = [&](const char* name, const char* value, const char* description,
                              std::function<void(const std::string&)> read) {
      add_value(command, name, value, description, [this, name, read](const std::string& text) {
        read(text);
        option_of_speed = name;
      });
    };
    of_speed("--sizes", "F,F,...", "Of speed: particles along each side, times those of the scene [0.5,1,2,4]",
             [this](const std::string& text) { bench.sizes = parse_list<double>("--sizes", text, parse_factor); });
    of_speed("--threads", "N,N,...", "Of speed: numbers of threads [1 and all cores]", [this](const std::string& text) {
      bench.threads = parse_list<int>("--threads", text, [](const char* option, const std::string& part) {
        return parse_integer(option, part, 1, kMaxThreads);
      });
    });
    of_speed("--steps", "F,F,...", "Of speed: time.step, or time.tolerance, times that of the scene [0.5,1,2]",
             [this](const std::string& text) { bench.steps = parse_list<double>("--steps", text, parse_factor); });
    of_speed("--frames", "A:B", "Of speed: frames to measure, from A up to but without B [1:9]",
             [this](const std::string& text) {
               bench.frames = parse_frames(text);
               if (bench.frames.step != 1 || bench.frames.begin == 0)
                 throw Error(ExitCode::usage,
                             "--frames: expected A:B with A from 1, for frame 0 takes no time and each needs the one "
                             "before, got {}",
                             text);
             });
    of_speed("--draw", "draft|preview|final", "Of speed: draw each frame too, with such care",
             [this](const std::string& text) { bench.drawing = parse_choice("--draw", text, kQualities); });
    command.footer(
        "\nExamples:\n"
        "  weft bench stability -o stability\n"
        "  weft bench accuracy scenes/falling_band.toml --set time.duration=0.8 -o accuracy\n"
        "  weft bench speed scenes/falling_band.toml --sizes 0.5,1,2 --frames 20:40 -o speed");
  }

  void add_diff() {
    CLI::App& command = *app.add_subcommand("diff", "Compare pictures, videos, or folders of them");
    command.add_option("REFERENCE", diff.reference, "As it should be: .png, video, folder")->required()->type_name("");
    command.add_option("TEST", diff.test, "As it is now: likewise")->required()->type_name("");
    int& limit = diff.limits.pixel_tolerance;
    add_value(command, "--pixel-tolerance", "N", fmt::format("Levels of 255 by which a pixel may differ [{}]", limit),
              [&limit](const std::string& text) { limit = parse_integer("--pixel-tolerance", text, 0, 255); });
    const auto add_share = [&](const char* name, double& most, const char* what) {
      add_value(command, name, "X", fmt::format("{} [{}]", what, most),
                [name, &most](const std::string& text) { most = parse_share(name, text); });
    };
    add_share("--pixel-budget", diff.limits.pixel_budget, "Share of the pixels that may differ by more");
    add_share("--max-flip", diff.limits.flip, "Largest mean of FLIP, 0 (looks the same) to 1");
    add_share("--max-spot", diff.limits.spot, "Largest value of FLIP at any pixel");
    add_value(command, "--heatmap", "FILE.png|DIR", "Also paint where it differs; a video's worst frame",
              [this](const std::string& text) { diff.heatmap = text; });
    command.add_flag("--overwrite", diff.overwrite, "Replace heat maps that exist already");
    command.add_flag("--json", diff.json, "Print JSON instead of text");
    command.footer(
        "\nExamples:\n"
        "  weft diff references/band.png band.png --heatmap difference.png\n"
        "  weft diff references output --heatmap output/differences\n"
        "  weft diff before.mp4 after.mp4\n"
        "\nFolders are compared by name. References may lie in one folder for each class of machines, named as weft\n"
        "doctor says, and one named default. "
        "Exit codes: 0 all within the limits, 7 something differs, 8 a reference is missing, 4 a file is unreadable.");
  }

  void add_accept() {
    CLI::App& command = *app.add_subcommand("accept", "Make pictures the new references, and record why");
    command.add_option("REFERENCE", accept.reference, "The reference, or its folder")->required()->type_name("");
    command.add_option("TEST", accept.tests, "The new pictures or videos, each by name")->required()->type_name("");
    command.add_option("--reason", accept.reason, "Why: kept in accepted.md")->required()->type_name("TEXT");
    command.footer(
        "\nExamples:\n"
        "  weft accept references output/band.png --reason \"floor is darker by design\"\n"
        "  weft accept references/mesa-22.3-256bit output/band.png --reason \"one pixel at the hem\"");
  }

  void add_review() {
    CLI::App& command = *app.add_subcommand("review", "Write a page for looking at runs, which opens in any browser");
    command.add_option("DIR", review.folders, "Folders with videos and statistics of weft run")
        ->required()
        ->type_name("");
    add_value(command, "-o,--output", "DIR", "Folder of the page [output/review]",
              [this](const std::string& text) { review.output = text; });
    add_value(command, "--reference", "DIR", "Folder with runs of the same names to compare with",
              [this](const std::string& text) { review.reference = text; });
    command.add_flag("--overwrite", review.overwrite, "Replace a page that exists already");
    command.footer(
        "\nExample:\n"
        "  weft run scenes/falling_band.toml -o runs/band.mp4 --stats runs/band.json\n"
        "  weft review runs -o page\n"
        "\nOpen page/index.html; the folder needs no server and loads nothing from elsewhere.");
  }

  void add_export() {
    CLI::App& command = *app.add_subcommand("export", "Write the frames of a cache as files for other programs");
    command.add_option("CACHE", exported.cache, "Folder of weft simulate --cache")->required()->type_name("");
    add_value(command, "--format", "ply|obj|pc2|gltf", "Form of the files [gltf]",
              [this](const std::string& text) { exported.format = parse_choice("--format", text, kFormats); });
    command.add_option("-o,--output", exported.output, "Folder of the files")->required()->type_name("DIR");
    add_value(command, "--frames", "A:B[:STEP]", "Frames A up to but without B, counted from 0 [all]",
              [this](const std::string& text) { exported.frames = parse_frames(text); });
    command.add_flag("--overwrite", exported.overwrite, "Replace files that exist already");
    command.footer(
        "\nExamples:\n"
        "  weft export band.cache --format gltf -o band\n"
        "  weft export band.cache --format ply -o band --frames 0:126:25\n"
        "\nply, obj: a file for each object and frame; pc2: for each object an OBJ file and a point cache that moves\n"
        "its vertices; gltf: one file with all that is visible, its colours and its motion (morph targets).");
  }

  std::vector<std::string> command_names() const {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
    return names;
  }

  CLI::App* selected() const {
    const auto commands = app.get_subcommands();
    return commands.empty() ? nullptr : commands.front();
  }
};

// All long and short option names of a command, as typed.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

// The first argument must be a command or an option of the program itself; CLI11 alone would only say "required".
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
  if (std::find(known.begin(), known.end(), first) != known.end()) return;
  if (std::filesystem::path(first).extension() == ".toml") {
    throw Error(ExitCode::usage, "expected a command before {}; did you mean weft run {}?", first, first);
  }
  throw Error(ExitCode::usage, "unknown command {}{}; the commands are {}", first, did_you_mean(first, known), list);
}

[[noreturn]] void throw_unexpected(const CLI::App& command, const std::string& prefix) {
  const std::vector<std::string> rest = command.remaining(true);
  for (const std::string& argument : rest) {
    if (!argument.starts_with('-')) continue;
    const std::string name = argument.substr(0, argument.find('='));
    throw Error(ExitCode::usage, "{}: unknown option {}{}; see {} --help", prefix, name,
                did_you_mean(name, option_names(command)), prefix);
  }
  throw Error(ExitCode::usage, "{}: unexpected argument {}; see {} --help", prefix, rest.empty() ? "" : rest.front(),
              prefix);
}

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  Parser parser;
  check_command_name(parser, arguments);
  try {
    parser.app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them reversed
  } catch (const CLI::CallForHelp&) {
    return PrintText{parser.app.help()};
  } catch (const CLI::CallForVersion& version) {
    return PrintText{fmt::format("{}\n", version.what())};
  } catch (const CLI::ExtrasError&) {
    const CLI::App* command = parser.selected();
    throw_unexpected(command ? *command : parser.app, command ? "weft " + command->get_name() : "weft");
  } catch (const CLI::ParseError& error) {
    const CLI::App* command = parser.selected();
    const std::string prefix = command ? "weft " + command->get_name() : "weft";
    throw Error(ExitCode::usage, "{}: {}; see {} --help", prefix, error.what(), prefix);
  }
  const std::string name = parser.selected()->get_name();
  const bool has_scene = !parser.bench.scene.empty() || !parser.bench.overrides.empty();
  const bool own_scenes =
      parser.bench.kind == BenchOptions::Kind::stability || parser.bench.kind == BenchOptions::Kind::fabrics;
  if (name == "bench" && own_scenes && has_scene)
    throw Error(ExitCode::usage, "weft bench {}: expected no SCENE and no --set, its scenes are its own",
                parser.bench.kind == BenchOptions::Kind::fabrics ? "fabrics" : "stability");
  if (name == "bench" && parser.bench.kind != BenchOptions::Kind::speed && !parser.option_of_speed.empty())
    throw Error(ExitCode::usage, "weft bench: {} is for weft bench speed", parser.option_of_speed);
  if (name == "run") return parser.run;
  if (name == "simulate") return parser.simulate;
  if (name == "render") return parser.render;
  if (name == "check") return parser.check;
  if (name == "thumbnail") return parser.thumbnail;
  if (name == "sheet") return parser.sheet;
  if (name == "schema") return parser.schema;
  if (name == "bench") return parser.bench;
  if (name == "diff") return parser.diff;
  if (name == "accept") return parser.accept;
  if (name == "review") return parser.review;
  if (name == "export") return parser.exported;
  return parser.doctor;
}

}  // namespace weft::cli
