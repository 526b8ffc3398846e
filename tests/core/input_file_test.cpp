#include "core/input_file.hpp"

#include <sys/stat.h>

#include "support/test_folder.hpp"

namespace weft {
namespace {

namespace fs = std::filesystem;
using support::expect_error;
using InputFileTest = support::TestFolder;

TEST_F(InputFileTest, GivesAllBytesOfARegularFileAndOfALinkToOne) {
  const std::string bytes("a\0b\nc", 5);
  support::write_bytes(folder_ / "a", bytes);
  support::write_bytes(folder_ / "empty", "");
  fs::create_symlink("a", folder_ / "link");
  EXPECT_EQ(read_file(folder_ / "a"), bytes);
  EXPECT_EQ(read_file(folder_ / "link"), bytes);
  EXPECT_EQ(read_file(folder_ / "empty"), "");
  EXPECT_EQ(read_file(folder_ / "a", 5), bytes);
  EXPECT_EQ(read_start(folder_ / "a", 2), bytes.substr(0, 2));
  EXPECT_EQ(read_start(folder_ / "a", 100), bytes);
  EXPECT_EQ(read_end(folder_ / "a", 2), bytes.substr(3));
  EXPECT_EQ(read_end(folder_ / "a", 100), bytes);
  EXPECT_NO_THROW(check_is_file(folder_ / "link"));
}

// If these files were opened and read, the program would wait without end, or read without end.
TEST_F(InputFileTest, WhatIsNoRegularFileIsRefusedAtOnceByName) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0666), 0);
  fs::create_symlink("pipe", folder_ / "link");
  for (const fs::path& file : {folder_ / "pipe", folder_ / "link", fs::path("/dev/zero"), fs::path("/dev/full")}) {
    expect_error(ExitCode::asset_unreadable, file.string() + ": cannot be read: expected a file, got a device or pipe",
                 [&] { read_file(file); });
    EXPECT_EQ(read_start(file, 10), "") << file;
    EXPECT_EQ(read_end(file, 10), "") << file;
    EXPECT_THROW(check_is_file(file), std::runtime_error) << file;
  }
  expect_error(ExitCode::asset_unreadable, "expected a file, got a folder", [&] { read_file(folder_); });
}

TEST_F(InputFileTest, WhatCannotBeReadSaysWhy) {
  support::write_bytes(folder_ / "a", "12345");
  expect_error(ExitCode::asset_unreadable, (folder_ / "no").string() + ": cannot be read: No such file or directory",
               [&] { read_file(folder_ / "no"); });
  expect_error(ExitCode::asset_unreadable, "expected at most 4 bytes, got 5", [&] { read_file(folder_ / "a", 4); });
  expect_error(ExitCode::asset_unreadable, "File name too long", [&] { read_file(folder_ / std::string(5000, 'x')); });
#ifndef __SANITIZE_ADDRESS__                                // the sanitizer ends the process instead
  fs::resize_file(folder_ / "a", std::uintmax_t{1} << 42);  // a sparse file: no disk blocks
  expect_error(ExitCode::asset_unreadable, "bytes are too many for the memory", [&] { read_file(folder_ / "a"); });
#endif
}

TEST_F(InputFileTest, WhateverAReaderThrowsBecomesTheMistakeOfItsFile) {
  const auto read = [](const auto& exception) { read_checked("f.x", [&]() -> int { throw exception; }); };
  expect_error(ExitCode::asset_unreadable, "f.x: broken: odd", [&] { read(std::logic_error("odd")); });
  expect_error(ExitCode::asset_unreadable, "f.x: too large for the memory", [&] { read(std::bad_alloc()); });
  expect_error(ExitCode::usage, "as it was", [&] { read(Error(ExitCode::usage, "as it was")); });
  EXPECT_EQ(read_checked("f.x", [] { return 7; }), 7);
}

}  // namespace
}  // namespace weft
