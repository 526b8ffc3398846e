// Inputs that fuzzing has found, read in every build. tests/fuzz/run searches for more inputs.
#include <gtest/gtest.h>

#include <filesystem>

#include "fuzz/targets.hpp"
#include "support/test_folder.hpp"

namespace weft::fuzz {
namespace {

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadOrRefusedFileByFile) {
  const auto folder = std::filesystem::path(WEFT_SOURCE_DIR "/tests/fuzz/corpus") / GetParam().name;
  ASSERT_TRUE(std::filesystem::is_directory(folder)) << folder;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string bytes = support::read_bytes(entry.path());
    EXPECT_NO_THROW(GetParam().read({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}))
        << entry.path();
    ++files;
  }
  EXPECT_GT(files, 0);
}

TEST_P(Corpus, ReaderAcceptsEmptyInput) {
  EXPECT_NO_THROW(GetParam().read({}));
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace weft::fuzz
