// Helpers for authors of scenes and commands: templates, watching, completion, the manual, the estimate.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <thread>

#include "cli/cached_run.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/manual.hpp"
#include "tools/cli/parser.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class Helpers : public CachedRun {};

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  for (int c = 0; pipe && (c = std::fgetc(pipe.get())) != EOF;) text += static_cast<char>(c);
  return text;
}

TEST_F(Helpers, EveryTemplateIsASceneWithItsSchemaBesideIt) {
  for (const std::string& name : template_names()) {
    if (name == "ci") continue;  // ci_template_slow.cpp tests it
    expect_exit(run_weft({"new", "my " + name, "--template", name}, folder_), 0);
    const Outcome checked = run_weft({"check", "my " + name + ".toml"}, folder_);
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_FALSE(contains(checked.out, "note:")) << "nothing to doubt: " << checked.out;
    EXPECT_TRUE(support::read_bytes(folder_ / ("my " + name + ".toml")).starts_with("#:schema ./weft.schema.json\n"));
  }
  EXPECT_EQ(support::read_bytes(folder_ / "weft.schema.json"), run_weft({"schema"}, folder_).out);
  for (const Arguments& command : {Arguments{"schema"}, {"schema", "--pattern"}})
    EXPECT_TRUE(run_weft(command, folder_).out.ends_with("}\n")) << "no empty line at the end";
  support::write_bytes(folder_ / "weft.schema.json", "{}\n");  // like the schema of an older version
  EXPECT_EQ(run_weft({"new", "my drape"}, folder_).exit_code, 6) << "it is there already";
  EXPECT_EQ(support::read_bytes(folder_ / "weft.schema.json"), "{}\n");
  EXPECT_EQ(run_weft({"new", "my drape", "--overwrite"}, folder_).exit_code, 0);
  EXPECT_EQ(support::read_bytes(folder_ / "weft.schema.json"), run_weft({"schema"}, folder_).out);
  EXPECT_EQ(run_weft({"new", "other", "--template", "dress"}, folder_).exit_code, 2);
  for (const char* name : {"folder/", ".", ".."}) EXPECT_EQ(run_weft({"new", name}, folder_).exit_code, 2) << name;
}

TEST_F(Helpers, TemplateOfARepositoryAddsToOneThatIsThere) {
  const auto put = [&](const char* name, const std::string& text) { support::write_bytes(folder_ / name, text); };
  const auto read = [&](const char* name) { return support::read_bytes(folder_ / name); };
  fs::create_directories(folder_ / "scenes");
  put("README.md", "mine\n");
  put(".gitignore", "/build/\n/out/");
  put("scenes/flag.toml", "# mine\n");
  put("limits.toml", "# mine\n");
  const Outcome made = run_weft({"new", ".", "--template", "ci"}, folder_);
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(read("README.md"), "mine\n");
  EXPECT_EQ(read("scenes/flag.toml"), "# mine\n");
  EXPECT_EQ(read("limits.toml"), "# mine\n");
  EXPECT_TRUE(contains(read("PICTURES.md"), "# Scenes of cloth"));
  EXPECT_EQ(read(".gitignore"), "/build/\n/out/\n/report/\n/caches/\n/.weft/\n/.ccache/\n");
  EXPECT_TRUE(fs::exists(folder_ / ".github/workflows/pictures.yml"));
  EXPECT_TRUE(fs::exists(folder_ / "pictures.sh"));
  EXPECT_TRUE(contains(made.err, "limits.toml: kept as it is")) << made.err;
  EXPECT_TRUE(contains(made.err, "PICTURES.md explains the next steps")) << made.err;
  // A second call accepts the files that the first call wrote.
  EXPECT_EQ(run_weft({"new", ".", "--template", "ci"}, folder_).exit_code, 0);
  EXPECT_EQ(read(".gitignore"), "/build/\n/out/\n/report/\n/caches/\n/.weft/\n/.ccache/\n");
}

TEST_F(Helpers, TemplateOfARepositoryKeepsLinksWhoseTargetsAreMissing) {
  const std::vector<std::string> links{"README.md", ".gitignore", "limits.toml", "weft.schema.json"};
  for (const std::string& link : links) fs::create_symlink("none_" + link, folder_ / link);
  expect_exit(run_weft({"new", ".", "--template", "ci"}, folder_), 0);
  for (const std::string& link : links) EXPECT_TRUE(fs::is_symlink(folder_ / link)) << link;
  EXPECT_TRUE(fs::exists(folder_ / "PICTURES.md"));
}

// A computed camera follows the cloth, so a change of the cloth would change every pixel.
TEST_F(Helpers, ScenesOfTheTemplateOfARepositoryHaveFixedCameras) {
  EXPECT_EQ(run_weft({"new", "repo", "--template", "ci"}, folder_).exit_code, 0);
  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "repo/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    ++scenes;
    EXPECT_TRUE(contains(support::read_bytes(entry.path()), "[[camera]]")) << entry.path();
    EXPECT_EQ(run_weft({"check", entry.path().string()}, folder_).exit_code, 0);
  }
  EXPECT_EQ(scenes, 2);
}

// `./weft` builds each of its two programs when a command first needs it: one for `render`, the other for `diff`.
TEST_F(Helpers, WorkflowOfARepositoryBuildsBothProgramsWithTheCacheOfTheCompiler) {
  EXPECT_EQ(run_weft({"new", "repo", "--template", "ci"}, folder_).exit_code, 0);
  const std::string workflow = support::read_bytes(folder_ / "repo/.github/workflows/pictures.yml");
  const std::size_t begin = workflow.find("CCACHE_DIR:"), end = workflow.find("- name: Draw and compare");
  for (const char* command : {".weft/weft --version", ".weft/weft diff --help"}) {
    const std::size_t found = workflow.find(command);
    EXPECT_TRUE(begin < found && found < end) << command;
  }
}

TEST_F(Helpers, WatchDrawsAgainWhenTheSceneChanges) {
  std::thread change([&] {
    for (int i = 0; i < 600 && !fs::exists(folder_ / "s.png"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    fs::rename(folder_ / "s.png", folder_ / "first.png");
    support::write_bytes(folder_ / "s.toml",
                         support::read_bytes(folder_ / "s.toml") + "\nlook = { color = \"#000000\" }\n");
  });
  const Outcome watched = run_weft(
      {"watch", "s.toml", "-o", "s.png", "--frame", "1", "--size", "64x36", "--quality", "draft", "--times", "2"},
      folder_);
  change.join();
  EXPECT_EQ(watched.exit_code, 0) << watched.err;
  EXPECT_TRUE(fs::exists(folder_ / "s.png")) << watched.err;
  EXPECT_NE(support::read_bytes(folder_ / "first.png"), support::read_bytes(folder_ / "s.png"));
}

TEST_F(Helpers, WatchOfSomeDrawingsHasTheExitCodeOfTheLast) {
  expect_exit(run_weft({"watch", "s.toml", "-o", "s.png", "--set", "time.step=-1", "--times", "1"}, folder_), 3);
  EXPECT_FALSE(fs::exists(folder_ / "s.png"));
}

TEST_F(Helpers, WatchOfTheStartReplacesNoForeignPicture) {
  fs::create_directories(folder_ / "output");
  support::write_bytes(folder_ / "output/s.start.watch.png", "precious");
  expect_exit(run_weft({"watch", "s.toml", "--start", "--times", "1"}, folder_), 6);
  EXPECT_EQ(support::read_bytes(folder_ / "output/s.start.watch.png"), "precious");
}

// `weft thumbnail` writes its picture under the default name, which the picture of `weft watch` must not replace.
TEST_F(Helpers, WatchOfAStillReplacesNoThumbnail) {
  const Arguments small{"--size", "64x36", "--quality", "draft", "--frame", "0"};
  Arguments thumbnail{"thumbnail", "s.toml"}, watch{"watch", "s.toml", "--times", "1"};
  for (Arguments* command : {&thumbnail, &watch}) command->insert(command->end(), small.begin(), small.end());
  ASSERT_EQ(run_weft(thumbnail, folder_).exit_code, 0);
  const auto written = fs::last_write_time(folder_ / "output/s.png");
  for (int call = 0; call < 2; ++call) {
    expect_exit(run_weft(watch, folder_), 0);
  }
  EXPECT_TRUE(fs::exists(folder_ / "output/s.watch.png"));
  watch.insert(watch.end(), {"-o", "output/s.png"});
  expect_exit(run_weft(watch, folder_), 6, "give a name that ends in .watch.png");
  EXPECT_EQ(fs::last_write_time(folder_ / "output/s.png"), written);
  watch.back() = "output";
  EXPECT_EQ(run_weft(watch, folder_).exit_code, 0);
}

// `weft run` writes its film under the default name, which the film of `weft watch` must not replace.
TEST_F(Helpers, WatchOfAFilmReplacesNoFinishedFilm) {
  const Arguments small{"--size", "64x36", "--quality", "draft", "--frames", "0:2"};
  Arguments run{"run", "s.toml"}, watch{"watch", "s.toml", "--film", "--times", "1"};
  for (Arguments* command : {&run, &watch}) command->insert(command->end(), small.begin(), small.end());
  ASSERT_EQ(run_weft(run, folder_).exit_code, 0);
  const auto written = fs::last_write_time(folder_ / "output/s.mp4");
  expect_exit(run_weft(watch, folder_), 0);
  EXPECT_EQ(fs::last_write_time(folder_ / "output/s.mp4"), written);
  EXPECT_TRUE(fs::exists(folder_ / "output/s.watch.mp4"));
  watch.insert(watch.end(), {"-o", "output/s.mp4"});
  expect_exit(run_weft(watch, folder_), 6, "give a name that ends in .watch.mp4");
  EXPECT_EQ(fs::last_write_time(folder_ / "output/s.mp4"), written);
  watch.back() = "output/s.watch.mp4";
  EXPECT_EQ(run_weft(watch, folder_).exit_code, 0);
}

TEST_F(Helpers, WatchOfAFilmThatIsStoppedLeavesNoCacheAndNoTemporaryFile) {
  Subprocess watch({"watch", "s.toml", "--film", "--size", "64x36", "--quality", "draft", "--set", "time.duration=60"},
                   folder_);
  const fs::path output = folder_ / "output";
  for (int i = 0; i < 3000 && !fs::exists(output / ".s.watch.weft-cache/frame_00000.weft"); ++i) usleep(20'000);
  watch.send(SIGTERM);
  EXPECT_EQ(watch.wait().exit_code, 0);
  for (const auto& entry : fs::directory_iterator(output))
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

// Descriptor 9 is a pipe whose reading end is closed, as that of `weft man | head` when `head` has ended.
TEST_F(Helpers, EndsQuietlyWhereNobodyReadsWhatItPrints) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ASSERT_EQ(::dup2(ends[1], 9), 9);
  ::close(ends[0]);
  ::close(ends[1]);
  const auto printed = [&](const std::string& arguments, const std::string& to) {
    const std::string place = (folder_ / "err").string();
    const int status =
        std::system(fmt::format("cd '{}' && '{}' {} >{} 2>err", folder_.string(), WEFT_PROGRAM, arguments, to).c_str());
    return std::pair(WEXITSTATUS(status), support::read_bytes(place));
  };
  EXPECT_EQ(printed("man", "&9"), std::pair(0, std::string()));
  EXPECT_EQ(printed("check s.toml", "&9"), std::pair(0, std::string()));
  EXPECT_EQ(printed("man", "/dev/full").first, 6);
  EXPECT_TRUE(contains(printed("man", "/dev/full").second, "standard output cannot be written: No space left"));
  ::close(9);
}

TEST_F(Helpers, CompletionAndManualKnowAllThatHelpKnows) {
  const Parser parser;
  const std::string man = manual(parser.app), bash = completion(parser.app, "bash"),
                    zsh = completion(parser.app, "zsh"), fish = completion(parser.app, "fish");
  for (const CLI::App* command : parser.app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string& name = command->get_name();
    EXPECT_TRUE(contains(man, ".SH " + name + "\n")) << name;
    EXPECT_TRUE(contains(fish, "-a " + name + " -d")) << name;
    for (const CLI::Option* option : command->get_options())
      for (const std::string& word : option->get_lnames()) {
        EXPECT_TRUE(contains(zsh, "'*--" + word + (option->get_items_expected_max() > 0 ? "=[" : "["))) << word;
        EXPECT_TRUE(contains(fish, "from " + name + "' ")) << word;
        EXPECT_TRUE(contains(fish, "-l " + word + " ")) << word;
      }
  }
  support::write_bytes(folder_ / "weft.bash", bash);
  const auto completed = [&](const std::string& words, int at) {
    return output_of("bash -c '. \"" + (folder_ / "weft.bash").string() + "\"; COMP_WORDS=(" + words +
                     "); COMP_CWORD=" + std::to_string(at) + "; _weft; echo \"${COMPREPLY[*]}\"'");
  };
  EXPECT_EQ(completed("weft thu", 1), "thumbnail\n");
  EXPECT_EQ(completed("weft run s.toml --qual", 3), "--quality\n");
  EXPECT_EQ(completed("weft run --quality \"\"", 3), "draft preview final\n");
  EXPECT_EQ(completed("weft run --quality = d", 4), "draft\n") << "--quality=d, as bash parts it";
  EXPECT_EQ(completed("weft farm \"\"", 2), "submit status cancel\n");
  EXPECT_EQ(completed("weft run --output \"\"", 3), "\n") << "names of files, by the shell itself";
}

TEST_F(Helpers, TwoDashesEndTheOptions) {
  fs::copy(folder_ / "s.toml", folder_ / "-s.toml");
  EXPECT_EQ(run_weft({"check", "--", "-s.toml"}, folder_).exit_code, 0);
  EXPECT_EQ(run_weft({"check", "./-s.toml"}, folder_).exit_code, 0);
  expect_exit(
      run_weft({"watch", "--frame", "0", "--size", "64x36", "--quality", "draft", "--times", "1", "--", "-s.toml"},
               folder_),
      0);
  expect_exit(run_weft({"check", "-s.toml"}, folder_), 2,
              "unknown option -s.toml; for a file of this name, write ./-s.toml, or put it after --");
  EXPECT_TRUE(contains(run_weft({"check", "--pln"}, folder_).err, "unknown option --pln; did you mean --plan?"));
}

TEST_F(Helpers, CheckSaysWhatHasChangedSinceAnotherScene) {
  const auto check = [&](const char* changed, const char* against, int code, const std::string& words) {
    const Outcome outcome = run_weft({"check", "s.toml", "--set", changed, "--against", against}, folder_);
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_TRUE(contains(outcome.out + outcome.err, words)) << words << "\n" << outcome.out << outcome.err;
  };
  check("time.preroll=0", "s.toml", 0, "s.toml: the same as s.toml\n");
  check("cloth.cloth.look.roughness=0.25", "s.toml", 0, "s.toml: changed: cloth.cloth.look.roughness: ");
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":2"});
  check("physics.gravity=[0,0,-5]", "c", 0, "changed: physics.gravity: [0, 0, -9.81] -> [0, 0, -5]\n");
  support::write_bytes(folder_ / "old.toml", "[cloth]\n");
  check("time.preroll=0", "old.toml", 3, "old.toml:1:1: cloth: expected a list of tables");
  support::write_bytes(folder_ / "old.effective.toml", "words");
  check("time.preroll=0", "old.effective.toml", 4, "old.effective.toml:1:");
}

TEST_F(Helpers, CheckEstimatesWhatARunTakes) {
  const Outcome outcome = run_weft({"check", "--estimate", "s.toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "MB of memory, estimated from 10 frames")) << outcome.out;
}

// Commands that keep no files end at once.
TEST_F(Helpers, CheckThatIsTerminatedExitsWith75) {
  std::string text = support::read_bytes(folder_ / "s.toml");
  text.replace(text.find("step = 0.02"), 11, "step = 1e-7");  // millions of steps for the first frame of the estimate
  support::write_bytes(folder_ / "long.toml", text);
  Subprocess weft(
      {"check", "s.toml", "long.toml", "--estimate", "--set", "render.width=64", "--set", "render.height=36"}, folder_);
  ASSERT_TRUE(weft.wait_for_output("s.toml: about"));
  weft.send(SIGTERM);
  EXPECT_EQ(weft.wait().exit_code, 75);
}

}  // namespace
}  // namespace weft::cli
