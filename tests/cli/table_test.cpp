#include "tools/cli/table.hpp"

#include <gtest/gtest.h>

namespace weft::cli {
namespace {

TEST(Table, AlignsColumnsAndLeavesNoBlanksAtTheEnd) {
  EXPECT_EQ(format_table({{"a", "1", "x"}, {"long", "22", ""}}, "lr", 2),
            "  a      1  x\n"
            "  long  22\n");
}

TEST(Table, CountsCharactersAndNotBytes) {
  EXPECT_EQ(format_table({{"a\nb", "1"}, {"c", "2"}}), "a\\x0ab  1\nc       2\n");
  EXPECT_EQ(format_table({{"µ·", "1"}, {"ab", "2"}}), "µ·  1\nab  2\n");
}

TEST(Table, TakesRowsOfDifferentLengthAndNoneAtAll) {
  EXPECT_EQ(format_table({{"a"}, {"b", "c"}}), "a\nb  c\n");
  EXPECT_EQ(format_table({}), "");
}

}  // namespace
}  // namespace weft::cli
