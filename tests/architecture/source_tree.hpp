// Design rules for the source tree, checked on the text of the files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::architecture {

/// A room as src/CMakeLists.txt declares it: `weft_room(name DOES "..." USES ...)`. All modules declared after it, up
/// to the next room, belong to it.
struct Room {
  std::string name, does;
  std::vector<std::string> uses;  ///< rooms whose modules the modules of this room may use
};

/// A module as src/CMakeLists.txt declares it: `weft_module(name DOES "..." USES ... LINKS ...)`.
struct Module {
  std::string name, does;
  std::vector<std::string> uses;  ///< modules that it may use in addition to core
  std::string room;               ///< its room; empty: none

  /// Folder of the module, relative to src/.
  std::filesystem::path folder() const { return std::filesystem::path(room) / name; }
};

// Rooms and modules in the order of the file. Both functions throw Error if the file cannot be read.
std::vector<Room> read_rooms(const std::filesystem::path& root);
std::vector<Module> read_modules(const std::filesystem::path& root);

// Each check returns a line for each violation, "file:line: what is wrong" (paths relative to root); an empty text if
// there is none.

/// Includes of src/ that name a file that does not exist, or a module that is neither core nor in USES. A header
/// <weft/...> belongs to the module in whose folder include/ it is; such headers include only each other and the
/// standard library.
std::string wrong_includes(const std::filesystem::path& root);

/// Four kinds of violations: names in USES that are not declared earlier in the file (this also excludes cycles);
/// modules that use a module of a room that their own room does not use; folders of src/ that are not declared; modules
/// without a folder.
std::string wrong_declarations(const std::filesystem::path& root);

/// Source files longer than `limit` lines, except those listed (tables and generated code, relative to root). A listed
/// file that is shorter or missing is reported too.
std::string long_files(const std::filesystem::path& root, int limit, const std::vector<std::string>& exempt);

/// Lines of hand-written files (sources, shaders, scenes, scripts, build files, README) that contain one of these words
/// as a whole word: no letter, digit or underscore is adjacent.
std::string lines_with(const std::filesystem::path& root, const std::vector<std::string>& words);

}  // namespace weft::architecture
