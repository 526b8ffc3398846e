// Runs a copy of the launcher. Scripts that log their arguments replace apt-get, dpkg-query, cmake, ninja and id, so
// that nothing is installed or built.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "support/test_folder.hpp"

namespace weft {
namespace {

namespace fs = std::filesystem;
using support::read_bytes;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  support::write_bytes(path, text);
}

void write_script(const fs::path& path, const std::string& text) {
  write(path, "#!/bin/sh\n" + text);
  fs::permissions(path, fs::perms::owner_all);
}

struct Outcome {
  int status = -1;
  std::string out, err;
};

class Launcher : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    tree_ = folder_ / "source tree";  // the name contains a space, as a home directory may
    fs::create_directories(tree_ / "shaders");
    for (const char* file : {"weft", ".launch.sh"}) fs::copy_file(fs::path(WEFT_SOURCE_DIR) / file, tree_ / file);
    write(tree_ / ".packages", "# what for\nbuild g++\nbuild libx-dev   # x\n\ntest libgtest-dev\n");
    write(tree_ / "CMakeLists.txt", "");
    write(tree_ / "CMakePresets.json", "");
    write(tree_ / "src/a.cpp", "");
    make_installed("g++\nlibx-dev\n");

    const std::string log = "echo \"$(basename \"$0\") $*\" >>\"$FAKES/calls\"\n";
    write_script(folder_ / "fakes/id", "cat \"$FAKES/uid\"\n");
    write(folder_ / "fakes/uid", "0\n");
    write_script(folder_ / "fakes/dpkg-query",
                 "sed 's/$/ installed/' \"$FAKES/installed\"; echo 'libx-dev config-files'\n");
    write_script(folder_ / "fakes/apt-get", log + "echo chatter of apt\n");
    // Calls: cmake -S TREE --preset release ...; ninja -C FOLDER -j N TARGET.
    write_script(folder_ / "fakes/cmake",
                 log +
                     "mkdir -p \"$2/build/bin\"; touch \"$2/build/build.ninja\"\n"
                     "echo \"CMAKE_HOME_DIRECTORY:INTERNAL=$2\" >\"$2/build/CMakeCache.txt\"\n");
    write_script(folder_ / "fakes/ninja", log +
                                              "echo chatter of ninja; [ ! -e \"$FAKES/broken\" ] || exit 1; sleep 0.2\n"
                                              "cp \"$FAKES/program\" \"$2/bin/weft\"\n");
    write_script(folder_ / "fakes/program", "pwd; printf '[%s]' \"$@\"; exit 7\n");
  }
  void make_installed(const std::string& packages) { write(folder_ / "fakes/installed", packages); }

  std::string command(const std::string& arguments) const {
    return "export FAKES='" + (folder_ / "fakes").string() + "'; export PATH=\"$FAKES:$PATH\"; cd /; exec '" +
           (tree_ / "weft").string() + "' " + arguments;
  }

  Outcome launch(const std::string& arguments = "run 'my scene.toml'") const {
    const std::string streams = " >'" + (folder_ / "out").string() + "' 2>'" + (folder_ / "err").string() + "'";
    const int status = std::system((command(arguments) + streams).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(folder_ / "out"), read_bytes(folder_ / "err")};
  }

  /// Names of the tools called since the last call of calls(), in order, one word each.
  std::string calls() const {
    std::ifstream file(folder_ / "fakes/calls");
    std::string names;
    for (std::string line; std::getline(file, line);) names += line.substr(0, line.find(' ')) + " ";
    fs::remove(folder_ / "fakes/calls");
    return names;
  }

  fs::path tree_;
};

TEST_F(Launcher, BuildsThenPassesArgumentsFolderAndExitCodeOn) {
  const Outcome outcome = launch();
  EXPECT_EQ(calls(), "cmake ninja ");
  EXPECT_EQ(outcome.status, 7);
  EXPECT_EQ(outcome.out, "/\n[run][my scene.toml]");
  EXPECT_EQ(outcome.err, "weft: building\n");
}

TEST_F(Launcher, DoesNothingButRunWhereNothingHasChanged) {
  launch();
  calls();
  const Outcome outcome = launch();
  EXPECT_EQ(calls(), "");
  EXPECT_EQ(outcome.status, 7);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Launcher, BuildsAgainAfterAnEditANewFileOrARemovedOne) {
  launch();
  calls();
  write(tree_ / "src/a.cpp", "edited");
  launch();
  EXPECT_EQ(calls(), "ninja ");
  write(tree_ / "shaders/new.frag", "");
  launch();
  EXPECT_EQ(calls(), "ninja ");
  fs::remove(tree_ / "shaders/new.frag");
  launch();
  EXPECT_EQ(calls(), "ninja ");
}

TEST_F(Launcher, BuildsTheToolsOnceTheyAreAskedFor) {
  launch();
  EXPECT_NE(read_bytes(folder_ / "fakes/calls").find(" weft\n"), std::string::npos);
  calls();
  EXPECT_EQ(launch("diff a.png b.png").out, "/\n[diff][a.png][b.png]");
  EXPECT_NE(read_bytes(folder_ / "fakes/calls").find(" weft_tools_program\n"), std::string::npos);
  EXPECT_EQ(calls(), "ninja ");
  for (const char* arguments : {"diff a.png b.png", "run a.toml"}) launch(arguments);
  EXPECT_EQ(calls(), "");
}

TEST_F(Launcher, ConfiguresAfreshWhereTheTreeHasMoved) {
  launch();
  calls();
  fs::rename(tree_, folder_ / "moved");
  tree_ = folder_ / "moved";
  EXPECT_EQ(launch().status, 7);
  EXPECT_EQ(calls(), "cmake ninja ");
}

TEST_F(Launcher, RootGetsOnlyTheMissingPackagesInstalled) {
  make_installed("g++\nlibx-dev-doc\n");
  const Outcome outcome = launch();
  EXPECT_EQ(read_bytes(folder_ / "fakes/calls").find("apt-get -q -o DPkg::Lock::Timeout=600 update\n"), 0u);
  EXPECT_NE(read_bytes(folder_ / "fakes/calls").find("install --no-install-recommends libx-dev\n"), std::string::npos);
  EXPECT_EQ(calls(), "apt-get apt-get cmake ninja ");
  EXPECT_EQ(outcome.out, "/\n[run][my scene.toml]");
  EXPECT_EQ(outcome.err, "weft: installing libx-dev\nweft: building\n");
}

TEST_F(Launcher, TakesTheFirstChoiceOfPackagesThatThereIs) {
  write(tree_ / ".packages", "build g++\nbuild libold6|libnew1,libnew-driver   # x\n");
  write_script(folder_ / "fakes/apt-cache", "[ \"$2\" != \"$(cat \"$FAKES/dropped\")\" ]\n");
  const auto installs = [&](const std::string& installed, const std::string& dropped) {
    fs::remove_all(tree_ / "build");
    make_installed(installed);
    write(folder_ / "fakes/dropped", dropped);
    return launch().err;
  };
  EXPECT_EQ(installs("g++\n", ""), "weft: installing libold6\nweft: building\n");
  EXPECT_EQ(installs("g++\n", "libold6"), "weft: installing libnew1 libnew-driver\nweft: building\n");
  EXPECT_EQ(installs("g++\nlibnew1\n", "libold6"), "weft: installing libnew1 libnew-driver\nweft: building\n");
  for (const char* installed : {"g++\nlibold6\n", "g++\nlibnew1\nlibnew-driver\n"})
    EXPECT_EQ(installs(installed, ""), "weft: building\n") << "nothing is missing";
}

TEST_F(Launcher, OthersAreToldThePackagesAndTheCommand) {
  make_installed("");
  write(folder_ / "fakes/uid", "1000\n");
  const Outcome outcome = launch();
  EXPECT_EQ(calls(), "");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            "weft: Debian packages are missing; install them and call again:\n"
            "  sudo apt-get update && sudo apt-get install --no-install-recommends g++ libx-dev\n");
}

TEST_F(Launcher, SaysHowFarTheBuildIsEvery15SecondsWhereNoTerminalShowsIt) {
  write_script(folder_ / "fakes/ninja",
               "for at in '1/96 2.9' '24/96 30.2' '25/96 44.9' '36/96 45.0' '96/96 150.0'; do\n"
               "  echo \"[${at% *}] ${at#* } s: Building src/a.o\"\n"
               "done\n"
               "echo \"$NINJA_STATUS\" >\"$FAKES/status\"; cp \"$FAKES/program\" \"$2/bin/weft\"\n");
  const Outcome outcome = launch();
  EXPECT_EQ(outcome.status, 7);
  EXPECT_EQ(read_bytes(folder_ / "fakes/status"), "[%f/%t] %e s: \n");
  // After 24 files in 30 s, the other 72 take 90 s more. After 36 files in 45 s, the other 60 take 75 s more.
  EXPECT_EQ(outcome.err,
            "weft: building\n"
            "weft: 24 of 96 files, about 2 min left\n"
            "weft: 36 of 96 files, about 2 min left\n"
            "weft: 96 of 96 files, about 0 min left\n");
}

TEST_F(Launcher, FailedBuildShowsWhatTheCompilerSaidAndIsTriedAgain) {
  write(folder_ / "fakes/broken", "");
  const Outcome outcome = launch();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "weft: building\nchatter of ninja\nweft: the build failed\n");
  fs::remove(folder_ / "fakes/broken");
  EXPECT_EQ(launch().status, 7);
}

TEST_F(Launcher, TwoAtOnceBuildOnce) {
  std::thread other([&] { std::system((command("") + " >/dev/null 2>&1").c_str()); });
  const Outcome outcome = launch();
  other.join();
  EXPECT_EQ(outcome.status, 7);
  EXPECT_EQ(calls(), "cmake ninja ");
}

TEST_F(Launcher, SignalsReachTheProgram) {
  write_script(folder_ / "fakes/program",
               "trap 'exit 75' TERM; touch \"$FAKES/started\"; while [ -e \"$FAKES/started\" ]; do sleep 0.01; done\n");
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", command("2>/dev/null").c_str(), nullptr);
    ::_exit(127);
  }
  while (!fs::exists(folder_ / "fakes/started")) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ::kill(child, SIGTERM);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 75);
}

}  // namespace
}  // namespace weft
