#include "core/json.hpp"

#include <gtest/gtest.h>

#include <string>

namespace weft {
namespace {

TEST(JsonValue, BeyondTheRangeOfIntIsReplaced) {
  const auto read = [](const std::string& number) { return value_or(parse_json("{\"k\": " + number + "}"), "k", 7); };
  for (const int number : {0, -1, 2147483647, -2147483647 - 1}) EXPECT_EQ(read(std::to_string(number)), number);
  for (const char* number : {"2147483648", "-2147483649", "9223372036854775808", "18446744073709551615", "1.0", "true"})
    EXPECT_EQ(read(number), 7) << number;
  EXPECT_EQ(value_or(nlohmann::json{{"k", -3}}, "k", 7), -3);
}

}  // namespace
}  // namespace weft
