#include "core/nearest.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft {
namespace {

TEST(EditDistance, CountsEachKindOfSlipOnce) {
  EXPECT_EQ(edit_distance("render", "render"), 0);
  EXPECT_EQ(edit_distance("rendr", "render"), 1);    // missing letter
  EXPECT_EQ(edit_distance("rrender", "render"), 1);  // doubled letter
  EXPECT_EQ(edit_distance("rander", "render"), 1);   // wrong letter
  EXPECT_EQ(edit_distance("redner", "render"), 1);   // swapped letters
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", ""), 3);
}

TEST(NearestName, FindsWhatWasMeant) {
  const std::vector<std::string> known{"run", "check", "thumbnail", "schema", "doctor"};
  EXPECT_EQ(nearest_name("rnu", known), "run");
  EXPECT_EQ(nearest_name("chekc", known), "check");
  EXPECT_EQ(nearest_name("thumb", known), "thumbnail");
  EXPECT_EQ(nearest_name("shcema", known), "schema");
}

TEST(NearestName, StaysSilentWhereNothingIsClose) {
  const std::vector<std::string> known{"run", "check"};
  EXPECT_EQ(nearest_name("export", known), "");
  EXPECT_EQ(nearest_name("", known), "");
}

}  // namespace
}  // namespace weft
