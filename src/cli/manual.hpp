// The command line as texts for other programs: shells that complete it, and man. All come from what --help prints.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace weft::cli {

/// A script that completes commands, options and their values; other words are names of files. `shell`: bash, zsh or
/// fish.
std::string completion(const CLI::App& app, const std::string& shell);

/// The manual page, section 1.
std::string manual(const CLI::App& app);

}  // namespace weft::cli
