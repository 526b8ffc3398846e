#include "architecture/source_tree.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace weft::architecture {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::istringstream text(read(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

const std::set<std::string> kCode = {".cpp", ".hpp", ".c", ".h", ".glsl", ".vert", ".frag", ".geom", ".comp"};
// Extensions of other hand-written files; scripts and dotfiles have none.
const std::set<std::string> kOtherText = {".toml", ".txt", ".md", ".json", ".sh", ".js", ".css", ".html", ""};

// Hand-written files in these folders and at the top level, sorted by name, relative to root.
std::vector<fs::path> written_files(const fs::path& root, const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  const auto add = [&](const fs::directory_entry& entry) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(root));
  };
  for (const std::string& folder : folders) {
    if (!fs::is_directory(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) add(entry);
  }
  for (const auto& entry : fs::directory_iterator(root)) add(entry);
  std::sort(files.begin(), files.end());
  return files;
}

// Headers that the build generates.
const std::set<std::string> kGeneratedHeaders = {"embedded_shaders.hpp", "embedded_review.hpp", "embedded_cli.hpp",
                                                 "embedded_templates.hpp", "embedded_export.hpp"};

// Headers that are installed.
const std::string kInterface = "src/library/include/";

const std::vector<std::string> kCodeFolders = {"src", "shaders", "tests"};
const std::vector<std::string> kAllFolders = {"src", "shaders", "tests", "scenes", ".ci"};

std::string at(const fs::path& file, std::size_t line) {
  return file.generic_string() + ":" + std::to_string(line) + ": ";
}

bool continues_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool has_word(const std::string& line, const std::string& word) {
  for (auto begin = line.find(word); begin != std::string::npos; begin = line.find(word, begin + 1)) {
    const std::size_t end = begin + word.size();
    const bool starts = begin == 0 || !continues_word(line[begin - 1]) || !continues_word(word.front());
    const bool ends = end == line.size() || !continues_word(line[end]) || !continues_word(word.back());
    if (starts && ends) return true;
  }
  return false;
}

}  // namespace

std::vector<Module> read_modules(const fs::path& root) {
  const std::string text = read(root / "src/CMakeLists.txt");
  const std::regex declaration(R"re(\bweft_module\((\w+)(?:\s+DOES\s+"([^"]*)")?([^()]*)\))re");
  std::vector<Module> modules;
  for (std::sregex_iterator match(text.begin(), text.end(), declaration), end; match != end; ++match) {
    Module module{(*match)[1], (*match)[2], {}};
    std::istringstream words((*match)[3]);
    bool in_uses = false;
    for (std::string word; words >> word;) {
      if (word == "USES" || word == "LINKS") {
        in_uses = word == "USES";
      } else if (in_uses) {
        module.uses.push_back(word);
      }
    }
    modules.push_back(module);
  }
  return modules;
}

std::string wrong_includes(const fs::path& root) {
  std::map<std::string, std::set<std::string>> allowed;
  for (const Module& module : read_modules(root)) {
    allowed[module.name] = {module.uses.begin(), module.uses.end()};
    allowed[module.name].insert({"core", module.name});
  }
  const std::regex include(R"re(\s*#\s*include\s*"([^"]+)".*)re");
  const std::regex public_include(R"re(\s*#\s*include\s*<(weft)/.*)re"),
      standard_include(R"re(\s*#\s*include\s*<\w+>.*)re");
  std::string wrong;
  for (const fs::path& file : written_files(root, {"src"})) {
    if (!kCode.contains(file.extension()) || *file.begin() != "src") continue;
    const std::string from = std::next(file.begin())->string();
    const auto lines = lines_of(root / file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      const bool of_interface = std::regex_match(lines[i], match, public_include);
      if (of_interface && !allowed[from].contains("library"))
        wrong += at(file, i + 1) + from + " does not use library\n";
      if (file.generic_string().starts_with(kInterface) && lines[i].starts_with("#include") && !of_interface &&
          !std::regex_match(lines[i], standard_include))
        wrong += at(file, i + 1) + "others cannot include this\n";
      if (!std::regex_match(lines[i], match, include)) continue;
      const fs::path target = match[1].str();
      if (kGeneratedHeaders.contains(target)) continue;
      if (!fs::is_regular_file(root / "src" / target)) {
        wrong += at(file, i + 1) + "src/" + target.generic_string() + " does not exist\n";
      } else if (!allowed[from].contains(target.begin()->string())) {
        wrong += at(file, i + 1) + from + " does not use " + target.begin()->string() + "\n";
      }
    }
  }
  return wrong;
}

std::string wrong_declarations(const fs::path& root) {
  const std::string prefix = "src/CMakeLists.txt: ";
  std::string wrong;
  std::set<std::string> declared;
  for (const Module& module : read_modules(root)) {
    for (const std::string& used : module.uses) {
      if (!declared.contains(used))
        wrong += prefix + module.name + " uses " + used + ", which is not declared before it\n";
    }
    if (!fs::is_directory(root / "src" / module.name)) wrong += prefix + module.name + " has no folder\n";
    if (!declared.insert(module.name).second) wrong += prefix + module.name + " is declared twice\n";
  }
  std::set<std::string> folders;
  for (const auto& entry : fs::directory_iterator(root / "src")) {
    if (entry.is_directory()) folders.insert(entry.path().filename());
  }
  for (const std::string& folder : folders) {
    if (!declared.contains(folder)) wrong += prefix + "src/" + folder + " is not declared\n";
  }
  return wrong;
}

std::string long_files(const fs::path& root, int limit, const std::vector<std::string>& exempt) {
  std::set<std::string> unused(exempt.begin(), exempt.end());
  std::string wrong;
  for (const fs::path& file : written_files(root, kCodeFolders)) {
    if (!kCode.contains(file.extension())) continue;
    const auto lines = static_cast<int>(lines_of(root / file).size());
    if (lines <= limit || unused.erase(file.generic_string()) > 0) continue;
    wrong += file.generic_string() + ": " + std::to_string(lines) + " lines, more than " + std::to_string(limit) + "\n";
  }
  for (const std::string& file : unused) wrong += file + ": needs no exemption\n";
  return wrong;
}

std::string lines_with(const fs::path& root, const std::vector<std::string>& words) {
  std::string found;
  for (const fs::path& file : written_files(root, kAllFolders)) {
    if (!kCode.contains(file.extension()) && !kOtherText.contains(file.extension())) continue;
    const auto lines = lines_of(root / file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (const std::string& word : words) {
        if (has_word(lines[i], word)) found += at(file, i + 1) + word + "\n";
      }
    }
  }
  return found;
}

}  // namespace weft::architecture
