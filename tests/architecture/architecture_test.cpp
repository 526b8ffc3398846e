// Checks the source tree against the design. The first tests use small made-up trees, to show that each check detects
// violations.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "architecture/source_tree.hpp"
#include "support/test_folder.hpp"

namespace weft::architecture {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = WEFT_SOURCE_DIR;

// Tables and generated code may exceed the limit.
const std::vector<std::string> kMayBeLong = {};

/// A source tree on disk that contains only the files of a test, and is deleted after the test.
class MadeTree : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    write("src/CMakeLists.txt",
          "weft_module(core LINKS x)\nweft_module(mesh)\n"
          "weft_module(render DOES \"draws (all)\"\n  USES mesh\n  LINKS y)\n");
    write("src/core/error.hpp", "#pragma once\n");
    write("src/mesh/mesh.hpp", "#include \"core/error.hpp\"\n");
    write("src/render/renderer.hpp", "#include <vector>\n#include \"mesh/mesh.hpp\"\n#include \"core/error.hpp\"\n");
  }

  void write(const fs::path& file, const std::string& text) {
    fs::create_directories((folder_ / file).parent_path());
    support::write_bytes(folder_ / file, text);
  }
};

TEST_F(MadeTree, IsWellAtFirst) {
  EXPECT_EQ(wrong_includes(folder_), "");
  EXPECT_EQ(wrong_declarations(folder_), "");
  EXPECT_EQ(long_files(folder_, 3, {}), "");
}

TEST_F(MadeTree, IncludeOfAModuleNotUsedIsReportedWithItsLine) {
  write("src/mesh/ply.cpp", "#include <string>\n\n#include \"render/renderer.hpp\"  // why not\n");
  EXPECT_EQ(wrong_includes(folder_), "src/mesh/ply.cpp:3: mesh does not use render\n");
}

TEST_F(MadeTree, InterfaceIncludesTheStandardLibraryAloneAndIsOfItsModule) {
  write("src/api/library/include/weft/scene.hpp", "#include <vector>\n#include <weft/scene.hpp>\n");
  write("src/mesh/ply.cpp", "#include <weft/scene.hpp>\n");
  EXPECT_EQ(wrong_includes(folder_),
            "src/api/library/include/weft/scene.hpp:2: no module has include/weft/scene.hpp\n"
            "src/mesh/ply.cpp:1: no module has include/weft/scene.hpp\n");
  write("src/CMakeLists.txt",
        "weft_module(core)\nweft_module(mesh)\nweft_room(api DOES \"others\")\nweft_module(library)\n");
  fs::remove_all(folder_ / "src/render");
  EXPECT_EQ(wrong_includes(folder_), "src/mesh/ply.cpp:1: mesh does not use library\n");
  write("src/mesh/ply.cpp", "\n");
  write("src/api/library/include/weft/scene.hpp", "#include <Eigen/Core>\n#include \"core/error.hpp\"\n");
  EXPECT_EQ(wrong_includes(folder_),
            "src/api/library/include/weft/scene.hpp:1: others cannot include this\n"
            "src/api/library/include/weft/scene.hpp:2: others cannot include this\n");
}

TEST_F(MadeTree, CoreMayUseNoOtherModule) {
  write("src/core/log.cpp", "#include \"mesh/mesh.hpp\"\n");
  EXPECT_EQ(wrong_includes(folder_), "src/core/log.cpp:1: core does not use mesh\n");
}

TEST_F(MadeTree, IncludePastItsOwnFolderIsReported) {
  write("src/mesh/ply.cpp", "#include \"mesh.hpp\"\n");
  EXPECT_EQ(wrong_includes(folder_), "src/mesh/ply.cpp:1: src/mesh.hpp does not exist\n");
}

TEST_F(MadeTree, CycleIsReportedWhereItClosesBackwards) {
  write("src/CMakeLists.txt", "weft_module(core)\nweft_module(mesh USES render)\nweft_module(render USES mesh)\n");
  EXPECT_EQ(wrong_declarations(folder_), "src/CMakeLists.txt: mesh uses render, which is not declared before it\n");
}

TEST_F(MadeTree, FolderThatIsNoModuleIsReported) {
  write("src/utils/misc.hpp", "\n");
  EXPECT_EQ(wrong_declarations(folder_), "src/CMakeLists.txt: src/utils is not declared\n");
}

// The module forces of the room physics includes a header of the room film, which physics does not use; the room film
// uses physics.
TEST_F(MadeTree, ModuleOfARoomUsesOnlyRoomsThatItsOwnUses) {
  const std::string physics =
      "weft_module(core)\nweft_module(mesh)\nweft_room(physics)\nweft_module(forces USES mesh)\n";
  write("src/physics/forces/bend.cpp", "#include \"film/frame/frame.hpp\"\n");
  write("src/film/frame/frame.hpp", "#include \"mesh/mesh.hpp\"\n");
  fs::remove_all(folder_ / "src/render");
  write("src/CMakeLists.txt", physics + "weft_room(film USES physics)\nweft_module(frame USES forces mesh)\n");
  EXPECT_EQ(wrong_declarations(folder_), "");
  EXPECT_EQ(wrong_includes(folder_), "src/physics/forces/bend.cpp:1: forces does not use frame\n");
  write("src/CMakeLists.txt", physics + "weft_room(film)\nweft_module(frame USES forces)\n");
  EXPECT_EQ(wrong_declarations(folder_), "src/CMakeLists.txt: frame uses forces of the room physics\n");
  fs::create_directories(folder_ / "src/film/looks");
  EXPECT_NE(wrong_declarations(folder_).find("src/film/looks is not declared"), std::string::npos);
}

TEST_F(MadeTree, LongFileIsReportedUnlessListed) {
  write("src/mesh/table.cpp", "1\n2\n3\n4\n");
  EXPECT_EQ(long_files(folder_, 3, {}), "src/mesh/table.cpp: 4 lines, more than 3\n");
  EXPECT_EQ(long_files(folder_, 3, {"src/mesh/table.cpp"}), "");
  EXPECT_EQ(long_files(folder_, 4, {"src/mesh/table.cpp"}), "src/mesh/table.cpp: needs no exemption\n");
}

TEST_F(MadeTree, WordsAreFoundInEveryKindOfFileButNotInsideOtherWords) {
  write("shaders/cloth.frag", "// LATER\n");
  write("run", "echo LATERAL; exec /elsewhere/bin/x\n");
  EXPECT_EQ(lines_with(folder_, {"LATER", "/elsewhere/"}), "run:1: /elsewhere/\nshaders/cloth.frag:1: LATER\n");
}

TEST(Architecture, ModulesAreReadWithWhatTheyUse) {
  const auto modules = read_modules(kRoot);
  ASSERT_GT(modules.size(), 2u);
  EXPECT_EQ(modules.front().name, "core");
  EXPECT_TRUE(modules.front().uses.empty());
  for (const Module& module : modules) EXPECT_FALSE(module.does.empty()) << module.name;
}

TEST(Architecture, ModulesIncludeOnlyWhatTheyUse) {
  EXPECT_EQ(wrong_includes(kRoot), "");
}

TEST(Architecture, ModulesUseOnlyEarlierOnes) {
  EXPECT_EQ(wrong_declarations(kRoot), "");
}

TEST(Architecture, NoFileIsLongerThan500Lines) {
  EXPECT_EQ(long_files(kRoot, 500, kMayBeLong), "");
}

// Only core parses text and opens files from outside, with limits, because parsers are recursive and opening a named
// pipe waits for a writer.
// The forbidden words are assembled here, so that this file does not contain them.
TEST(Architecture, TextAndFilesFromOutsideAreReadByCoreAlone) {
  std::string found;
  std::istringstream lines(
      lines_with(kRoot, {"toml::parse", "toml::parse_file", "json::parse", "Json::parse", "json::accept", "ifstream"}));
  const std::vector<std::string> known{"src/core/", "src/tools/cli/system_info.cpp", "src/film/render/gl/context.cpp"};
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("src/") &&
        std::ranges::none_of(known, [&](const std::string& place) { return line.starts_with(place); }))
      found += line + "\n";
  EXPECT_EQ(found, "");
}

TEST(Architecture, NothingIsLeftForLater) {
  EXPECT_EQ(lines_with(kRoot, {std::string("TO") + "DO", std::string("FIX") + "ME", std::string("XX") + "X"}), "");
}

TEST(Architecture, NoPathOfABuildMachineIsWritten) {
  const std::string slash = "/";
  EXPECT_EQ(lines_with(kRoot, {slash + "work/", slash + "home/", slash + "root/", slash + "tmp/"}), "");
}

}  // namespace
}  // namespace weft::architecture
