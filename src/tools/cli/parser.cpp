#include "tools/cli/parser.hpp"

#include "core/version.hpp"
#include "tools/cli/option_groups.hpp"

namespace weft::cli {

Parser::Parser() {
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
      "\nExit codes: 0 success, 1 internal error, 2 command line, 3 scene, 4 asset, 5 simulation,\n"
      "  6 output or encoder, 7 images differ, 8 reference missing,\n"
      "  9 frames missing, 75 interrupted.");
  add_run();
  add_simulate();
  add_render();
  add_check();
  add_new();
  add_watch();
  add_thumbnail();
  add_sheet();
  add_join();
  add_sweep();
  add_farm();
  add_schema();
  add_doctor();
  add_bench();
  add_diff();
  add_accept();
  add_review();
  add_export();
  add_completion();
}

void Parser::add_run() {
  CLI::App& command = *app.add_subcommand("run", "Simulate a scene, draw it and encode the video");
  add_output(command, run);
  add_frames(command, run, "Draw frames A to B - 1, counted from 0 [all]");
  add_common(command, run.common);
  add_side_files(command, run);
  add_error(command, run);
  command.add_flag("--resume", run.resume, "Continue the unfinished run with the same output");
  command.footer(
      "\nExamples:\n"
      "  weft run scenes/falling_band.toml\n"
      "  weft run scenes/falling_band.toml -o band.mp4 --quality preview --size 640x360\n"
      "  weft run scenes/falling_band.toml --frames 0:50 -o 'out/{frame:05}.png' --overwrite\n"
      "  weft run scenes/falling_band.toml --set cloth.band.material.stretch=1e4 --stats band.json\n"
      "\nCtrl-C or SIGTERM ends the run after the current frame, or after three seconds if the frame takes longer,\n"
      "with a playable video (exit code 75); a second signal ends it at once. Simulated frames are kept, even if\n"
      "the run is killed: --resume continues from there, with the frames of an uninterrupted run. With a STEP,\n"
      "the video keeps the true speed at fewer frames per second.");
}

void Parser::add_simulate() {
  CLI::App& command = *app.add_subcommand("simulate", "Simulate a scene into a frame cache, to be drawn later");
  command.add_option("--cache", simulate.cache, "Folder of the cache")->required()->type_name("DIR");
  add_frames(command, simulate, "Simulate up to frame B - 1; A and STEP are for --meshes [all]");
  add_common(command, simulate.common);
  add_side_files(command, simulate);
  add_error(command, simulate);
  command.add_flag("--resume", simulate.resume, "Continue where the cache ends");
  command.footer(
      "\nExamples:\n"
      "  weft simulate scenes/falling_band.toml --cache band.cache\n"
      "  weft simulate scenes/falling_band.toml --cache band.cache --resume\n"
      "\nweft render uses this size and camera, unless its own options say otherwise.");
}

void Parser::add_render() {
  CLI::App& command = *app.add_subcommand("render", "Draw the frames of a cache");
  add_argument(command, "CACHE", render.common.scene, "Folder of the cache that weft simulate wrote");
  add_output(command, render);
  add_frames(command, render, "Draw frames A to B - 1, counted from 0 [all]");
  add_picture(command, render.common);
  add_process(command, render.common);
  add_side_files(command, render);
  add_partial(command, render.partial);
  command.add_flag("--resume", render.resume, "Draw only the missing pictures");
  command.footer(
      "\nExamples:\n"
      "  weft render band.cache -o band.mp4\n"
      "  weft render band.cache --frames 50:100 --camera side --size 1920x1080 -o 'side/{frame:05}.png'\n"
      "  weft render band.cache -o 'band/{frame:05}.png' --resume\n"
      "\nSeveral processes may draw from one cache at once, also while weft simulate writes it. A computed camera,\n"
      "such as that of a scene without cameras, is that of the film only if the cache has all frames. If requested\n"
      "frames are missing or broken, the command draws nothing and ends with exit code 9. With --resume, an\n"
      "incomplete video is drawn again from its first frame.");
}

void Parser::add_thumbnail() {
  CLI::App& command = *app.add_subcommand("thumbnail", "Draw one still of each scene or cache");
  add_argument(command, "SCENE", thumbnail.scenes, "Scenes, TOML files, or folders of caches");
  add_value(command, "-o,--output", "FILE.png|DIR", "The picture, or the folder of <scene>.png [output/<scene>.png]",
            [this](const std::string& text) { thumbnail.output = text; });
  add_value(command, "--frame", "N", "Frame to draw, counted from 0 [the most informative one]",
            [this](const std::string& text) { thumbnail.frame = parse_integer("--frame", text, 0, 1'000'000'000); });
  command.add_flag("--start", thumbnail.start,
                   "Instead of a frame: draw the start as given, with surfaces that touch or cross in red");
  add_scene_changes(command, thumbnail.common);
  command.footer(
      "\nExamples:\n"
      "  weft thumbnail scenes/falling_band.toml -o band.png --frame 60 --quality draft\n"
      "  weft thumbnail scenes/*.toml -o stills --size 320x180\n"
      "  weft thumbnail dress.toml --start -o start.png\n"
      "\nWith --frame N, a scene is simulated up to frame N, and a computed camera shows what has happened until\n"
      "then, that of the film all frames. A cache of all frames gives the picture of the film, without motion blur.\n"
      "\nIf a scene fails, the others are still drawn; the exit code is that of the first scene that failed.");
}

void Parser::add_sheet() {
  CLI::App& command = *app.add_subcommand("sheet", "Draw evenly spaced frames of a scene or a cache on one picture");
  add_value(command, "-o,--output", "FILE.png", "The picture [output/<scene>.sheet.png]",
            [this](const std::string& text) { sheet.output = text; });
  add_value(command, "--count", "N", "Number of frames, the first and the last included [12]",
            [this](const std::string& text) { sheet.count = parse_integer("--count", text, 1, 400); });
  add_value(command, "--columns", "N", "Number of pictures side by side [4]",
            [this](const std::string& text) { sheet.columns = parse_integer("--columns", text, 1, 40); });
  add_common(command, sheet.common, "The scene, a TOML file, or the folder of a cache");
  command.footer(
      "\nExample:\n  weft sheet scenes/falling_band.toml -o sheet.png --count 20 --columns 5\n"
      "\n--size is that of each small picture [400 wide].");
}

void Parser::add_join() {
  CLI::App& command = *app.add_subcommand("join", "Join videos, or folders of pictures, to one video");
  command.alias("encode");
  add_argument(command, "PART", join.parts, "Videos, or folders of pictures, that weft has drawn; in any order");
  command.add_option("-o,--output", join.output, "The video")->required()->type_name("FILE");
  add_video(command, join.video);
  add_value(command, "--frames", "A:B[:STEP]", "Frames A to B - 1, counted from 0 [all of the scene]",
            [this](const std::string& text) { join.frames = parse_frames(text); });
  add_partial(command, join.partial);
  command.add_flag("--overwrite", join.overwrite, "Replace a video that exists already");
  command.footer(
      "\nExamples:\n"
      "  weft join band -o band.mp4\n"
      "  weft join first.mp4 second.mp4 -o band.mp4\n"
      "  weft encode band -o band.mov\n"
      "\nEach part stores which frames of which scene it holds. If frames are missing, the command ends with exit\n"
      "code 9. Pictures become the video that weft render would make, byte for byte unless they have 16 bits per\n"
      "channel; videos are not encoded again.\n"
      "encode is another name of join.");
}

std::vector<std::string> Parser::command_names() const {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

CLI::App* Parser::selected() const {
  const auto commands = app.get_subcommands();
  return commands.empty() ? nullptr : commands.front();
}

}  // namespace weft::cli
