// Who takes warnings over.
#include "core/log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft::log {
namespace {

// A handler that waits for a lock whose holder logs would else wait for ever; one that logs is such a case.
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
