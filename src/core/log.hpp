// Messages for the user on standard error, in whole lines and in order. Thread-safe.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::log {

/// `text` with control characters escaped, because a terminal would interpret them as commands; names of files may
/// contain them. `kept`: ASCII control characters that are not escaped.
std::string without_controls(std::string_view text, std::string_view kept = "\n\t");

void info(std::string_view line);

/// Prints `warning: text` and keeps the text for the summary at the end of a run. Ignores a text that is kept already.
void warn(std::string_view text);

/// Like warn(), but prints `note: text`. For changes of a scene that the program makes on purpose.
void note(std::string_view text);

/// Passes the texts of all later calls of info(), warn() and note() to `handle`, in the calling thread, instead of
/// printing and keeping them. An empty `handle` restores the default.
void set_handler(std::function<void(std::string_view text)> handle);

std::vector<std::string> warnings();

std::vector<std::string> notes();

/// Shows `line`, such as a progress bar, below all other lines, in place of the previous status line. An empty `line`
/// only removes the previous status line. For terminals only.
void status(std::string_view line);

}  // namespace weft::log
