// Options of the commands that make no film: check, schema, doctor, bench, diff, accept, review, export.
#include "core/error.hpp"
#include "tools/cli/option_groups.hpp"
#include "tools/cli/parser.hpp"

namespace weft::cli {
namespace {

constexpr std::array kBenches{Choice<BenchOptions::Kind>{"stability", BenchOptions::Kind::stability},
                              Choice<BenchOptions::Kind>{"accuracy", BenchOptions::Kind::accuracy},
                              Choice<BenchOptions::Kind>{"speed", BenchOptions::Kind::speed},
                              Choice<BenchOptions::Kind>{"fabrics", BenchOptions::Kind::fabrics}};
constexpr std::array kIntegrators{Choice<scene::Integrator>{"implicit_euler", scene::Integrator::implicit_euler},
                                  Choice<scene::Integrator>{"implicit_midpoint", scene::Integrator::implicit_midpoint},
                                  Choice<scene::Integrator>{"bdf2", scene::Integrator::bdf2}};
constexpr int kMaxStarts = 100;
constexpr std::array kFormats{Choice<exporter::Format>{"ply", exporter::Format::ply},
                              Choice<exporter::Format>{"obj", exporter::Format::obj},
                              Choice<exporter::Format>{"pc2", exporter::Format::pc2},
                              Choice<exporter::Format>{"gltf", exporter::Format::gltf},
                              Choice<exporter::Format>{"usd", exporter::Format::usd},
                              Choice<exporter::Format>{"usdz", exporter::Format::usdz},
                              Choice<exporter::Format>{"blender", exporter::Format::blender}};

// `none` gives an empty list; otherwise parses a list.
std::vector<double> parse_values(const char* option, const std::string& text,
                                 double (*parse)(const char*, const std::string&)) {
  return text == "none" ? std::vector<double>() : parse_list<double>(option, text, parse);
}

}  // namespace

void Parser::add_check() {
  CLI::App& command = *app.add_subcommand("check", "Print every mistake of one or more scenes");
  add_argument(command, "SCENE", check.scenes, "Scenes, TOML files");
  command.add_flag("--plan", check.plan,
                   "Also print which parts of the program the scene needs, and which it does not");
  command.add_flag("--estimate", check.estimate,
                   "Also simulate for some seconds, and predict time and memory of a run");
  add_value(command, "--against", "SCENE|CACHE",
            "Also print what has changed since this scene, the .effective.toml of a run, or a cache",
            [this](const std::string& text) { check.against = text; });
  add_overrides(command, check.overrides);
  command.footer(
      "\nExamples:\n  weft check scenes/*.toml\n"
      "  weft check band.toml --against output/falling_band.effective.toml");
}

void Parser::add_schema() {
  CLI::App& command = *app.add_subcommand("schema", "Print the JSON schema of the scene format");
  command.add_flag("--pattern", schema.pattern, "Print the schema of sewing patterns instead");
  command.footer("\nExample:\n  weft schema > weft.schema.json\n  weft schema --pattern > pattern.schema.json");
}

void Parser::add_doctor() {
  CLI::App& command = *app.add_subcommand("doctor", "Test this machine: processor, OpenGL, encoder");
  add_backend(command, doctor.backend);
}

void Parser::add_bench() {
  CLI::App& command = *app.add_subcommand("bench", "Measure: stability, error against run time, speed, or fabrics");
  command
      .add_option_function<std::string>(
          "WHAT", [this](const std::string& text) { bench.kind = parse_choice("WHAT", text, kBenches); },
          "stability: results of stiff and extreme scenes, or the values at which a scene breaks; accuracy: error "
          "against run time of a scene; speed: time by stage, iterations and memory over sizes, threads and steps; "
          "fabrics: drape, bending and extension against published measurements")
      ->required()
      ->type_name("stability|accuracy|speed|fabrics");
  command
      .add_option("SCENE", bench.scene,
                  "The scene, a TOML file; not for fabrics [extreme scenes; a swinging sheet; a drape]")
      ->type_name("");
  add_overrides(command, bench.overrides);
  add_value(command, "-o,--output", "DIR", "Folder for tables and plots [output/bench]",
            [this](const std::string& text) { bench.output = text; });
  command.add_flag("--overwrite", bench.overwrite, "Replace files that exist already");
  using Kind = BenchOptions::Kind;
  const auto add_option_for = [&](std::vector<Kind> kinds, const char* name, const char* value, const char* description,
                                  std::function<void(const std::string&)> read) {
    add_value(command, name, value, description, [this, name, read, kinds](const std::string& text) {
      read(text);
      bench_options.push_back({name, kinds});
    });
  };
  const auto of_speed = [&](const char* name, const char* value, const char* description,
                            std::function<void(const std::string&)> read) {
    add_option_for({Kind::speed}, name, value, description, std::move(read));
  };
  add_option_for({Kind::accuracy}, "--integrators", "NAME,NAME,...",
                 "For accuracy: values of time.integrator [implicit_euler,implicit_midpoint,bdf2]",
                 [this](const std::string& text) {
                   bench.plan.integrators = parse_list<scene::Integrator>(
                       "--integrators", text, [](const char* option, const std::string& part) {
                         return parse_choice(option, part, kIntegrators);
                       });
                 });
  add_option_for(
      {Kind::speed, Kind::accuracy}, "--steps", "F,F,...",
      "For speed and accuracy: factors on time.step, for speed also on time.tolerance [0.5,1,2; for accuracy 0.125 "
      "to 4]",
      [this](const std::string& text) {
        bench.steps = parse_list<double>("--steps", text, parse_factor);
        bench.plan.steps = bench.steps;
      });
  add_option_for(
      {Kind::accuracy}, "--tolerances", "M,M,...|none", "For accuracy: values of time.tolerance in m [1e-3 downwards]",
      [this](const std::string& text) { bench.plan.tolerances = parse_values("--tolerances", text, parse_length); });
  add_option_for({Kind::accuracy}, "--meshes", "F,F,...|none",
                 "For accuracy: factors on the cells along each side [0.25,0.5,1]",
                 [this](const std::string& text) { bench.plan.meshes = parse_values("--meshes", text, parse_factor); });
  add_option_for(
      {Kind::accuracy}, "--starts", "N",
      "For accuracy: runs of each setting, with starts that differ by 1 µm [1; with contact 3]",
      [this](const std::string& text) { bench.plan.starts = parse_integer("--starts", text, 1, kMaxStarts); });
  of_speed("--sizes", "F,F,...", "For speed: factors on the particles along each side [0.5,1,2,4]",
           [this](const std::string& text) { bench.sizes = parse_list<double>("--sizes", text, parse_factor); });
  of_speed("--threads", "N,N,...", "For speed: numbers of threads [1 and all cores]", [this](const std::string& text) {
    bench.threads = parse_list<int>("--threads", text, [](const char* option, const std::string& part) {
      return parse_integer(option, part, 1, kMaxThreads);
    });
  });
  of_speed("--frames", "A:B", "For speed: measure frames A to B - 1 [1:9]", [this](const std::string& text) {
    bench.frames = parse_frames(text);
    if (bench.frames.step != 1 || bench.frames.begin == 0)
      throw Error(ExitCode::usage,
                  "--frames: expected A:B with A >= 1 and without a STEP, since frame 0 takes no time and each frame "
                  "needs the one before, got {}",
                  text);
  });
  of_speed("--draw", "draft|preview|final", "For speed: also draw each frame, in this quality",
           [this](const std::string& text) { bench.drawing = parse_choice("--draw", text, kQualities); });
  of_speed("--peer", "PROGRAM",
           "For speed: also compare CPU time and intersecting pairs with a peer, such as bench_bullet",
           [this](const std::string& text) { bench.peer = text; });
  command.footer(
      "\nExamples:\n"
      "  weft bench stability -o stability\n"
      "  weft bench stability scenes/falling_band.toml --set time.duration=0.8 -o stability\n"
      "  weft bench accuracy scenes/falling_band.toml --set time.duration=0.8 -o accuracy\n"
      "  weft bench accuracy flag.toml --integrators implicit_euler,bdf2 --steps 0.5,1,2 --meshes none -o steps\n"
      "  weft bench speed scenes/falling_band.toml --sizes 0.5,1,2 --frames 20:40 -o speed");
}

void Parser::add_diff() {
  CLI::App& command = *app.add_subcommand("diff", "Compare pictures, videos, or folders of them");
  add_argument(command, "REFERENCE", diff.reference, "The reference: .png, video or folder");
  add_argument(command, "TEST", diff.test, "The result to compare, likewise");
  int& limit = diff.limits.pixel_tolerance;
  add_value(command, "--pixel-tolerance", "N",
            fmt::format("Levels, out of 255, by which a pixel may differ [{}]", limit),
            [&limit](const std::string& text) { limit = parse_integer("--pixel-tolerance", text, 0, 255); });
  const auto add_fraction = [&](const char* name, std::optional<double>& most, double usual, const char* what) {
    add_value(command, name, "X", fmt::format("{} [{}]", what, usual),
              [name, &most](const std::string& text) { most = parse_fraction(name, text); });
  };
  add_fraction(
      "--pixel-budget", diff.limits.pixel_budget, compare::Limits::kPixelBudget,
      "Fraction of pixels that may differ by more than --pixel-tolerance; with the default, a pixel at an edge "
      "counts a fortieth");
  add_fraction("--max-flip", diff.limits.flip, compare::Limits::kFlip,
               "Maximum mean of FLIP, 0 (looks the same) to 1; the default grows below 640x360 pixels");
  add_fraction("--max-spot", diff.limits.spot, compare::Limits::kSpot, "Maximum of FLIP at any pixel");
  add_value(command, "--heatmap", "FILE.png|DIR",
            "Also write a picture of the differences; for a video, of its worst frame",
            [this](const std::string& text) { diff.heatmap = text; });
  add_value(command, "--limits", "FILE.toml", "Limits and masks for single pictures, by name",
            [this](const std::string& text) { diff.limits_file = text; });
  add_value(command, "--junit", "FILE.xml", "Also write the result of each pair as JUnit XML for CI systems",
            [this](const std::string& text) { diff.junit = text; });
  add_value(command, "--html", "FILE.html", "Also write a page of all differences: before, after, difference",
            [this](const std::string& text) { diff.html = text; });
  command.add_flag("--annotations", diff.annotations,
                   "Also print annotations for GitHub Actions [if GITHUB_ACTIONS is true]");
  command.add_flag("--overwrite", diff.overwrite, "Replace heat maps and reports that exist already");
  command.add_flag("--json", diff.json, "Print JSON instead of text");
  command.footer(
      "\nExamples:\n"
      "  weft diff references/band.png band.png --heatmap difference.png\n"
      "  weft diff references output --limits limits.toml --html differences.html --junit differences.xml\n"
      "  weft diff before.mp4 after.mp4\n"
      "\nFolders are compared with everything below them, by name. References may be in one folder for each class\n"
      "of machines, named as weft doctor prints it, and one named default. The file of limits has tables\n"
      "[[picture]] with a name, in which * stands for any text, and pixel_tolerance, pixel_budget, max_flip,\n"
      "max_spot or mask. A mask is a picture beside that file that is white where pictures are compared. The last\n"
      "table that fits counts.\n"
      "Exit codes: 0 all within the limits, 7 something differs, 8 a reference is missing, 4 a file is\n"
      "unreadable.");
}

void Parser::add_accept() {
  CLI::App& command = *app.add_subcommand("accept", "Accept pictures as the new references, and record why");
  add_argument(command, "REFERENCE", accept.reference, "The reference, or its folder");
  add_argument(command, "TEST", accept.tests, "The new pictures or videos, each by name, or folders of them");
  command.add_option("--reason", accept.reason, "Reason of the change, which is kept in accepted.md")
      ->required()
      ->type_name("TEXT");
  command.footer(
      "\nExamples:\n"
      "  weft accept references output/band.png --reason \"floor is darker by design\"\n"
      "  weft accept references/mesa-22.3-256bit output/band.png --reason \"one pixel at the hem\"");
}

void Parser::add_review() {
  CLI::App& command = *app.add_subcommand("review", "Write a page to review runs, which opens in any browser");
  add_argument(command, "DIR", review.folders, "Folders with videos and statistics of weft run");
  add_value(command, "-o,--output", "DIR", "Folder of the page [output/review]",
            [this](const std::string& text) { review.output = text; });
  add_value(command, "--reference", "DIR", "Folder with runs of the same names to compare with",
            [this](const std::string& text) { review.reference = text; });
  command.add_flag("--overwrite", review.overwrite, "Replace a page that exists already");
  command.footer(
      "\nExample:\n"
      "  weft run scenes/falling_band.toml -o runs/band.mp4 --stats runs/band.json\n"
      "  weft review runs -o page\n"
      "\nOpen page/index.html; the page needs no server and loads nothing from the network.");
}

void Parser::add_export() {
  CLI::App& command = *app.add_subcommand("export", "Write the frames of a cache as files for other programs");
  add_argument(command, "CACHE", export_frames.cache, "Folder of the cache that weft simulate wrote");
  add_value(command, "--format", "ply|obj|pc2|gltf|usd|usdz|blender", "Format of the files [gltf]",
            [this](const std::string& text) { export_frames.format = parse_choice("--format", text, kFormats); });
  command.add_option("-o,--output", export_frames.output, "Folder of the files")->required()->type_name("DIR");
  add_value(command, "--frames", "A:B[:STEP]", "Frames A to B - 1, counted from 0 [all]",
            [this](const std::string& text) { export_frames.frames = parse_frames(text); });
  add_partial(command, export_frames.partial);
  command.add_flag("--overwrite", export_frames.overwrite, "Replace files that exist already");
  command.footer(
      "\nExamples:\n"
      "  weft export band.cache --format gltf -o band\n"
      "  weft export band.cache --format ply -o band --frames 0:126:25\n"
      "  weft export band.cache --format blender -o band && blender -P band/falling_band.py\n"
      "\nply, obj: one file for each object and frame. pc2: for each object an OBJ file and a point cache that\n"
      "moves its vertices. gltf: one file with all visible objects, their colours and motion (morph targets).\n"
      "usd: one text file with all visible objects, their colours and motion, and the cameras. usdz: the same,\n"
      "packed, for viewers on phones. blender: as pc2, and a script that loads everything with cameras, lights,\n"
      "frame rate and picture size.");
}

}  // namespace weft::cli
