// Options of the commands for authors of scenes.
#include "core/error.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/option_groups.hpp"
#include "tools/cli/parser.hpp"

namespace weft::cli {
namespace {

// Returns `text` if it is one of `words`; otherwise throws Error(usage) with the most similar word.
std::string check_choice(const char* name, const std::string& text, const std::vector<std::string>& words) {
  if (std::ranges::find(words, text) != words.end()) return text;
  throw Error(ExitCode::usage, "{}: expected {}, got {}{}", name, fmt::join(words, ", "), text,
              did_you_mean(text, words));
}

}  // namespace

void Parser::add_new() {
  CLI::App& command = *app.add_subcommand("new", "Write a first scene to start from");
  add_argument(command, "NAME", new_scene.name,
               "Name of the scene: writes NAME.toml, and the schema beside it; with --template ci, name of the folder");
  add_value(command, "--template", fmt::format("{}", fmt::join(template_names(), "|")).c_str(),
            fmt::format("Kind of scene [{}]", new_scene.kind),
            [this](const std::string& text) { new_scene.kind = check_choice("--template", text, template_names()); });
  command.add_flag("--overwrite", new_scene.overwrite, "Replace a scene that exists already");
  command.footer(
      "\nExample:\n"
      "  weft new dress --template cape && weft watch dress.toml\n"
      "\nThe first line of the scene names the schema, with which editors complete keys and mark mistakes. The\n"
      "template ci is a folder for a repository: scenes, a script that draws them and compares with references,\n"
      "and a workflow that runs it.");
}

void Parser::add_watch() {
  CLI::App& command = *app.add_subcommand("watch", "Draw a scene again whenever one of its files changes");
  add_argument(command, "SCENE", watch.scene, "The scene, a TOML file");
  const auto passed_on = std::bind_front(add_passed_on, std::ref(command), std::ref(watch.passed_on));
  const auto anything = [](const std::string&) {};
  passed_on("--output,-o", "FILE.png|FILE.mp4", "Picture or video [output/<scene>.watch.png, with --film .watch.mp4]",
            anything);
  passed_on("--size", "WxH", "Size of the picture in pixels [the scene's, or 1280x720]", parse_size);
  passed_on("--camera", "NAME", "Camera of the scene that draws [render.camera, the first one, or automatic framing]",
            anything);
  passed_on("--frame", "N", "Frame that the still shows, counted from 0 [the most informative one]",
            [](const std::string& text) { parse_integer("--frame", text, 0, 1'000'000'000); });
  passed_on("--frames", "A:B[:STEP]", "With --film: draw frames A to B - 1, counted from 0 [all]", parse_frames);
  passed_on("--quality", "draft|preview|final", "Quality of the pictures [final]",
            [](const std::string& text) { parse_choice("--quality", text, kQualities); });
  command.add_flag("--film", watch.film, "Make the whole video instead of a still");
  command.add_flag(
      "--start", [this](std::int64_t) { watch.passed_on.emplace_back("--start"); },
      "For a still: draw the start as given, with surfaces that touch or cross in red");
  add_overrides(command, watch.overrides);
  add_value(command, "--times", "N", "Number of drawings, after which it ends [until interrupted]",
            [this](const std::string& text) { watch.times = parse_integer("--times", text, 1, 1'000'000'000); });
  command.footer(
      "\nExamples:\n"
      "  weft watch dress.toml --frame 20 --quality draft -o dress.watch.png\n"
      "  weft watch dress.toml --film --quality draft --size 320x180\n"
      "\nIf a file changes during a drawing, that drawing is stopped and a new one begins. Viewers that follow the\n"
      "output file show the last complete one. A file that exists before the first drawing is replaced only if its\n"
      "name ends in .watch.png, .watch.mp4, .watch.mov or .watch.mkv.");
}

void Parser::add_completion() {
  CLI::App& command =
      *app.add_subcommand("completion", "Print a script by which a shell completes commands and options");
  command
      .add_option_function<std::string>(
          "SHELL",
          [this](const std::string& text) {
            shell = check_choice("SHELL", text, {"bash", "zsh", "fish"});
          },
          "Shell for which the script is")
      ->required()
      ->type_name("bash|zsh|fish");
  command.footer(
      "\nExamples:\n  source <(weft completion bash)\n"
      "  weft completion fish > ~/.config/fish/completions/weft.fish");
  CLI::App& man = *app.add_subcommand("man", "Print the manual page");
  man.footer("\nExample:\n  weft man > weft.1 && man ./weft.1");
}

}  // namespace weft::cli
