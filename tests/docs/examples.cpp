#include "docs/examples.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdio>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "core/input_file.hpp"
#include "core/temporary_file.hpp"
#include "docs/markdown.hpp"

namespace weft::docs {
namespace {

namespace fs = std::filesystem;

const std::regex kFirstLineOfScript(R"(# ([\w.-]+\.py)\n[^]*)");
const std::regex kFirstLine(R"(# ([\w.-]+\.toml)(?:: ([\w.-]+\.toml), and at its end)?\n[^]*)");

// Runs `commands` in a shell that stops at the first failure. `output` receives standard output and standard error.
int run(const std::string& commands, const fs::path& folder, std::string& output) {
  write_file(folder / "commands.sh", commands, Flush::no);
  FILE* pipe = ::popen(
      fmt::format("cd '{}' && PATH=$PWD/.bin:$PATH PYTHONPATH='" WEFT_BUILD_DIR "/python' sh -eu commands.sh 2>&1",
                  folder.string())
          .c_str(),
      "r");
  if (pipe == nullptr) throw std::runtime_error("no shell");
  char bytes[4096];
  for (std::size_t count; (count = std::fread(bytes, 1, sizeof bytes, pipe)) > 0;) output.append(bytes, count);
  const int status = ::pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Looks for the lines of `expected` in `output`, in order. Returns the first missing one; empty if there is none.
std::string missing_line(const std::string& expected, const std::string& output) {
  std::istringstream lines(expected);
  std::size_t from = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto at = output.find(line, from);
    if (at == std::string::npos) return line;
    from = at + line.size();
  }
  return "";
}

}  // namespace

std::string wrong_blocks(const std::string& page) {
  std::string wrong;
  std::map<std::string, bool> scenes;
  std::string before;
  for (const Fence& fence : read_page(page).fences) {
    std::smatch match;
    const auto complain = [&](const std::string& what) { wrong += fmt::format("{}: {}\n", fence.line, what); };
    if (fence.info == "toml") {
      if (!std::regex_match(fence.text, match, kFirstLine)) {
        complain("the first line of a scene names its file: # NAME.toml");
      } else if (match[2].matched && !scenes.contains(match[2])) {
        complain("no scene before is named " + match[2].str());
      } else if (!scenes.insert({match[1], true}).second) {
        complain("a scene before is named " + match[1].str());
      }
    } else if (fence.info == "python") {
      if (!std::regex_match(fence.text, kFirstLineOfScript))
        complain("the first line of a script names its file: # NAME.py");
    } else if (fence.info == "text") {
      if (before != "sh") complain("no commands before this text");
    } else if (fence.info != "sh") {
      complain("expected toml, python, sh or text, got '" + fence.info + "'");
    }
    before = fence.info;
  }
  return wrong;
}

std::string run_section(const std::string& page, const std::string& section, const fs::path& folder) {
  fs::create_symlink(WEFT_PROGRAM, folder / "weft");
  fs::create_directory(folder / ".bin");
  fs::create_symlink(WEFT_PYTHON_PROGRAM, folder / ".bin/python3");  // the interpreter for which the module is built
  fs::create_symlink(fs::path(WEFT_SOURCE_DIR) / "scenes", folder / "scenes");
  std::string output;
  for (const Fence& fence : read_page(page).fences) {
    std::smatch match;
    if (std::regex_match(fence.text, match, kFirstLine)) {
      const std::string base = match[2].matched ? read_file(folder / match[2].str()) + "\n" : "";
      write_file(folder / match[1].str(), base + fence.text, Flush::no);
    }
    if (std::regex_match(fence.text, match, kFirstLineOfScript))
      write_file(folder / match[1].str(), fence.text, Flush::no);
    if (fence.section != section) continue;
    if (fence.info == "sh") {
      output.clear();
      const int code = run(fence.text, folder, output);
      if (code != 0) return fmt::format("line {}: exit code {}\n{}{}", fence.line, code, fence.text, output);
    }
    if (fence.info == "text") {
      const std::string line = missing_line(fence.text, output);
      if (!line.empty()) return fmt::format("line {}: '{}' was not printed, but\n{}", fence.line, line, output);
    }
  }
  return "";
}

}  // namespace weft::docs
