// The examples of a page: its blocks of code, run in a folder of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::docs {

/// What is wrong with the blocks themselves: each is a scene or a script (toml or python, its first line names the
/// file), commands (sh) or what the commands before it print (text). One line for each mistake, "line: what".
std::string wrong_blocks(const std::string& page);

/// Runs the commands of one section in `folder`, where ./weft is the program, scenes/ are those of the source tree and
/// every scene of the page down to there is a file. A scene begins with `# NAME.toml`, or with
/// `# NAME.toml: OTHER.toml, and at its end`, a script with `# NAME.py`. Returns what failed: a command with its
/// output, or a line of a text block that was not printed; empty if all is well.
std::string run_section(const std::string& page, const std::string& section, const std::filesystem::path& folder);

}  // namespace weft::docs
