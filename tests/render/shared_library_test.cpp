#include "film/render/gl/shared_library.hpp"

#include <gtest/gtest.h>

#include <string_view>

#include "core/error.hpp"

namespace weft::render {
namespace {

TEST(SharedLibraries, ThatAreMissingAreAUsageError) {
  try {
    const SharedLibrary library("libweft_nowhere.so.1");
    FAIL() << "it was opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_TRUE(std::string_view(error.what()).starts_with("libweft_nowhere.so.1: cannot be opened")) << error.what();
  }
}

}  // namespace
}  // namespace weft::render
