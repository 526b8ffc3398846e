#include "tools/review/decisions.hpp"

#include <chrono>

#include "review/made_runs.hpp"

namespace weft::review {
namespace {

class DecisionsOfRuns : public MadeRuns {
 protected:
  static std::string file(const std::string& runs) { return R"({"format": "weft review 1", "runs": {)" + runs + "}}"; }
  static std::string entry(const std::string& state) { return R"({"state": ")" + state + R"("})"; }

  // Decision state of the only run below the folder; "none" if it has no entry.
  std::string state() {
    std::vector<RunFiles> runs = find_runs(folder_);
    EXPECT_EQ(runs.size(), 1u);
    const Json found = Decisions().of(runs.front());
    problems_ = Json(runs.front().problems).dump();
    return found.is_null() ? "none" : found.at("state").get<std::string>();
  }

  std::string problems_;
};

TEST_F(DecisionsOfRuns, AreReadFromTheNearestFileThatNamesTheRun) {
  write("stiff/wool/band.mp4");
  EXPECT_EQ(state(), "none");
  write("review.json", file(R"("stiff/wool/band": )" + entry("needs work") + R"(, "band": )" + entry("open")));
  EXPECT_EQ(state(), "needs work");
  write("stiff/review.json", file(R"("wool/other": )" + entry("open")));
  EXPECT_EQ(state(), "needs work") << "the nearer file does not name it";
  write("stiff/review.json", file(R"("wool/band": )" + entry("approved")));
  EXPECT_EQ(state(), "approved");
  write("stiff/wool/review.json", file(R"("band": )" + entry("open")));
  EXPECT_EQ(state(), "open");
  EXPECT_EQ(problems_, "[]");
}

TEST_F(DecisionsOfRuns, OfTheLatestDateCount) {
  const auto dated = [](const std::string& state, const char* date) {
    return R"({"state": ")" + state + R"(", "date": ")" + date + R"("})";
  };
  write("stiff/band.mp4");
  write("stiff/review.json", file(R"("band": )" + dated("needs work", "2026-11-02T08:00:00.000Z")));
  write("review.json", file(R"("stiff/band": )" + dated("approved", "2026-11-02T09:00:00.000Z")));
  EXPECT_EQ(state(), "approved") << "decided on a page of the folder above";
  write("review.json", file(R"("stiff/band": )" + dated("approved", "2026-11-02T07:00:00.000Z")));
  EXPECT_EQ(state(), "needs work");
}

// A page of the folder `stiff` alone offers a file for this folder, with the folder's name as the key.
TEST_F(DecisionsOfRuns, OfPicturesMayLieBesideThem) {
  write("stiff/00000.png");
  write("stiff/00001.png");
  write("stiff/review.json", file(R"("stiff": )" + entry("approved")));
  EXPECT_EQ(state(), "approved");
  std::vector<RunFiles> alone = find_runs(folder_ / "stiff");
  EXPECT_EQ(Decisions().of(alone.at(0)).at("state"), "approved");
}

TEST_F(DecisionsOfRuns, ThatCannotBeUsedAreNamedAndLeftOut) {
  write("band.mp4");
  const auto refused = [&](const std::string& text, const std::string& words) {
    write("review.json", text);
    EXPECT_EQ(state(), "none") << text;
    EXPECT_NE(problems_.find("review.json: " + words), std::string::npos) << problems_;
  };
  refused("words", "expected what the page of weft review offers");
  refused(R"({"runs": {}})", "expected what the page of weft review offers");
  refused(file(R"("band": 1)"), "expected an object");
  refused(file(R"("band": )" + entry("good")), "state: expected open, needs work or approved");
  refused(file(R"("band": {"state": "open", "by": 1})"), "by, date, of: expected texts");
  for (const char* note :
       {"1", R"({"frame": 1})", R"({"frame": "1", "text": ""})", R"({"frame": 1, "text": 1})",
        R"({"frame": 1, "text": "", "marks": [[[0.1]]]})", R"({"frame": 1, "text": "", "marks": [[["0", 1]]]})",
        R"({"frame": 1, "text": "", "by": 1})"})
    refused(file(R"("band": {"state": "open", "notes": [)" + std::string(note) + "]}"), "notes: expected entries");
  write("review.json", file(R"("band": {"state": "open", "notes": [{"frame": 1, "text": "", "marks": [[[0, 1]]]}]})"));
  EXPECT_EQ(state(), "open");
}

TEST_F(DecisionsOfRuns, FingerprintIsThatOfThePicturesAlone) {
  write("a.mp4", "one");
  write("b.mp4", "two");
  write("c.mp4", "one");
  write("c.json", statistics("c.mp4"));
  write("d_1.png", "one");
  write("d_2.png", "two");
  std::vector<std::string> found;
  for (const RunFiles& run : find_runs(folder_)) found.push_back(fingerprint(run));
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0], found[2]);
  EXPECT_NE(found[0], found[1]);
  EXPECT_NE(found[3], found[0]);
  EXPECT_EQ(found[0], "7692c3ad3540bb80") << "printf one | sha256sum | cut -c1-16";
  write("d_2.png", "three");
  EXPECT_NE(fingerprint(find_runs(folder_)[3]), found[3]);
}

TEST_F(DecisionsOfRuns, DateIsThatOfTheVideo) {
  write("a.mp4");
  write("a.json", statistics("a.mp4"));
  const std::chrono::sys_seconds day{std::chrono::hours(25)};
  std::filesystem::last_write_time(folder_ / "a.mp4", std::chrono::file_clock::from_sys(day));
  EXPECT_EQ(date_of(find_runs(folder_).front()), "1970-01-02T01:00:00Z");
  EXPECT_EQ(date_of(RunFiles()), "");
}

}  // namespace
}  // namespace weft::review
