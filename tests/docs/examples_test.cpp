// Runs every example of scenes/README.md unchanged, one test for each section.
#include "docs/examples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "core/input_file.hpp"
#include "docs/markdown.hpp"
#include "support/test_folder.hpp"

namespace weft::docs {
namespace {

namespace fs = std::filesystem;

std::string guide() {
  return read_file(fs::path(WEFT_SOURCE_DIR) / "scenes/README.md");
}

const char* const kMade =
    "## One\n```toml\n# a.toml\nx = 1\n```\n```sh\ncat a.toml\n```\n```text\nx = 1\n```\n"
    "## Two\n```toml\n# b.toml: a.toml, and at its end\ny = 2\n```\n```sh\ncat b.toml\n```\n```text\nx = 1\ny = "
    "2\n```\n"
    "## Three\n```sh\nfalse\ntrue\n```\n"
    "## Four\n```sh\necho b\necho a\n```\n```text\na\nb\n```\n";

class MadeGuide : public support::TestFolder {};

TEST_F(MadeGuide, RunsItsCommandsOnItsScenes) {
  EXPECT_EQ(run_section(kMade, "One", folder_), "");
}

TEST_F(MadeGuide, MakesAScenesOfAnotherAndMore) {
  EXPECT_EQ(run_section(kMade, "Two", folder_), "");
}

TEST_F(MadeGuide, RunsItsScripts) {
  EXPECT_EQ(run_section("## One\n```python\n# a.py\nprint(6 * 7)\n```\n```sh\npython3 a.py\n```\n```text\n42\n```\n",
                        "One", folder_),
            "");
}

TEST_F(MadeGuide, FailsWithTheFirstCommandThatFails) {
  EXPECT_EQ(run_section(kMade, "Three", folder_), "line 25: exit code 1\nfalse\ntrue\n");
}

TEST_F(MadeGuide, FailsWhereSomethingElseIsPrinted) {
  EXPECT_EQ(run_section(kMade, "Four", folder_), "line 34: 'b' was not printed, but\nb\na\n");
}

TEST(MadeBlocks, OfAnotherKindOrWithoutANameAreWrong) {
  EXPECT_EQ(wrong_blocks(kMade), "");
  EXPECT_EQ(wrong_blocks("```toml\n[time]\n```\n"), "1: the first line of a scene names its file: # NAME.toml\n");
  EXPECT_EQ(wrong_blocks("```toml\n# b.toml: a.toml, and at its end\n```\n"), "1: no scene before is named a.toml\n");
  EXPECT_EQ(wrong_blocks("```toml\n# a.toml\n```\n```toml\n# a.toml\n```\n"), "4: a scene before is named a.toml\n");
  EXPECT_EQ(wrong_blocks("```\nx\n```\n"), "1: expected toml, python, sh or text, got ''\n");
  EXPECT_EQ(wrong_blocks("```python\nimport weft\n```\n"), "1: the first line of a script names its file: # NAME.py\n");
  EXPECT_EQ(wrong_blocks("```toml\n# a.toml\n```\n```text\nx\n```\n"), "4: no commands before this text\n");
}

TEST(Guide, HasNoBlockThatIsNotRun) {
  const Page page = read_page(guide());
  EXPECT_EQ(wrong_blocks(guide()), "");
  for (const Fence& fence : page.fences) EXPECT_NE(fence.section, "") << "line " << fence.line;
}

// The test only checks the scenes of README.md with `weft check`, and does not run them.
TEST(Guide, StartsInTheReadmeWithScenesThatAreWell) {
  const fs::path folder = fs::path(::testing::TempDir()) / "weft_readme_scenes";
  fs::create_directories(folder);
  std::string page = read_file(fs::path(WEFT_SOURCE_DIR) / "README.md"), commands = "## Check\n```sh\n";
  ASSERT_FALSE(read_page(page).fences.empty());
  for (const Fence& fence : read_page(page).fences) {
    if (fence.info == "toml") commands += "./weft check " + fence.text.substr(2, fence.text.find('\n') - 2) + "\n";
  }
  EXPECT_EQ(run_section(page + commands + "```\n", "Check", folder), "");
  fs::remove_all(folder);
}

class GuideExamples : public support::TestFolder, public ::testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("weft_guide_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
};

TEST_P(GuideExamples, DoWhatTheySay) {
  EXPECT_EQ(run_section(guide(), GetParam(), folder_), "");
}

// "Pin two corners" -> PinTwoCorners
std::string test_name(const ::testing::TestParamInfo<std::string>& section) {
  std::string name;
  bool begins = true;
  for (const char c : section.param) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter)) name += static_cast<char>(begins ? std::toupper(letter) : letter);
    begins = !std::isalnum(letter);
  }
  return name;
}

// The sections that contain commands.
std::vector<std::string> sections() {
  std::vector<std::string> sections;
  for (const Fence& fence : read_page(guide()).fences) {
    if (fence.text.starts_with("python3 ") && !WEFT_HAS_PYTHON) continue;
    if (fence.info == "sh" && (sections.empty() || sections.back() != fence.section)) sections.push_back(fence.section);
  }
  return sections;
}

INSTANTIATE_TEST_SUITE_P(Of, GuideExamples, ::testing::ValuesIn(sections()), test_name);

}  // namespace
}  // namespace weft::docs
