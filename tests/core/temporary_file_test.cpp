#include "core/temporary_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "core/error.hpp"
#include "support/test_folder.hpp"

namespace weft {
namespace {

namespace fs = std::filesystem;
using support::expect_error;

class TemporaryFileTest : public support::TestFolder {
 protected:
  static std::string content(const fs::path& file) { return support::read_bytes(file); }
  std::size_t entries() const { return files().size(); }
};

TEST_F(TemporaryFileTest, NothingAppearsUnderTheFinalNameBeforeCommit) {
  const fs::path file = folder_ / "deep" / "a.txt";
  TemporaryFile temporary(file);
  std::ofstream(temporary.path()) << "half";
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(temporary.path().parent_path(), folder_ / "deep");
  temporary.commit();
  EXPECT_EQ(content(file), "half");
}

TEST_F(TemporaryFileTest, FoldersAndDevicesAreNeverReplaced) {
  for (const fs::path& name : {folder_, folder_ / "", fs::path("/dev/null")})
    expect_error(ExitCode::output_failed,
                 name.string() + ": expected the name of a file to write, got a folder or a device",
                 [&] { TemporaryFile temporary(name); });
}

TEST_F(TemporaryFileTest, LeavesNothingBehindWithoutCommit) {
  {
    TemporaryFile temporary(folder_ / "a.txt");
    std::ofstream(temporary.path()) << "half";
    EXPECT_EQ(entries(), 1u);
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(TemporaryFileTest, LeavesNothingBehindWhereNoDescriptorIsLeft) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  {
    const TemporaryFile temporary(folder_ / "a.txt");
    const rlimit none{0, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(entries(), 0u);
}

TEST_F(TemporaryFileTest, TheSignalHandlersSweepRemovesWhatIsOpenAndKeepsWhatIsWhole) {
  write_file(folder_ / "whole.txt", "whole");
  TemporaryFile temporary(folder_ / "half.txt");
  std::ofstream(temporary.path()) << "half";
  remove_temporary_files();
  EXPECT_EQ(entries(), 1u);
  EXPECT_EQ(content(folder_ / "whole.txt"), "whole");
}

TEST_F(TemporaryFileTest, ReplacesAnOlderFileInOneGo) {
  write_file(folder_ / "a.txt", "old");
  write_file(folder_ / "a.txt", "new");
  EXPECT_EQ(content(folder_ / "a.txt"), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(TemporaryFileTest, AFileThatSomebodyMakesMeanwhileStays) {
  const fs::path file = folder_ / "a.txt";
  protect_missing_file(file);
  EXPECT_FALSE(may_replace(folder_ / "sub" / ".." / "a.txt")) << "the same by another name";
  {
    TemporaryFile temporary(file);
    std::ofstream(temporary.path()) << "new";
    std::ofstream(file) << "precious";
    expect_error(ExitCode::output_failed,
                 file.string() +
                     ": was made by somebody else while this command worked, and is kept; give --overwrite "
                     "to replace it, or another name",
                 [&] { temporary.commit(); });
  }
  EXPECT_EQ(content(file), "precious");
  EXPECT_EQ(entries(), 1u) << "nothing half is left";
  EXPECT_THROW(write_file(file, "new"), Error);
  EXPECT_NO_THROW(write_file(file, "precious")) << "nothing is lost where it holds the same";
  fs::remove(file);
  // A process may replace files that it has written itself.
  write_file(file, "first");
  write_file(file, "second");
  EXPECT_EQ(content(file), "second");
}

TEST_F(TemporaryFileTest, AFolderThatWasRemovedIsNotMadeAnew) {
  const fs::path folder = folder_ / "frames";
  write_file(folder / "1.txt", "1");
  fs::remove_all(folder);
  expect_error(ExitCode::output_failed, (folder / "2.txt").string() + ": cannot be written: No such file or directory",
               [&] { write_file(folder / "2.txt", "2"); });
  EXPECT_EQ(entries(), 0u);
}

TEST_F(TemporaryFileTest, SaysWhyAFolderCannotBeMade) {
  write_file(folder_ / "plain", "");
  const fs::path file = folder_ / "plain" / "a.txt";
  expect_error(ExitCode::output_failed, file.string() + ": cannot make the folder: Not a directory",
               [&] { write_file(file, "x"); });
}

TEST_F(TemporaryFileTest, SaysWhyADiskCannotTakeTheData) {
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
  std::string message;
  try {
    write_file(folder_ / "a.txt", "x");
  } catch (const Error& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(message, (folder_ / "a.txt").string() + ": cannot be written: File too large");
  EXPECT_EQ(entries(), 0u);
}

TEST_F(TemporaryFileTest, OfAKilledProcessIsRemovedByTheNextThatWritesThere) {
  const pid_t child = ::fork();
  if (child == 0) {
    const TemporaryFile half(folder_ / "a.txt");
    const TemporaryName half_folder(folder_ / "page", TemporaryName::Kind::folder);
    std::ofstream(half_folder.path() / "index.html") << "half";
    ::raise(SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ASSERT_EQ(entries(), 2u);
  std::ofstream(folder_ / ".notes.weft-12.txt") << "precious";
  std::ofstream(folder_ / ".a.txt.weft-.tmp") << "precious";
  std::ofstream(folder_ / "a.weft-12.tmp") << "precious";
  std::ofstream(folder_ / ".a.txt.weft-1x2.tmp") << "precious";
  write_file(folder_ / "b.txt", "whole");
  EXPECT_EQ(entries(), 5u) << "b.txt and what only looks like a temporary name";
}

TEST_F(TemporaryFileTest, OfALivingProcessStays) {
  std::array<int, 2> ready{}, done{};
  ASSERT_EQ(::pipe(ready.data()) | ::pipe(done.data()), 0);
  const pid_t child = ::fork();
  char byte = 0;
  if (child == 0) {
    ::close(done[1]);
    TemporaryFile file(folder_ / "a.txt");
    std::ofstream(file.path()) << "whole";
    if (::write(ready[1], "x", 1) == 1 && ::read(done[0], &byte, 1) == 0) file.commit();
    ::_exit(0);
  }
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  write_file(folder_ / "b.txt", "other");
  EXPECT_EQ(entries(), 2u) << "the temporary file of a living process is gone";
  ::close(done[0]);
  ::close(done[1]);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(content(folder_ / "a.txt"), "whole");
}

// A process that removes old temporary files may lock one that was just made, and may be interrupted before it removes
// this file. The writer must wait for it.
TEST_F(TemporaryFileTest, WaitsForAProcessThatCleansUp) {
  const fs::path temporary = folder_ / fmt::format(".a.txt.weft-{}.tmp", ::getpid());
  const int descriptor = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
  std::thread cleaner([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::unlink(temporary.c_str());
    ::close(descriptor);
  });
  EXPECT_NO_THROW(write_file(folder_ / "a.txt", "whole"));
  cleaner.join();
  EXPECT_EQ(content(folder_ / "a.txt"), "whole");
}

TEST_F(TemporaryFileTest, NamesMayBeAsLongAsTheFileSystemAllows) {
  for (const std::size_t size : {230, 244, 255}) {
    write_file(folder_ / std::string(size, 'a'), "whole");
    EXPECT_EQ(content(folder_ / std::string(size, 'a')), "whole") << size;
  }
  EXPECT_EQ(entries(), 3u);
  const fs::path one = folder_ / std::string(255, 'b'), other = folder_ / (std::string(254, 'b') + "c");
  const TemporaryFile first(one), second(other);
  EXPECT_FALSE(final_name_of(first.path().filename().string()).empty()) << first.path();
  EXPECT_THROW(TemporaryFile again(one), Error);
  expect_error(ExitCode::output_failed, "File name too long",
               [&] { write_file(folder_ / std::string(256, 'a'), "whole"); });
}

TEST_F(TemporaryFileTest, IsOneForEachFinalNameAtATime) {
  const TemporaryFile first(folder_ / "a.txt");
  EXPECT_THROW(TemporaryFile(folder_ / "a.txt"), Error);
}

}  // namespace
}  // namespace weft
