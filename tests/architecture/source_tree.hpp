// What the design asks of the source tree, read from the files as text.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::architecture {

/// A module as src/CMakeLists.txt declares it: `weft_module(name DOES "..." USES ... LINKS ...)`.
struct Module {
  std::string name, does;
  std::vector<std::string> uses;  ///< besides core, which all may use
};

/// The modules in the order of the file. Throws std::runtime_error where the file cannot be read.
std::vector<Module> read_modules(const std::filesystem::path& root);

// Each check returns one line for each violation, "file:line: what is wrong", paths relative to root; empty if all is
// well.

/// Includes of src/ that name a module which neither USES nor core allows, or no file at all. <weft/...> is of library,
/// and its headers there include nothing but each other and the standard library.
std::string wrong_includes(const std::filesystem::path& root);

/// Names in USES that are not declared earlier in the file (which also rules out cycles), folders of src/ that are
/// not declared, and modules without a folder.
std::string wrong_declarations(const std::filesystem::path& root);

/// Source files longer than `limit` lines, but for those listed (tables and generated code, relative to root). A listed
/// file that is not that long, or not there, is reported too.
std::string long_files(const std::filesystem::path& root, int limit, const std::vector<std::string>& exempt);

/// Lines of what we write (sources, shaders, scenes, scripts, build files, README) with one of these words in them.
/// Words count only where no letter, digit or underscore continues them.
std::string lines_with(const std::filesystem::path& root, const std::vector<std::string>& words);

}  // namespace weft::architecture
