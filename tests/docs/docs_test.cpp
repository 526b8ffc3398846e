// Checks the documentation against the sources. The first tests use small made-up pages, to show that each check
// detects mistakes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "architecture/source_tree.hpp"
#include "core/input_file.hpp"
#include "core/version.hpp"
#include "docs/generated.hpp"
#include "docs/markdown.hpp"
#include "docs/names.hpp"
#include "support/test_folder.hpp"

namespace weft::docs {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = WEFT_SOURCE_DIR;

// Returns "page: target" for each link to a missing file or heading.
std::string broken_links(const fs::path& root, const fs::path& file) {
  std::string broken;
  for (const std::string& link : read_page(read_file(root / file)).links) {
    if (link.starts_with("https://") || link.starts_with("http://")) continue;
    const auto hash = std::min(link.find('#'), link.size());
    const fs::path target = hash == 0 ? root / file : root / file.parent_path() / link.substr(0, hash);
    bool good = fs::exists(target);
    if (good && hash < link.size()) {
      const auto anchors = read_page(read_file(target)).anchors;
      good = std::find(anchors.begin(), anchors.end(), link.substr(hash + 1)) != anchors.end();
    }
    if (!good) broken += file.string() + ": " + link + "\n";
  }
  return broken;
}

class MadePages : public support::TestFolder {
 protected:
  void write(const fs::path& file, const std::string& text) {
    fs::create_directories((folder_ / file).parent_path());
    support::write_bytes(folder_ / file, text);
  }
};

TEST_F(MadePages, LinksToMissingFilesAndHeadingsAreReported) {
  write("a/b.md", "## Two words, and `code`\n");
  write("README.md", "[x](a/b.md) [y](a/b.md#two-words-and-code) ![z](a/c.png) [u](a/b.md#three) `[v](w)` [w](#no)\n");
  EXPECT_EQ(broken_links(folder_, "README.md"), "README.md: a/c.png\nREADME.md: a/b.md#three\nREADME.md: #no\n");
}

TEST_F(MadePages, NamesThatAreNotInTheSourcesAreReported) {
  for (const char* folder : {"src", "shaders", "scenes", "tests"}) fs::create_directories(folder_ / folder);
  write("src/physics/mesh/ply.cpp", "void write_ply(); struct Ply { void close(); };\n");
  write("tests/mesh/ply_test.cpp",
        "TEST(Ply, IsWritten) {}\nTEST_P(Plys, AreRead) {}\nINSTANTIATE_TEST_SUITE_P(Of, Plys, Values(1));\n"
        "TYPED_TEST(Typed, Holds) {}\n");
  write("README.md",
        "`Ply.IsWritten` `Ply.*Written` `Of/Plys.AreRead` `Of/*` `Typed/*.Holds` `Ply.IsRead` `Plys.IsRead` "
        "`test_mesh_slow` `test_ply` `mesh/ply.cpp` "
        "`ply.cpp` `mesh/obj.cpp` `obj.cpp` `mesh::write_ply` `Ply::close()` `read_ply` `Plate::close` `Obj` `word` `a "
        "= b_c`\n");
  EXPECT_EQ(unknown_names(folder_, "README.md", read_known(folder_)),
            "README.md: Ply.IsRead\nREADME.md: Plys.IsRead\nREADME.md: test_ply\nREADME.md: mesh/obj.cpp\nREADME.md: "
            "obj.cpp\n"
            "README.md: read_ply\nREADME.md: Plate::close\nREADME.md: Obj\n");
}

TEST(MadePage, TablesCutInTwoAndCodeThatNoTestSeesAreReported) {
  EXPECT_EQ(read_page("| a | b \\| c |\n|---|---|\n| 1 | 2 |\n\n```sh\n    x\n```\n").mistakes, "");
  EXPECT_EQ(read_page("| a |\n|---|\n\n| b |\n\n").mistakes, "5: a table of one row\n");
  EXPECT_EQ(read_page("| a |\n| b |\n|---|\n").mistakes, "2: no line below the head\n");
  EXPECT_EQ(read_page("| a |\n|---|\n| b | c |\n").mistakes, "3: 2 cells, 1 in the head\n");
  EXPECT_EQ(read_page("text\n\n    ./weft\n").mistakes, "3: code by indentation: put it between ```\n");
  EXPECT_EQ(read_page("```\n").mistakes, "1: a block of code is not closed\n");
}

TEST(GeneratedParts, AreReplacedAndTheRestIsKept) {
  const std::string page = "a\n<!-- generated: exit codes -->\nold\n<!-- end -->\nb\n";
  const std::string text = regenerated(kRoot, "README.md", page);
  EXPECT_TRUE(
      text.starts_with("a\n<!-- generated: exit codes -->\n\n| exit code | |\n|---|---|\n| 0 | success |\n| 1 | "));
  EXPECT_TRUE(
      text.ends_with("| 75 | Ctrl-C or SIGTERM; finished frames are kept, and `--resume` continues |\n\n"
                     "<!-- end -->\nb\n"));
  EXPECT_THROW(regenerated(kRoot, "README.md", "<!-- generated: nonsense -->\n<!-- end -->\n"), std::runtime_error);
  EXPECT_THROW(regenerated(kRoot, "README.md", "<!-- generated: fabrics -->\n"), std::runtime_error);
}

class MeasuredTables : public MadePages {
 protected:
  std::string page(const std::string& part) {
    return regenerated(folder_, "README.md", "<!-- generated: measured " + part + " -->\n<!-- end -->\n");
  }
};

TEST_F(MeasuredTables, HaveTheirCommandVersionMachineAndDateAbove) {
  const std::string version = kVersion;
  write("a.md", "# `weft x`, table y\n\nweft " + version +
                    " of commit 0123abc, two cores, 2026-11-26\n\n| n | m |\n|---|---|\n| 1 | 2 |\n\nmore\n");
  EXPECT_EQ(page("a.md"), "<!-- generated: measured a.md -->\n\n`weft x`, table y \\\nweft " + version +
                              " of commit 0123abc, two cores, 2026-11-26\n\n| n | m |\n|---|---|\n| 1 | 2 |\n\n"
                              "<!-- end -->\n");
  EXPECT_NE(page("a.md: m").find("\n\n| n | m |\n|---|---|\n| 1 | 2 |\n"), std::string::npos);
  for (const std::string& wrong :
       {"# weft x\n\nweft " + version + " of commit 0123abc, two cores, 2026-11-26\n\n",
        "# `weft x`\n\nweft " + version + " of commit 0123abc, 2026-11-26\n\n",
        "# `weft x`\n\nweft " + version + ", two cores, 2026-11-26\n\n",
        "# `weft x`\n\nweft " + version + " of commit 0123abc, two cores\n\n",
        std::string("# `weft x`\n\nweft 0.0.1 of commit 0123abc, two cores, 2026-11-26\n\n")}) {
    write("b.md", wrong + "| n | m |\n|---|---|\n| 1 | 2 |\n");
    EXPECT_THROW(page("b.md"), std::runtime_error) << wrong;
  }
}

// Returns "LINE: FIRST ROW" for each table that is not generated from a measured file.
std::string written_tables(const std::string& text) {
  std::string found;
  std::istringstream lines(text);
  bool measured = false, in_table = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("<!-- generated: measured ")) measured = true;
    if (line.starts_with("<!-- end -->")) measured = false;
    if (line.starts_with("|") && !in_table && !measured) found += fmt::format("{}: {}\n", number, line);
    in_table = line.starts_with("|");
  }
  return found;
}

TEST(MeasuredPage, TablesWrittenByHandAreReported) {
  EXPECT_EQ(written_tables("<!-- generated: measured a.md -->\n| a |\n|---|\n| b |\n<!-- end -->\n\n| c |\n|---|\n"),
            "7: | c |\n");
}

TEST(MeasuredPage, HasTablesOfNamedCommandsAlone) {
  const std::string text = read_file(kRoot / "tests/bench/README.md");
  EXPECT_EQ(written_tables(text), "");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 350);
}

// A measured file that no page shows could become out of date unnoticed.
TEST(MeasuredPage, ShowsOrLinksEachMeasuredFile) {
  const std::string text = read_file(kRoot / "tests/bench/README.md");
  for (const auto& entry : fs::directory_iterator(kRoot / "tests/bench/measured")) {
    const std::string file = "measured/" + entry.path().filename().string();
    EXPECT_NE(text.find(file), std::string::npos) << file;
    EXPECT_NO_THROW(
        regenerated(kRoot, "tests/bench/README.md", "<!-- generated: measured " + file + " -->\n<!-- end -->\n"))
        << file << " has no command, version, machine or date";
  }
}

TEST(Documentation, IsAsNinjaDocsPrintsIt) {
  for (const fs::path& file : pages(kRoot)) {
    const std::string text = read_file(kRoot / file);
    EXPECT_EQ(text, regenerated(kRoot, file, text)) << file << " is out of date: ninja -C build docs";
  }
}

TEST(Documentation, LinksToWhatIsThere) {
  for (const fs::path& file : pages(kRoot)) EXPECT_EQ(broken_links(kRoot, file), "");
}

TEST(Documentation, NamesWhatIsThere) {
  const Known known = read_known(kRoot);
  ASSERT_GT(known.tests.size(), 900u);
  for (const fs::path& file : pages(kRoot)) EXPECT_EQ(unknown_names(kRoot, file, known), "");
}

TEST(Documentation, HasWholeTables) {
  for (const fs::path& file : pages(kRoot)) EXPECT_EQ(read_page(read_file(kRoot / file)).mistakes, "") << file;
}

TEST(Documentation, StartsWithAReadmeOf200Lines) {
  const std::string text = read_file(kRoot / "README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 200);
}

TEST(Documentation, OfEachModuleIsLinkedFromTheReadme) {
  const auto links = read_page(read_file(kRoot / "README.md")).links;
  for (const fs::path& file : pages(kRoot)) {
    const bool of_a_module = *file.begin() == "src" && std::distance(file.begin(), file.end()) <= 4;
    EXPECT_TRUE(!of_a_module || std::find(links.begin(), links.end(), file) != links.end()) << file;
  }
}

// The page of a module has at most 80 lines. That of collision, which consists of three modules, may have 140.
TEST(Documentation, OfAModuleFitsAScreen) {
  for (const architecture::Module& module : architecture::read_modules(kRoot)) {
    const fs::path page = kRoot / "src" / module.folder() / "README.md";
    if (!fs::exists(page)) continue;
    const std::string text = read_file(page);
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), module.name == "collision" ? 140 : 80) << page;
  }
}

}  // namespace
}  // namespace weft::docs
