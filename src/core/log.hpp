// Messages for the user on standard error, in whole lines and in order. Thread-safe.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::log {

/// `text` with control characters escaped as \xNN, because a terminal would interpret them as
/// commands; file names may contain control characters. `kept`: ASCII control characters that are
/// not escaped.
std::string without_controls(std::string_view text, std::string_view kept = "\n\t");

/// Prints `line`.
void info(std::string_view line);

/// Prints `warning: text`, and adds the text to warnings(). Does nothing if warnings() contains this text already.
void warn(std::string_view text);

/// Like warn(), but prints `note: text` and adds the text to notes(). Use it for changes of a scene
/// that the program makes on purpose.
void note(std::string_view text);

/// Passes the texts of all later calls of info(), warn() and note() to `handle`, in the thread of
/// the call, instead of printing and keeping them. If `handle` is empty, later texts are printed
/// and kept again.
void set_handler(std::function<void(std::string_view text)> handle);

/// The texts that warn() has kept, each once, in order.
std::vector<std::string> warnings();

/// The texts that note() has kept, each once, in order.
std::vector<std::string> notes();

/// Shows `line`, such as a progress bar, below all other lines, in place of the previous status
/// line. If `line` is empty, only removes the previous status line. Standard error must be a
/// terminal.
void status(std::string_view line);

}  // namespace weft::log
