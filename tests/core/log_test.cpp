// Tests handlers of messages, and the escaping of control characters for terminals.
#include "core/log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft::log {
namespace {

// A handler may log, or wait for a lock whose holder logs; neither may cause a deadlock.
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

TEST(Log, EscapesWhatTerminalsInterpret) {
  EXPECT_EQ(without_controls("a\x1b[2J\x7f\n\tb"), "a\\x1b[2J\\x7f\n\tb");
  EXPECT_EQ(without_controls("a\n\tb", ""), "a\\x0a\\x09b");
  // U+009B begins a command, as ESC [ does. U+00A0, é and half a character are no control characters.
  EXPECT_EQ(without_controls("\xC2\x9B 2J \xC2\x85 \xC2\xA0 \xC3\xA9 \xC2"),
            "\\xc2\\x9b 2J \\xc2\\x85 \xC2\xA0 \xC3\xA9 \xC2");
}

// A program with a window has no use for standard error, so its handler receives information too.
TEST(Log, HandlerGetsInformationToo) {
  std::string got;
  set_handler([&](std::string_view text) { got = text; });
  ::testing::internal::CaptureStderr();
  info("lifted bodies");
  set_handler({});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(got, "lifted bodies");
}

}  // namespace
}  // namespace weft::log
