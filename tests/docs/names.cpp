#include "docs/names.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <regex>

#include "core/input_file.hpp"
#include "docs/markdown.hpp"

namespace weft::docs {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kSources = {".cpp", ".hpp", ".c", ".glsl", ".vert", ".frag", ".js", ".sh", ".py"};
const std::set<std::string> kTexts = {".txt", ".toml", ".cmake", ""};

void add_words(const std::string& text, std::set<std::string>& words) {
  const std::regex word(R"([A-Za-z_]\w*)");
  for (std::sregex_iterator match(text.begin(), text.end(), word), end; match != end; ++match)
    words.insert(match->str());
}

// Collects the names of tests. Of parameterised and typed tests, it collects the names of the first instance.
class Tests {
 public:
  void read(const std::string& text) {
    static const std::regex kTest(R"(\b(TEST|TEST_F|TEST_P|TYPED_TEST|TYPED_TEST_P)\(\s*(\w+),\s*(\w+)\))");
    static const std::regex kInstance(R"(\bINSTANTIATE_(?:TYPED_)?TEST_SUITE_P\(\s*(\w*),\s*(\w+),)");
    for (std::sregex_iterator match(text.begin(), text.end(), kTest), end; match != end; ++match)
      tests_.push_back({(*match)[1], (*match)[2], (*match)[3]});
    for (std::sregex_iterator match(text.begin(), text.end(), kInstance), end; match != end; ++match)
      prefixes_[(*match)[2]].insert((*match)[1]);
  }

  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& [kind, suite, name] : tests_) {
      if (kind == "TEST" || kind == "TEST_F") names.insert(suite + "." + name);
      if (kind == "TYPED_TEST") names.insert(suite + "/0." + name);
      if (!prefixes_.contains(suite)) continue;
      if (kind == "TEST_P") names.insert(suite + "." + name);  // as tests/run -R accepts it
      for (const std::string& prefix : prefixes_.at(suite))
        names.insert(kind == "TEST_P" ? fmt::format("{}/{}.{}/0", prefix, suite, name)
                                      : fmt::format("{}/{}/0.{}", prefix, suite, name));
    }
    return names;
  }

 private:
  struct Test {
    std::string kind, suite, name;
  };
  std::vector<Test> tests_;
  std::map<std::string, std::set<std::string>> prefixes_;
};

bool is_test(const std::string& name, const Known& known) {
  return std::any_of(known.tests.begin(), known.tests.end(), [&](const std::string& test) {
    return ::fnmatch(name.c_str(), test.c_str(), 0) == 0 || ::fnmatch((name + "/0").c_str(), test.c_str(), 0) == 0;
  });
}

bool is_file(const std::string& name, const fs::path& root, const fs::path& page, const Known& known) {
  if (name.find('/') == std::string::npos) {
    const bool written_by_a_run = name.ends_with(".toml") || name.ends_with(".txt");
    return written_by_a_run || known.file_names.contains(name);
  }
  std::vector<fs::path> folders = {"", "src", "tests", page.parent_path()};
  for (const auto& room : fs::directory_iterator(root / "src"))
    if (room.is_directory()) folders.push_back("src" / room.path().filename());
  return std::any_of(folders.begin(), folders.end(),
                     [&](const fs::path& folder) { return fs::exists(root / folder / name); });
}

// Checks each part of a::b. A part of lower-case letters may be any word; any other part must be a known identifier.
bool is_name(const std::string& name, const Known& known) {
  static const std::regex kPart(R"(\w+)");
  const std::vector<std::string> parts(std::sregex_token_iterator(name.begin(), name.end(), kPart), {});
  const auto plain = [](char c) { return c >= 'a' && c <= 'z'; };
  return std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
    return std::all_of(part.begin(), part.end(), plain) || known.words.contains(part);
  });
}

// `test_mesh` is the program of the tests in tests/mesh; `test_mesh_slow` is that of its slow tests.
bool is_test_program(const std::string& name, const fs::path& root) {
  static const std::regex kProgram(R"(test_(\w+?)(?:_slow)?)");
  std::smatch match;
  return std::regex_match(name, match, kProgram) && fs::is_directory(root / "tests" / match[1].str());
}

}  // namespace

Known read_known(const fs::path& root) {
  Known known;
  Tests tests;
  const auto read = [&](const fs::path& file) {
    known.file_names.insert(file.filename());
    if (!kSources.contains(file.extension()) && !kTexts.contains(file.extension())) return;
    const std::string text = read_file(file);
    add_words(text, known.words);
    if (file.extension() == ".cpp" || file.extension() == ".hpp") tests.read(text);
  };
  for (const auto& entry : fs::directory_iterator(root)) {
    if (entry.is_regular_file()) read(entry.path());
  }
  for (const char* folder : {"src", "shaders", "scenes", "tests"}) {
    for (auto entry = fs::recursive_directory_iterator(root / folder); entry != fs::end(entry); ++entry) {
      const std::string name = entry->path().filename();
      if (entry->is_directory() && name == "corpus") entry.disable_recursion_pending();
      if (entry->is_regular_file()) read(entry->path());
    }
  }
  known.tests = tests.names();
  return known;
}

std::string unknown_names(const fs::path& root, const fs::path& page, const Known& known) {
  static const std::regex kTest(R"([A-Z]\w*(?:[*/][\w*/]*)?\.[A-Z*][\w*]*)");
  static const std::regex kFile(R"(\.?[\w./-]+\.(?:cpp|hpp|c|toml|md|sh|py|txt|glsl|vert|frag|cmake))");
  static const std::regex kName(R"(((?:[A-Za-z]\w*::)*[A-Za-z]\w*)(?:\(.*\))?)");
  std::string unknown;
  for (const std::string& code : read_page(read_file(root / page)).code) {
    std::smatch match;
    bool good = true;
    if (std::regex_match(code, kTest)) {
      good = is_test(code, known);
    } else if (std::regex_match(code, kFile)) {
      good = is_file(code, root, page, known);
    } else if (std::regex_match(code, match, kName)) {
      good = is_name(match[1], known) || is_test_program(code, root);
    }
    if (!good) unknown += fmt::format("{}: {}\n", page.string(), code);
  }
  return unknown;
}

}  // namespace weft::docs
