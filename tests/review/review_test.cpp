#include "tools/review/review.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "review/made_runs.hpp"

namespace weft::review {
namespace {

namespace fs = std::filesystem;

class Review : public MadeRuns {
 protected:
  void SetUp() override {
    MadeRuns::SetUp();
    write_video("in/a.mp4", 2);
    write("in/a.json", statistics("a.mp4"));
    write("in/a.effective.toml", "a = 1\n");
  }

  Request request() const {
    Request request;
    request.folders = {folder_ / "in"};
    request.output = folder_ / "page";
    return request;
  }

  // Content of the page's script element.
  Json data() const {
    const std::string html = support::read_bytes(folder_ / "page/index.html"), mark = "id=\"review-data\">";
    const std::size_t begin = html.find(mark) + mark.size();
    return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  }
};

TEST(PageHtml, NoTextOfARunCanEndTheScriptOrBeginAnotherOne) {
  const std::string name = "</script><script>alert(1)</script><!-- & \" ' \\ \u2028";
  const std::string html = page_html("{{version}}<script>{{data}}</script>", {{"name", name}});
  const std::size_t begin = html.find("<script>") + 8, end = html.find("</script>");
  EXPECT_EQ(html.find('<', begin), end);
  EXPECT_EQ(html.size(), end + 9);
  EXPECT_EQ(Json::parse(html.substr(begin, end - begin)).at("name"), name);
}

TEST(PageHtml, MarksWithinTheDataStayText) {
  const std::string html = page_html("{{version}}|{{data}}", {{"name", "{{data}}{{version}}"}});
  EXPECT_EQ(html.substr(html.find('|')), "|{\"name\":\"{{data}}{{version}}\"}");
}

TEST(PageHtml, BrokenUtf8IsReplaced) {
  const std::string html = page_html("{{version}}|{{data}}", {{"name", "a\xff"}});
  EXPECT_EQ(html.substr(html.find('|')), "|{\"name\":\"a\ufffd\"}");
}

TEST_F(Review, PageHoldsTheRunAndItsFiles) {
  const Outcome outcome = write_review(request());
  EXPECT_EQ(outcome.page, folder_ / "page/index.html");
  EXPECT_EQ(outcome.runs, 1);
  const Json run = data().at("runs").at(0);
  EXPECT_EQ(run.at("name"), "a");
  EXPECT_EQ(run.at("id"), "runs/a");
  EXPECT_EQ(run.at("pictures").at("files"), Json::parse(R"(["runs/a/video.mp4"])"));
  EXPECT_EQ(run.at("problems"), Json::array());
  EXPECT_EQ(support::read_bytes(folder_ / "page/runs/a/video.mp4"), support::read_bytes(folder_ / "in/a.mp4"));
  EXPECT_EQ(support::read_bytes(folder_ / "page/runs/a/scene.toml"), "a = 1\n");
  EXPECT_EQ(support::read_bytes(folder_ / "page/runs/a/stats.json"), statistics("a.mp4"));
  EXPECT_TRUE(is_review_page(folder_ / "page"));
}

TEST_F(Review, WhatOnlyThePageOfARunShowsIsAFileOfItsOwn) {
  write_review(request());
  const Json run = data().at("runs").at(0);
  EXPECT_FALSE(run.contains("columns") || run.contains("effective"));
  EXPECT_EQ(run.at("digest").at("frame").at("count"), 2);
  const std::string detail = support::read_bytes(folder_ / "page/runs/a/data.js"), begin = "review.loaded(\"runs/a\", ";
  ASSERT_TRUE(detail.starts_with(begin)) << detail;
  const Json loaded = Json::parse(detail.substr(begin.size(), detail.rfind(");") - begin.size()));
  EXPECT_EQ(loaded.at("columns").at("frame"), Json::parse("[0, 1]"));
  EXPECT_EQ(loaded.at("effective").at("values").at("a"), "1");
}

TEST_F(Review, DecisionsCountAsLongAsThePicturesAreTheSame) {
  const auto decide = [&](const std::string& state, const std::string& of) {
    write("in/review.json",
          fmt::format(R"({{"format": "weft review 1", "runs": {{"a": {{"state": "{}", "of": "{}"}}}}}})", state, of));
    Request again = request();
    again.overwrite = true;
    const Outcome outcome = write_review(again);
    return std::pair(outcome.approved, outcome.needing_work);
  };
  EXPECT_EQ(decide("approved", "0000000000000000"), std::pair(0, 0));
  EXPECT_EQ(data().at("runs").at(0).at("decision").at("state"), "approved") << "the page says what has changed";
  const std::string of = data().at("runs").at(0).at("of");
  EXPECT_EQ(decide("approved", of), std::pair(1, 0));
  EXPECT_EQ(decide("needs work", of), std::pair(0, 1));
  EXPECT_EQ(decide("open", of), std::pair(0, 0));
  EXPECT_EQ(data().at("runs").at(0).at("key"), "a");
  EXPECT_EQ(data().at("runs").at(0).at("home"), (folder_ / "in").string());
}

TEST_F(Review, NamesWhatMakesARunTheReference) {
  write("in/b_1.png");
  write("in/b_2.png");
  write("in/c.mp4");
  write("ref/a.mp4");
  write("ref/b_1.png");
  write("ref/b_2.png");
  Request with = request();
  with.reference = folder_ / "ref";
  write_review(with);
  const auto accept = [&](int run) { return data().at("runs").at(run).at("accept"); };
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  EXPECT_EQ(accept(0), (Json{{"file", path("in/a.mp4")}, {"reference", path("ref/a.mp4")}}));
  EXPECT_EQ(accept(1), (Json{{"prefix", path("in/b_")}, {"reference", path("ref")}}));
  EXPECT_EQ(accept(2), (Json{{"file", path("in/c.mp4")}, {"reference", path("ref")}}));
}

// Without a file or a prefix, the page would show no command that accepts the pictures of a run.
TEST_F(Review, PicturesNamedByNumbersInTheWorkingFolderCanBeAccepted) {
  for (const int k : {0, 1}) image::write_png(folder_ / fmt::format("{}.png", k), picture(k));
  Request here = request();
  here.folders = {"."};
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  write_review(here);
  fs::current_path(before);
  EXPECT_EQ(data().at("runs").at(1).at("accept"), (Json{{"prefix", "./"}, {"reference", "references"}}));
}

TEST_F(Review, EveryFileThatThePageNamesIsThereAndLocal) {
  write_review(request());
  const std::string html = support::read_bytes(folder_ / "page/index.html");
  int files = 0;
  for (const std::string mark : {" src=\"", " href=\""}) {
    for (std::size_t at = html.find(mark); at != std::string::npos; at = html.find(mark, at + 1)) {
      const std::size_t begin = at + mark.size();
      const std::string name = html.substr(begin, html.find('"', begin) - begin);
      if (name.starts_with('#') || name.starts_with("data:")) continue;
      EXPECT_TRUE(fs::is_regular_file(folder_ / "page" / name)) << name;
      ++files;
    }
  }
  EXPECT_GT(files, 10);
}

TEST_F(Review, NamesOfFilesCannotLeaveThePageOrMeet) {
  write("in/A .mp4");
  write("in/a-.mp4");
  write("in/\xc3\xa4.mp4");
  write_review(request());
  const Json page = data();
  std::vector<std::string> ids;
  for (const Json& run : page.at("runs")) ids.push_back(run.at("id"));
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (std::vector<std::string>{"runs/a", "runs/a-2", "runs/a-3", "runs/run"}));
}

TEST_F(Review, RunsOfSeveralFoldersAreNamedWithThem) {
  write("other/a.mp4");
  Request both = request();
  both.folders.push_back(folder_ / "other/");
  write_review(both);
  EXPECT_EQ(data().at("runs").at(0).at("name"), "in/a");
  EXPECT_EQ(data().at("runs").at(1).at("name"), "other/a");
}

TEST_F(Review, WorkingFolderAmongSeveralFoldersHasItsOwnName) {
  write("other/a.mp4");
  Request both = request();
  both.folders = {".", "../other"};
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "in");
  const Outcome outcome = write_review(both);
  fs::current_path(before);
  EXPECT_EQ(outcome.runs, 2);
  EXPECT_EQ(data().at("runs").at(0).at("name"), "in/a");
  EXPECT_EQ(data().at("runs").at(1).at("name"), "other/a");
}

TEST_F(Review, RunsOfSeveralFoldersHaveTheReferenceOfTheirPath) {
  write("in/x/b.mp4");
  write("other/y/b.mp4");
  for (const char* reference : {"ref/a.mp4", "ref/x/b.mp4", "ref/y/b.mp4", "ref/other/y/b.mp4"}) write(reference);
  Request both = request();
  both.folders.push_back(folder_ / "other");
  both.reference = folder_ / "ref";
  write_review(both);
  const Json page = data();
  EXPECT_EQ(page.at("runs").at(0).at("reference"), "references/a");
  EXPECT_EQ(page.at("runs").at(1).at("reference"), "references/x-b");
  EXPECT_EQ(page.at("runs").at(2).at("reference"), "references/other-y-b") << "the folder of runs belongs to its name";
}

TEST_F(Review, ReferenceIsTheRunOfTheSamePathElseTheOnlyOneOfItsName) {
  write("in/b.mp4");
  write("in/c/d.mp4");
  write("in/e.mp4");
  write("ref/a.mp4");
  write("ref/x/d.mp4");
  write("ref/y/e.mp4");
  write("ref/z/e.mp4");
  Request with = request();
  with.reference = folder_ / "ref";
  EXPECT_EQ(write_review(with).incomplete, 4);
  const Json page = data();
  EXPECT_EQ(page.at("references").size(), 2u);
  EXPECT_EQ(page.at("runs").at(0).at("reference"), "references/a");
  EXPECT_EQ(page.at("runs").at(2).at("reference"), "references/x-d");
  for (const int without : {1, 3}) {
    const Json& run = page.at("runs").at(without);
    EXPECT_FALSE(run.contains("reference")) << run.at("name");
    EXPECT_NE(run.at("problems").dump().find("no reference of this name"), std::string::npos) << run.at("problems");
  }
  EXPECT_TRUE(fs::exists(folder_ / "page/references/a/video.mp4"));
}

TEST_F(Review, AVideoAndPicturesOfOneNameHaveReferencesOfTheirKind) {
  for (const char* folder : {"in", "ref"})
    for (int k = 0; k < 2; ++k) image::write_png(folder_ / folder / fmt::format("a/{}.png", k), picture(k));
  write_video("ref/a.mp4", 2);
  Request with = request();
  with.reference = folder_ / "ref";
  write_review(with);
  const Json page = data();
  Json kinds;
  for (const Json& reference : page.at("references"))
    kinds[reference.at("id").get<std::string>()] = reference.at("pictures").at("kind");
  ASSERT_EQ(page.at("runs").size(), 2u);
  for (const Json& run : page.at("runs"))
    EXPECT_EQ(kinds[run.at("reference").get<std::string>()], run.at("pictures").at("kind")) << run.at("key");
}

TEST_F(Review, PicturesAreComparedWithThoseOfTheReference) {
  write_video("in/b.mp4", 2);
  write_video("in/c.mp4", 2, 200, 48);
  write_video("ref/a.mp4", 2, 120);
  write_video("ref/b.mp4", 2);
  write_video("ref/c.mp4", 2);
  Request with = request();
  with.reference = folder_ / "ref";
  EXPECT_EQ(write_review(with).differing, 1);
  const Json page = data();
  const Json &a = page.at("runs").at(0), &b = page.at("runs").at(1), &c = page.at("runs").at(2);
  ASSERT_EQ(a.at("comparison").size(), 2u);
  EXPECT_EQ(a.at("comparison").at(1).at("verdict"), "differs");
  const image::Image heat = image::read_png(folder_ / "page" / a.at("comparison").at(1).at("heat").get<std::string>());
  EXPECT_EQ(heat.width, 64);
  ASSERT_EQ(b.at("comparison").size(), 2u);
  EXPECT_EQ(b.at("comparison").at(1).at("verdict"), "same");
  EXPECT_FALSE(b.at("comparison").at(1).contains("heat"));
  EXPECT_EQ(c.at("comparison"), Json::array());
  EXPECT_NE(c.at("problems").dump().find("48x36 pixels, those of the reference 64x36"), std::string::npos) << c;
}

TEST_F(Review, VideoAgainstItsStatistics) {
  write_video("in/a.mp4", 3);
  write_video("in/b.mp4", 5, 200, 64, 30);
  write_review(request());
  const Json page = data();
  EXPECT_EQ(page.at("runs").at(0).at("problems"), Json::parse(R"(["3 pictures can be read, the statistics name 2"])"));
  const Json& pictures = page.at("runs").at(1).at("pictures");
  EXPECT_EQ(pictures.at("count"), 5) << "without statistics, the video tells";
  EXPECT_EQ(pictures.at("fps"), 30);
}

TEST_F(Review, NothingToShowIsRefusedBeforeAnythingIsWritten) {
  Request empty = request();
  fs::create_directories(folder_ / "empty");
  empty.folders = {folder_ / "empty"};
  support::expect_error(ExitCode::asset_unreadable, "found none", [&] { write_review(empty); });
  Request without = request();
  without.reference = folder_ / "nowhere";
  support::expect_error(ExitCode::reference_missing, "nowhere", [&] { write_review(without); });
  EXPECT_EQ(files(), (std::vector<std::string>{"empty", "in"}));
}

TEST_F(Review, FormerPageIsReplacedOnlyOnRequest) {
  write_review(request());
  write("in/b.mp4");
  support::expect_error(ExitCode::output_failed, "--overwrite", [&] { write_review(request()); });
  EXPECT_EQ(data().at("runs").size(), 1u);
  Request again = request();
  again.overwrite = true;
  write_review(again);
  EXPECT_EQ(data().at("runs").size(), 2u);
  EXPECT_EQ(files(), (std::vector<std::string>{"in", "page"}));
}

TEST_F(Review, FolderOfSomethingElseIsNeverReplaced) {
  write("page/thesis.txt");
  Request again = request();
  again.overwrite = true;
  support::expect_error(ExitCode::output_failed, "a former review page", [&] { write_review(again); });
  again.output = folder_ / "in/a.mp4";
  support::expect_error(ExitCode::output_failed, "a former review page", [&] { write_review(again); });
  EXPECT_EQ(support::read_bytes(folder_ / "page/thesis.txt"), "-");
  EXPECT_EQ(files(), (std::vector<std::string>{"in", "page"}));
}

TEST_F(Review, FormerPageIsKeptWithAFileOfSomebodyElseInIt) {
  write_review(request());
  Request again = request();
  again.overwrite = true;
  for (const char* file : {"page/notes.txt", "page/runs/a/mine.png", "page/deep/er/x"}) {
    write(file);
    support::expect_error(ExitCode::output_failed, (folder_ / file).string() + ": is no file of the review page",
                          [&] { write_review(again); });
    EXPECT_EQ(support::read_bytes(folder_ / file), "-");
    fs::remove(folder_ / file);
  }
  // The file appears while the command makes the page.
  again.stop = [&] {
    write("page/notes.txt");
    return false;
  };
  support::expect_error(ExitCode::output_failed, "notes.txt", [&] { write_review(again); });
  EXPECT_EQ(support::read_bytes(folder_ / "page/notes.txt"), "-");
  EXPECT_EQ(data().at("runs").size(), 1u);
}

TEST_F(Review, FolderThatAppearsMeanwhileStays) {
  Request first = request();
  first.stop = [&] {
    write("page/thesis.txt");
    return false;
  };
  support::expect_error(ExitCode::output_failed, "expected a new folder", [&] { write_review(first); });
  EXPECT_EQ(support::read_bytes(folder_ / "page/thesis.txt"), "-");
}

TEST_F(Review, LinksInFoldersOfRunsAreNotFollowed) {
  write("secret.png");
  write("in/q_1.png");
  fs::create_symlink("../secret.png", folder_ / "in/q_2.png");
  fs::create_symlink("../secret.png", folder_ / "in/c.mp4");
  fs::create_symlink("../secret.png", folder_ / "in/c.json");
  write_review(request());
  EXPECT_EQ(data().at("runs").size(), 1u);
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "page"))
    EXPECT_TRUE(!entry.is_regular_file() || support::read_bytes(entry.path()) != "-") << entry.path();
}

// Puts each bad value in every place. The page must name it, and show the valid values and the other runs.
TEST_F(Review, NoValueOfStatisticsKeepsThePageFromTheRest) {
  int k = 0;
  for (const char* value :
       {"null", "7", "-1", "\"x\"", "[]", "{}", "[null]", "{\"x\": null}", "[[]]", "1e308", "1e-310"})
    for (const char* key : {"scene_file", "threads", "cpu", "gl", "exit_code", "message", "warnings", "output", "width",
                            "fps", "objects", "particles", "totals", "peak_memory_bytes", "error", "new"})
      write(fmt::format("odd/{:04}.json", ++k),
            fmt::format(R"({{"scene": "s", "{}": {}, "frames": [{{"frame": {}, "written": {}, "max_strain": {}}}]}})",
                        key, value, value, value, value));
  write("odd/b.json", statistics("b.mp4"));
  Request odd = request();
  odd.folders.push_back(folder_ / "odd");
  EXPECT_EQ(write_review(odd).runs, k + 2);
  const Json page = data();
  for (const Json& run : page.at("runs")) {
    const Json& stats = run.at("stats");
    for (const char* key : {"scene_file", "cpu", "gl", "message", "output"})
      EXPECT_TRUE(!stats.contains(key) || stats[key].is_string()) << run.at("name") << key;
    for (const char* key : {"threads", "exit_code", "width", "fps", "particles", "peak_memory_bytes"})
      EXPECT_TRUE(!stats.contains(key) || stats[key].is_number()) << run.at("name") << key;
    EXPECT_TRUE(!stats.contains("warnings") || stats["warnings"].is_array()) << run.at("name");
  }
  EXPECT_EQ(data().at("runs")[1].at("problems")[0], "0001.json: scene_file: expected a text");
}

TEST_F(Review, EmptyFolderIsTaken) {
  fs::create_directories(folder_ / "page");
  write_review(request());
  EXPECT_EQ(data().at("runs").size(), 1u);
}

TEST_F(Review, FormerPageStaysWhereTheNewOneIsGivenUp) {
  write_review(request());
  Request again = request();
  again.overwrite = true;
  again.stop = [] { return true; };
  support::expect_error(ExitCode::interrupted, "interrupted", [&] { write_review(again); });
  EXPECT_EQ(data().at("runs").size(), 1u);
  EXPECT_EQ(files(), (std::vector<std::string>{"in", "page"}));
}

TEST_F(Review, PageBesideTheRunsIsNoRun) {
  Request within = request();
  within.output = folder_ / "in/page";
  write_review(within);
  within.overwrite = true;
  EXPECT_EQ(write_review(within).runs, 1);
}

}  // namespace
}  // namespace weft::review
