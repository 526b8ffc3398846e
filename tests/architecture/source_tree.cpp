#include "architecture/source_tree.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "core/input_file.hpp"

namespace weft::architecture {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& path) {
  std::istringstream text(read_file(path));
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

// Part of the path of installed headers: each module has them in a folder of this name.
const std::string kInterface = "/include/weft/";

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

// A weft_room() or weft_module() of src/CMakeLists.txt.
struct Declaration {
  std::string kind, name, does;
  std::vector<std::string> uses;
};

std::vector<Declaration> read_declarations(const fs::path& root) {
  const std::string text = read_file(root / "src/CMakeLists.txt");
  const std::regex pattern(R"re(\bweft_(room|module)\((\w+)(?:\s+DOES\s+"([^"]*)")?([^()]*)\))re");
  std::vector<Declaration> declarations;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    Declaration declaration{(*match)[1], (*match)[2], (*match)[3], {}};
    std::istringstream words((*match)[4]);
    bool in_uses = false;
    for (std::string word; words >> word;) {
      if (word == "USES" || word == "LINKS") {
        in_uses = word == "USES";
      } else if (in_uses) {
        declaration.uses.push_back(word);
      }
    }
    declarations.push_back(declaration);
  }
  return declarations;
}

// The module that a file below src/ belongs to, by its folder; empty if the file is in no module.
std::string module_of(const fs::path& file, const std::vector<Module>& modules) {
  for (const Module& module : modules)
    if (file.generic_string().starts_with(module.folder().generic_string() + "/")) return module.name;
  return "";
}

}  // namespace

std::vector<Room> read_rooms(const fs::path& root) {
  std::vector<Room> rooms;
  for (const Declaration& declared : read_declarations(root))
    if (declared.kind == "room") rooms.push_back({declared.name, declared.does, declared.uses});
  return rooms;
}

std::vector<Module> read_modules(const fs::path& root) {
  std::vector<Module> modules;
  std::string room;
  for (const Declaration& declared : read_declarations(root)) {
    if (declared.kind == "room")
      room = declared.name;
    else
      modules.push_back({declared.name, declared.does, declared.uses, room});
  }
  return modules;
}

std::string wrong_includes(const fs::path& root) {
  std::map<std::string, std::set<std::string>> allowed;
  const std::vector<Module> modules = read_modules(root);
  for (const Module& module : modules) {
    allowed[module.name] = {module.uses.begin(), module.uses.end()};
    allowed[module.name].insert({"core", module.name});
  }
  const std::regex include(R"re(\s*#\s*include\s*"([^"]+)".*)re");
  const std::regex public_include(R"re(\s*#\s*include\s*<(weft/[^>]+)>.*)re"),
      standard_include(R"re(\s*#\s*include\s*<\w+>.*)re");
  std::string wrong;
  for (const fs::path& file : written_files(root, {"src"})) {
    if (!kCode.contains(file.extension()) || *file.begin() != "src") continue;
    const std::string from = module_of(file.lexically_relative("src"), modules);
    const auto lines = lines_of(root / file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      const bool of_interface = std::regex_match(lines[i], match, public_include);
      if (of_interface) {
        const std::string header = "include/" + match[1].str();
        const auto owner = std::ranges::find_if(
            modules, [&](const Module& each) { return fs::exists(root / "src" / each.folder() / header); });
        if (owner == modules.end())
          wrong += at(file, i + 1) + "no module has " + header + "\n";
        else if (!allowed[from].contains(owner->name))
          wrong += at(file, i + 1) + from + " does not use " + owner->name + "\n";
      }
      if (file.generic_string().find(kInterface) != std::string::npos && lines[i].starts_with("#include") &&
          !of_interface && !std::regex_match(lines[i], standard_include))
        wrong += at(file, i + 1) + "others cannot include this\n";
      if (!std::regex_match(lines[i], match, include)) continue;
      const fs::path target = match[1].str();
      if (match[1].str().starts_with("embedded_")) continue;  // generated by the build
      if (!fs::is_regular_file(root / "src" / target)) {
        wrong += at(file, i + 1) + "src/" + target.generic_string() + " does not exist\n";
      } else if (const std::string used = module_of(target, modules); !allowed[from].contains(used)) {
        wrong += at(file, i + 1) + from + " does not use " + used + "\n";
      }
    }
  }
  return wrong;
}

std::string wrong_declarations(const fs::path& root) {
  const std::string prefix = "src/CMakeLists.txt: ";
  std::string wrong;
  std::map<std::string, std::set<std::string>> rooms{{"", {""}}};  // for each room, the rooms whose modules it may use
  for (const Room& room : read_rooms(root)) {
    for (const std::string& used : room.uses)
      if (!rooms.contains(used)) wrong += prefix + room.name + " uses " + used + ", which is not declared before it\n";
    rooms[room.name] = {room.uses.begin(), room.uses.end()};
    rooms[room.name].insert({"", room.name});
  }
  std::map<std::string, std::string> room_of;  // for each module declared so far
  std::set<std::string> folders;
  for (const Module& module : read_modules(root)) {
    for (const std::string& used : module.uses) {
      if (!room_of.contains(used))
        wrong += prefix + module.name + " uses " + used + ", which is not declared before it\n";
      else if (!rooms[module.room].contains(room_of[used]))
        wrong += prefix + module.name + " uses " + used + " of the room " + room_of[used] + "\n";
    }
    if (!fs::is_directory(root / "src" / module.folder())) wrong += prefix + module.name + " has no folder\n";
    if (!room_of.emplace(module.name, module.room).second) wrong += prefix + module.name + " is declared twice\n";
    folders.insert(module.folder().generic_string());
  }
  std::set<fs::path> found;
  for (const auto& entry : fs::directory_iterator(root / "src")) {
    if (!entry.is_directory()) continue;
    if (!rooms.contains(entry.path().filename())) {
      found.insert(entry.path());
      continue;
    }
    for (const auto& inner : fs::directory_iterator(entry.path()))
      if (inner.is_directory()) found.insert(inner.path());
  }
  for (const fs::path& folder : found) {
    const std::string below = folder.lexically_relative(root / "src").generic_string();
    if (!folders.contains(below)) wrong += prefix + "src/" + below + " is not declared\n";
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
