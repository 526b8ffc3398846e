// Handlers of warnings.
#include "core/log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft::log {
namespace {

// A handler may log, or wait for a lock whose holder logs: neither may deadlock.
TEST(Log, HandlerMayLogItself) {
  std::vector<std::string> texts;
  set_handler([&](std::string_view text) {
    texts.emplace_back(text);
    if (texts.size() == 1) note("of the handler");
  });
  warn("of another");
  set_handler({});
  EXPECT_EQ(texts, (std::vector<std::string>{"of another", "of the handler"}));
}

}  // namespace
}  // namespace weft::log
