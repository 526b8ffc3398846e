// Design rules for the source tree, checked on the text of the files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::architecture {

/// A room as src/CMakeLists.txt declares it: `weft_room(name DOES "..." USES ...)`. The modules that follow are its
/// own.
struct Room {
  std::string name, does;
  std::vector<std::string> uses;  ///< other rooms whose modules its own may use
};

/// A module as src/CMakeLists.txt declares it: `weft_module(name DOES "..." USES ... LINKS ...)`.
struct Module {
  std::string name, does;
  std::vector<std::string> uses;  ///< in addition to core, which all may use
  std::string room;               ///< empty: none

  /// Below src/.
  std::filesystem::path folder() const { return std::filesystem::path(room) / name; }
};

// Both in the order of the file. They throw std::runtime_error if the file cannot be read.
std::vector<Room> read_rooms(const std::filesystem::path& root);
std::vector<Module> read_modules(const std::filesystem::path& root);

// Each check returns a line for each violation, "file:line: what is wrong" (paths relative to root), or nothing.

/// Includes of src/ that name a module which is neither in USES nor core, or a file that does not exist. <weft/...>
/// belongs to the module whose include/ has it; headers there include only each other and the standard library.
std::string wrong_includes(const std::filesystem::path& root);

/// Names in USES that are not declared earlier in the file (which also excludes cycles), modules that use one of a room
/// that theirs does not use, folders of src/ that are not declared, and modules without a folder.
std::string wrong_declarations(const std::filesystem::path& root);

/// Source files longer than `limit` lines, except those listed (tables and generated code, relative to root). A listed
/// file that is shorter or missing is reported too.
std::string long_files(const std::filesystem::path& root, int limit, const std::vector<std::string>& exempt);

/// Lines of hand-written files (sources, shaders, scenes, scripts, build files, README) that contain one of these words
/// as a whole word: no letter, digit or underscore is adjacent.
std::string lines_with(const std::filesystem::path& root, const std::vector<std::string>& words);

}  // namespace weft::architecture
