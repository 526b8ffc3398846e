// OpenImageIO's idiff as independent reference: the same pixel counts and the same verdicts.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <regex>

#include "compare/pictures.hpp"
#include "film/image/png.hpp"
#include "support/test_folder.hpp"
#include "tools/compare/files.hpp"

namespace weft::compare {
namespace {

struct IdiffResult {
  bool passed = false;
  std::int64_t pixels_over = 0;
};

class Idiff : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    // The shell returns 127 if it does not find the program.
    const int status = std::system("idiff --version >/dev/null 2>&1");
    if (WEXITSTATUS(status) == 127) GTEST_SKIP() << "idiff is not here: apt-get install openimageio-tools";
  }

  // The threshold is half a level above the tolerance, so that floating-point rounding does not matter. idiff warns
  // about any pixel above the threshold (exit code 1), so that it prints the count even if the pictures pass.
  IdiffResult run_idiff(int tolerance, double budget) const {
    const std::string command =
        fmt::format("idiff -warn {0:.9f} -warnpercent 0 -fail {0:.9f} -failpercent {1:.9f} '{2}' '{3}' 2>&1",
                    (tolerance + 0.5) / 255, 100 * budget, (folder_ / "a.png").string(), (folder_ / "b.png").string());
    IdiffResult answer;
    std::string text;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    EXPECT_NE(pipe, nullptr);
    for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    const int code = WEXITSTATUS(::pclose(pipe));
    EXPECT_LE(code, 2) << text;
    answer.passed = code < 2;
    // idiff prints "  34811 pixels (60.4%) over 0.0177" for warnings and again for failures, if there are any.
    const std::regex line(R"((\d+) pixels \()");
    std::smatch match;
    for (; std::regex_search(text, match, line); text = match.suffix()) answer.pixels_over = std::stoll(match[1]);
    return answer;
  }

  // Each call of idiff takes about 0.5 CPU s.
  void expect_same(const image::Image& a, const image::Image& b, std::initializer_list<int> tolerances = {4}) const {
    image::write_png(folder_ / "a.png", a);
    image::write_png(folder_ / "b.png", b);
    for (const int tolerance : tolerances) {
      constexpr double kBudget = 0.0125;
      const FileComparison result = compare_files(folder_ / "a.png", folder_ / "b.png", {tolerance, kBudget, 1});
      const IdiffResult answer = run_idiff(tolerance, kBudget);
      EXPECT_EQ(answer.passed, result.good()) << tolerance;
      EXPECT_EQ(answer.pixels_over, result.worst.figures.pixels_over) << tolerance;
    }
  }
};

TEST_F(Idiff, AgreesOnNoiseOfEveryAmount) {
  const image::Image picture = textured(80, 60, 1);
  expect_same(picture, picture, {0});
  for (const int count : {1, 900}) expect_same(picture, with_noise(picture, count, 6, 11));
  expect_same(picture, with_noise(picture, 60, 6, 11), {0, 4});
  expect_same(picture, with_noise(picture, 60, 80, 11));
}

TEST_F(Idiff, AgreesAtTheToleranceAndAtTheBudget) {
  const image::Image picture = plain(80, 60, 100, 100, 100);
  image::Image changed = picture;
  // The budget is 60 of 4800 pixels. In this picture, 30 pixels are at the tolerance and 30 one level beyond it; in the
  // next, 60 are beyond it, in the last 61.
  for (int x = 0; x < 60; ++x) changed.pixel(x, 7)[x % 3] = static_cast<std::uint8_t>(x < 30 ? 104 : 95);
  expect_same(picture, changed);
  for (int x = 0; x < 60; ++x) changed.pixel(x, 7)[x % 3] = 95;
  expect_same(picture, changed);
  changed.pixel(70, 50)[0] = 95;
  expect_same(picture, changed);
}

TEST_F(Idiff, AgreesOnOtherPictures) {
  expect_same(textured(80, 60, 1), textured(80, 60, 2));
  expect_same(textured(80, 60, 1), plain(80, 60, 255, 0, 128));
}

}  // namespace
}  // namespace weft::compare
