#include "film/render/gl/shared_library.hpp"

#include <gtest/gtest.h>

#include "support/test_folder.hpp"

namespace weft::render {
namespace {

TEST(SharedLibraries, ThatAreMissingAreAUsageError) {
  support::expect_error(ExitCode::usage, "libweft_nowhere.so.1: cannot be opened",
                        [] { SharedLibrary library("libweft_nowhere.so.1"); });
}

}  // namespace
}  // namespace weft::render
