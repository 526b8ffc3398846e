// The examples of a page: its code blocks, each run in a folder made for the test.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::docs {

/// Checks the form of the blocks. Each block is a scene or a script (toml or python; its first line names the file),
/// commands (sh), or the output of the commands before it (text). Returns one line for each mistake, "line: what".
std::string wrong_blocks(const std::string& page);

/// Runs the commands of one section in `folder`. In it, ./weft is the program, scenes/ contains the scenes of the
/// source tree, and every scene of the page up to this section is a file. A scene begins with `# NAME.toml`, or with `#
/// NAME.toml: OTHER.toml, and at its end` if it extends another; a script begins with `# NAME.py`. Returns the first
/// failure: a command with its output, or a line of a text block that was not printed. Empty if all succeed.
std::string run_section(const std::string& page, const std::string& section, const std::filesystem::path& folder);

}  // namespace weft::docs
