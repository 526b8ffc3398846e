#include "core/nesting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include "core/json.hpp"
#include "core/toml.hpp"

namespace weft {
namespace {

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// Nesting depth below a node, as parsed.
int depth_of(const toml::node& node) {
  int deepest = 0;
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) deepest = std::max(deepest, 1 + depth_of(value));
  } else if (const auto* list = node.as_array()) {
    for (const toml::node& value : *list) deepest = std::max(deepest, 1 + depth_of(value));
  }
  return deepest;
}

/// Texts that nest this many levels, by kind of nesting.
std::map<std::string, std::string> nested(int levels) {
  const int more = levels - 1;
  return {{"dotted", "a" + repeated(".a", more) + " = 1"},
          {"dotted, of numbers and blanks", "1" + repeated(" . 2", more) + " = 1.5"},
          {"dotted, in quotes", "'a'" + repeated(".\"a\"", more) + " = 1"},
          {"ends of keys in quotes",
           repeated("\"a,\".\"#\".'='.\"]\".", more / 4) + "a" + repeated(".a", more % 4) + " = 1"},
          {"quotes in quotes", repeated("\"\\\"#\".'\"'.", more / 2) + "a" + repeated(".a", more % 2) + " = 1"},
          {"empty parts", "\"\"" + repeated(".\"\"", more) + " = 1"},
          {"header", "[a" + repeated(".a", more) + "]"},
          {"list", "a = " + repeated("[", more) + repeated("]", more)},
          {"tables", "a = " + repeated("{a = ", more) + "1" + repeated("}", more)},
          {"tables of dotted keys", "a.b = " + repeated("{a.b = ", more / 2) + "1" + repeated("}", more / 2) +
                                        (more % 2 == 0 ? "" : "\nc.d.e=1")},
          {"behind a comment", "# \"\n# '\n# [\na" + repeated(".a", more) + " = 1"},
          {"behind a string that ends in quotes",
           "x = \"\"\"a\"\"\"\"\"\ny = {b = \"\"\"a\"\"\"\", a" + repeated(".a", more - 1) + " = 1}"},
          {"behind a long literal string", "y = {b = '''\n'a''''', a" + repeated(".a", more - 1) + " = 1}"}};
}

TEST(Nesting, IsRefusedFromTheFirstLevelTooManyInWhateverWayItIsWritten) {
  for (const auto& [kind, text] : nested(kMaxDepth / 2)) EXPECT_NO_THROW(parse_toml(text)) << kind;
  for (const auto& [kind, text] : nested(2 * kMaxDepth)) {
    EXPECT_TRUE(nests_too_deep(text)) << kind;
    EXPECT_THROW(parse_toml(text), toml::parse_error) << kind;
  }
  // These texts would overflow the stack of a parser or of a destructor.
  for (const auto& [kind, text] : nested(200'000)) EXPECT_TRUE(nests_too_deep(text)) << kind;
}

TEST(Nesting, CountsDotsInTextsAndCommentsForNothing) {
  const std::string dots(10 * kMaxDepth, '.');
  for (const std::string& text :
       {"a = \"" + dots + "\"", "a = '" + dots + "'", "a = 1 # " + dots, "a = \"\"\"\n" + dots + "\n\"\"\"",
        "a = [" + repeated("0.5, ", 1000) + "1.5]", repeated("[[a.b]]\nc.d = 1.5\n", 1000)})
    EXPECT_FALSE(nests_too_deep(text)) << text.substr(0, 40);
}

// Random texts of all characters that matter to the grammar. If both the parser and nests_too_deep() accept a text, its
// depth is at most twice the limit, since headers and the keys below them count separately.
TEST(Nesting, NoTextThatTheParserTakesIsDeeperThanTwiceTheLimit) {
  const std::vector<std::string> pieces{
      "a", ".",  ".",  "\"",   "'",       "\"\"\"",           "'''",    "#", "=", "[", "]", "{", "}",
      ",", "\n", "\\", " = 1", "\"a,\".", "a.a.a.a.a.a.a.a.", "b = {a."};
  std::mt19937 random(43);
  int taken = 0, refused = 0;
  for (int trial = 0; trial < 100'000; ++trial) {
    std::string text;
    for (int k = std::uniform_int_distribution(1, 12)(random); k > 0; --k)
      text += pieces[std::uniform_int_distribution<std::size_t>(0, pieces.size() - 1)(random)];
    // Repeats each part of a key twenty times, so that short texts reach the limit.
    for (std::size_t at = 0; (at = text.find("a.", at)) != std::string::npos; at += 40)
      text.replace(at, 2, repeated("a.", 20));
    try {
      const toml::table table = toml::parse(text);
      ++taken;
      EXPECT_TRUE(depth_of(table) <= 2 * kMaxDepth || nests_too_deep(text)) << text;
    } catch (const toml::parse_error&) {
      ++refused;
    }
  }
  EXPECT_GT(taken, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(Nesting, OfJsonIsRefusedAsWell) {
  EXPECT_NO_THROW(parse_json(repeated("[", kMaxDepth) + repeated("]", kMaxDepth)));
  EXPECT_THROW(parse_json(repeated("[", kMaxDepth + 1) + repeated("]", kMaxDepth + 1)), std::runtime_error);
  EXPECT_THROW(parse_json(repeated("{\"a\":[", 200'000)), std::runtime_error);
  EXPECT_NO_THROW(parse_json("[\"" + repeated("[", 1000) + "\", \"\\\"" + repeated("{", 1000) + "\"]"));
  EXPECT_THROW(parse_json("[1e999]"), std::exception);
}

TEST(Nesting, ObjectsOfMoreKeysThanCanBeComparedAreRefused) {
  const auto object = [](int keys) {
    std::string text = "{";
    for (int k = 0; k < keys; ++k) text += (k > 0 ? ",\"" : "\"") + std::to_string(k) + "\":0";
    return text + "}";
  };
  EXPECT_EQ(parse_json(object(2000)).size(), 2000u);
  EXPECT_THROW(parse_json(object(50'000)), std::runtime_error);
  // Many small objects are accepted.
  EXPECT_EQ(parse_json("[" + repeated(object(27) + ",", 10'000) + "0]").size(), 10'001u);
}

}  // namespace
}  // namespace weft
