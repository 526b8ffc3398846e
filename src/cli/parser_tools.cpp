// Commands that make no films: checks, measurements, comparison, exports.
#include "cli/option_groups.hpp"
#include "cli/parser.hpp"
#include "core/error.hpp"

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
  command.add_option("SCENE", check.scenes, "Scenes, TOML files")->required()->type_name("");
  command.add_flag("--plan", check.plan, "Also print which parts the scene needs and which are left out");
  command.add_flag("--estimate", check.estimate,
                   "Also simulate some seconds, and tell what a run takes of time and memory");
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
  command.add_flag("--pattern", schema.pattern, "That of sewing patterns instead");
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
          "stability: what comes of stiff and extreme scenes, or at what values a scene breaks; accuracy: error "
          "against "
          "run time of a scene; speed: "
          "time by stage, iterations and memory over sizes, threads and steps; fabrics: drape, bending and extension "
          "against what was published")
      ->required()
      ->type_name("stability|accuracy|speed|fabrics");
  command
      .add_option("SCENE", bench.scene,
                  "The scene, a TOML file, not of fabrics [extreme ones; a swinging sheet; a drape]")
      ->type_name("");
  add_overrides(command, bench.overrides);
  add_value(command, "-o,--output", "DIR", "Folder for tables and plots [output/bench]",
            [this](const std::string& text) { bench.output = text; });
  command.add_flag("--overwrite", bench.overwrite, "Replace files that exist already");
  using Kind = BenchOptions::Kind;
  const auto only_of = [&](std::vector<Kind> kinds, const char* name, const char* value, const char* description,
                           std::function<void(const std::string&)> read) {
    add_value(command, name, value, description, [this, name, read, kinds](const std::string& text) {
      read(text);
      bench_options.push_back({name, kinds});
    });
  };
  const auto of_speed = [&](const char* name, const char* value, const char* description,
                            std::function<void(const std::string&)> read) {
    only_of({Kind::speed}, name, value, description, std::move(read));
  };
  only_of({Kind::accuracy}, "--integrators", "NAME,NAME,...",
          "Of accuracy: time.integrator [implicit_euler,implicit_midpoint,bdf2]", [this](const std::string& text) {
            bench.plan.integrators = parse_list<scene::Integrator>(
                "--integrators", text,
                [](const char* option, const std::string& part) { return parse_choice(option, part, kIntegrators); });
          });
  only_of(
      {Kind::speed, Kind::accuracy}, "--steps", "F,F,...",
      "Of speed and accuracy: time.step, of speed also time.tolerance, times that of the scene [0.5,1,2; of accuracy "
      "0.125 to 4]",
      [this](const std::string& text) {
        bench.steps = parse_list<double>("--steps", text, parse_factor);
        bench.plan.steps = bench.steps;
      });
  only_of(
      {Kind::accuracy}, "--tolerances", "M,M,...|none", "Of accuracy: time.tolerance in m [1e-3 downwards]",
      [this](const std::string& text) { bench.plan.tolerances = parse_values("--tolerances", text, parse_length); });
  only_of({Kind::accuracy}, "--meshes", "F,F,...|none",
          "Of accuracy: cells along each side, times those of the scene [0.25,0.5,1]",
          [this](const std::string& text) { bench.plan.meshes = parse_values("--meshes", text, parse_factor); });
  only_of({Kind::accuracy}, "--starts", "N",
          "Of accuracy: runs of each setting, their starts moved by 1 µm from one to the next [1; with contact 3]",
          [this](const std::string& text) { bench.plan.starts = parse_integer("--starts", text, 1, kMaxStarts); });
  of_speed("--sizes", "F,F,...", "Of speed: particles along each side, times those of the scene [0.5,1,2,4]",
           [this](const std::string& text) { bench.sizes = parse_list<double>("--sizes", text, parse_factor); });
  of_speed("--threads", "N,N,...", "Of speed: numbers of threads [1 and all cores]", [this](const std::string& text) {
    bench.threads = parse_list<int>("--threads", text, [](const char* option, const std::string& part) {
      return parse_integer(option, part, 1, kMaxThreads);
    });
  });
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
      "  weft bench stability scenes/falling_band.toml --set time.duration=0.8 -o stability\n"
      "  weft bench accuracy scenes/falling_band.toml --set time.duration=0.8 -o accuracy\n"
      "  weft bench accuracy flag.toml --integrators implicit_euler,bdf2 --steps 0.5,1,2 --meshes none -o steps\n"
      "  weft bench speed scenes/falling_band.toml --sizes 0.5,1,2 --frames 20:40 -o speed");
}

void Parser::add_diff() {
  CLI::App& command = *app.add_subcommand("diff", "Compare pictures, videos, or folders of them");
  command.add_option("REFERENCE", diff.reference, "As it should be: .png, video, folder")->required()->type_name("");
  command.add_option("TEST", diff.test, "As it is now: likewise")->required()->type_name("");
  int& limit = diff.limits.pixel_tolerance;
  add_value(command, "--pixel-tolerance", "N", fmt::format("Levels of 255 by which a pixel may differ [{}]", limit),
            [&limit](const std::string& text) { limit = parse_integer("--pixel-tolerance", text, 0, 255); });
  const auto add_share = [&](const char* name, double& most, const char* what) {
    add_value(command, name, "X", fmt::format("{} [{}]", what, most),
              [name, &most](const std::string& text) { most = parse_fraction(name, text); });
  };
  add_share("--pixel-budget", diff.limits.pixel_budget,
            "Share of the pixels that may differ by more; unless given, at edges a fortieth of them counts");
  add_share("--max-flip", diff.limits.flip,
            "Largest mean of FLIP, 0 (looks the same) to 1; unless given, wider below 640x360 pixels");
  add_share("--max-spot", diff.limits.spot, "Largest value of FLIP at any pixel");
  add_value(command, "--heatmap", "FILE.png|DIR", "Also paint where it differs; a video's worst frame",
            [this](const std::string& text) { diff.heatmap = text; });
  add_value(command, "--limits", "FILE.toml", "Limits and masks of single pictures, by name",
            [this](const std::string& text) { diff.limits_file = text; });
  add_value(command, "--junit", "FILE.xml", "Also write what came of each pair for CI systems",
            [this](const std::string& text) { diff.junit = text; });
  add_value(command, "--html", "FILE.html", "Also write a page of what differs: before, after, difference",
            [this](const std::string& text) { diff.html = text; });
  command.add_flag("--annotations", diff.annotations,
                   "Also print lines that GitHub Actions shows at the files [where GITHUB_ACTIONS is true]");
  command.add_flag("--overwrite", diff.overwrite, "Replace heat maps and reports that exist already");
  command.add_flag("--json", diff.json, "Print JSON instead of text");
  command.footer(
      "\nExamples:\n"
      "  weft diff references/band.png band.png --heatmap difference.png\n"
      "  weft diff references output --limits limits.toml --html differences.html --junit differences.xml\n"
      "  weft diff before.mp4 after.mp4\n"
      "\nFolders are compared with all below them, by name. References may lie in one folder for each class\n"
      "of machines, named as weft doctor says, and one named default. Limits are tables [[picture]]\n"
      "with a name, in which * stands for anything, and pixel_tolerance, pixel_budget, max_flip, max_spot or mask, a\n"
      "picture beside the file that is white where is compared; the last that fits counts. "
      "Exit codes: 0 all within the limits, 7 something differs, 8 a reference is missing, 4 a file is unreadable.");
}

void Parser::add_accept() {
  CLI::App& command = *app.add_subcommand("accept", "Make pictures the new references, and record why");
  command.add_option("REFERENCE", accept.reference, "The reference, or its folder")->required()->type_name("");
  command.add_option("TEST", accept.tests, "The new pictures or videos, each by name, or folders of them")
      ->required()
      ->type_name("");
  command.add_option("--reason", accept.reason, "Why: kept in accepted.md")->required()->type_name("TEXT");
  command.footer(
      "\nExamples:\n"
      "  weft accept references output/band.png --reason \"floor is darker by design\"\n"
      "  weft accept references/mesa-22.3-256bit output/band.png --reason \"one pixel at the hem\"");
}

void Parser::add_review() {
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

void Parser::add_export() {
  CLI::App& command = *app.add_subcommand("export", "Write the frames of a cache as files for other programs");
  command.add_option("CACHE", exported.cache, "Folder of weft simulate --cache")->required()->type_name("");
  add_value(command, "--format", "ply|obj|pc2|gltf|usd|usdz|blender", "Form of the files [gltf]",
            [this](const std::string& text) { exported.format = parse_choice("--format", text, kFormats); });
  command.add_option("-o,--output", exported.output, "Folder of the files")->required()->type_name("DIR");
  add_value(command, "--frames", "A:B[:STEP]", "Frames A up to but without B, counted from 0 [all]",
            [this](const std::string& text) { exported.frames = parse_frames(text); });
  add_partial(command, exported.partial);
  command.add_flag("--overwrite", exported.overwrite, "Replace files that exist already");
  command.footer(
      "\nExamples:\n"
      "  weft export band.cache --format gltf -o band\n"
      "  weft export band.cache --format ply -o band --frames 0:126:25\n"
      "  weft export band.cache --format blender -o band && blender -P band/falling_band.py\n"
      "\nply, obj: a file for each object and frame; pc2: for each object an OBJ file and a point cache that moves\n"
      "its vertices; gltf: one file with all that is visible, its colours and its motion (morph targets);\n"
      "usd: one text file with all that is visible, its colours, its motion and the cameras; usdz: the same, packed, "
      "as\n"
      "viewers of phones ask for it; blender: as pc2, and a\n"
      "script that loads all of it with cameras, lights, frame rate and picture size.");
}

}  // namespace weft::cli
