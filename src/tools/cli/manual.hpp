// Shell completion and the manual page, both generated from the text of --help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace weft::cli {

/// A script that completes commands, options and their values, and file names. `shell`: bash, zsh or fish.
std::string completion(const CLI::App& app, const std::string& shell);

/// The manual page, section 1.
std::string manual(const CLI::App& app);

}  // namespace weft::cli
