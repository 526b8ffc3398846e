// Archives of the program for farms: which archives are accepted or refused, and tasks that unpack and run one.
#include "tools/cli/program_archive.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <fstream>
#include <utility>

#include "cli/cached_run.hpp"
#include "core/error.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

struct Entry {
  std::string name, content;
  char type = '0';  // ustar type flag: regular file
};

std::string tar_of(const std::vector<Entry>& entries) {
  std::string tar;
  for (const Entry& entry : entries) {
    std::string header(512, '\0');
    const auto put = [&](std::size_t at, const std::string& text) { header.replace(at, text.size(), text); };
    put(0, entry.name);
    put(100, "0000755");
    put(108, "0000000");
    put(116, "0000000");
    put(124, fmt::format("{:011o}", entry.content.size()));
    put(136, "00000000000");
    put(148, "        ");
    put(156, {entry.type});
    put(257, "ustar");
    put(263, "00");
    unsigned sum = 0;
    for (const char c : header) sum += static_cast<unsigned char>(c);
    put(148, fmt::format("{:06o}", sum));
    header[154] = '\0';
    tar += header + entry.content + std::string((512 - entry.content.size() % 512) % 512, '\0');
  }
  return tar + std::string(1024, '\0');
}

std::string compressed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

/// An archive whose program prints `message` and then executes the built program.
std::vector<Entry> program(const std::string& message) {
  const std::string script = "#!/bin/sh\necho '" + message + "' >&2\nexec '" WEFT_PROGRAM "' \"$@\"\n";
  return {{"weft/", "", '5'},
          {"weft/bin/weft", script},
          {"weft/bin/weft-tools", script},
          {"weft/libexec/weft", "x"},
          {"weft/libexec/weft-tools", "x"}};
}

class ProgramArchives : public CachedRun {
 protected:
  void refuse(const std::string& bytes, const std::string& words) const {
    support::write_bytes(folder_ / "a.tar.zst", bytes);
    support::expect_error(ExitCode::asset_unreadable, words, [&] { ProgramArchive archive(folder_ / "a.tar.zst"); });
  }
  void refuse_with(Entry more, const std::string& words) const {
    std::vector<Entry> entries = program("");
    entries.push_back(std::move(more));
    refuse(compressed(tar_of(entries)), words);
  }
};

TEST_F(ProgramArchives, OfAnyOtherKindAreRefused) {
  const std::string good = compressed(tar_of(program("")));
  support::expect_error(ExitCode::asset_unreadable, "none", [&] { ProgramArchive archive(folder_ / "none"); });
  refuse("", "expected weft-x86_64.tar.zst as ninja bundle makes it, got a file that is cut off");
  refuse("no archive", "got a file that zstd does not decompress");
  refuse(good.substr(0, good.size() / 2), "got a file that is cut off");
  refuse(good + "more", "got a file that zstd does not decompress");
  refuse(compressed("no tar" + std::string(1000, 'x')), "got no tar archive");
  refuse(compressed(tar_of(program("")).substr(0, 1500)), "got a tar archive that is cut off");
  refuse(compressed(tar_of({{"weft/bin/weft", "x"}})), "without weft/bin/weft-tools");
  refuse_with({"weft/../x", "x"}, "with weft/../x, which is outside of the folder weft");
  refuse_with({"/etc/x", "x"}, "with /etc/x, which is outside");
  refuse_with({"weft/link", "", '2'}, "weft/link is neither a file nor a folder");
  std::string size = tar_of(program(""));
  size.replace(512 + 124, 11, "-0000000001");
  refuse(compressed(size), "the size of weft/bin/weft makes no sense");
}

TEST_F(ProgramArchives, AreRefusedBeforeAnythingIsWritten) {
  support::write_bytes(folder_ / "bad.tar.zst", "x");
  const auto submit = [&](const std::string& file, const std::string& action) {
    return run_weft({"farm", action, action == "submit" ? "s.toml" : "f", action == "submit" ? "-of" : "--dry-run",
                     "--program", file, "--dry-run", "--memory", "100", "--time", "10"},
                    folder_);
  };
  EXPECT_EQ(submit("bad.tar.zst", "submit").exit_code, 4);
  EXPECT_EQ(submit("none.tar.zst", "submit").exit_code, 4);
  EXPECT_FALSE(fs::exists(folder_ / "f"));
  EXPECT_EQ(submit("bad.tar.zst", "status").exit_code, 2);
}

TEST_F(ProgramArchives, AreUnpackedOnceAndRunByAllTasks) {
  support::write_bytes(folder_ / "program.tar.zst", compressed(tar_of(program("of the archive"))));
  const auto submit = [&] {
    return run_weft({"farm", "submit", "s.toml", "-o", "a b", "--program", "program.tar.zst", "--size", "64x36",
                     "--quality", "draft", "--part", "30", "--dry-run", "--memory", "100", "--time", "10"},
                    folder_);
  };
  const Outcome outcome = submit();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "submit_task unpack unpack --time=10\n")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "--array=0 --dependency=\"afterok:$unpack\"\n")) << outcome.out;
  const auto programs = [&] {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_ / "a b/farm/program")) found.push_back(entry.path());
    return found;
  };
  ASSERT_EQ(programs().size(), 1u);
  const fs::path tar = programs()[0], unpacked = fs::path(tar).replace_extension();
  EXPECT_EQ(tar.extension(), ".tar");
  // A leftover of another task, which was killed while it unpacked the program.
  fs::create_directories(unpacked.string() + ".new.node.1/weft");

  std::ifstream in(folder_ / "a b/farm/tasks.tsv");
  std::string line;
  std::getline(in, line);
  for (int task = 0; std::getline(in, line); ++task) {
    EXPECT_TRUE(task != 0 || line.starts_with("unpack\t\t")) << line;
    EXPECT_TRUE(task != 1 || line.starts_with("simulate_0\tunpack\t")) << line;
    EXPECT_EQ(std::system(("PATH=/usr/bin:/bin WEFT_PAUSE=0 " + line.substr(line.rfind('\t') + 1)).c_str()), 0) << line;
  }
  EXPECT_EQ(programs(), std::vector<fs::path>{unpacked});
  EXPECT_TRUE(fs::exists(folder_ / "a b/table.csv"));
  for (const char* log : {"simulate_0.log", "draw_0_0.log", "join_0.log", "report.log"})
    EXPECT_TRUE(contains(support::read_bytes(folder_ / "a b/farm/log" / log), "of the archive")) << log;

  for (const auto& entry : fs::directory_iterator(folder_ / "a b"))
    if (entry.is_directory() && entry.path().filename() != "farm") fs::remove_all(entry.path());
  EXPECT_EQ(submit().exit_code, 0);
  EXPECT_EQ(programs(), std::vector<fs::path>{unpacked}) << "it is there already";
  fs::remove_all(unpacked);
  EXPECT_EQ(
      WEXITSTATUS(std::system(("WEFT_PAUSE=0 sh '" + (folder_ / "a b/farm/task.sh").string() + "' unpack").c_str())),
      6);
  const std::string log = support::read_bytes(folder_ / "a b/farm/log/unpack.log");
  EXPECT_TRUE(contains(log, "which cannot be unpacked; weft farm submit writes it anew")) << log;
}

}  // namespace
}  // namespace weft::cli
