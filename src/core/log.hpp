// Messages for people on standard error, in whole lines and in order. Safe from all threads.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::log {

/// `text` with escapes for what a terminal would interpret as commands, for example in the name of a file. `kept`: the
/// control characters that stay.
std::string without_controls(std::string_view text, std::string_view kept = "\n\t");

void info(std::string_view line);

/// Prints `warning: text` and keeps the text for the summary at the end; the same text again is ignored.
void warn(std::string_view text);

/// Like warn(), with `note: text`, for intended changes that the user should know of.
void note(std::string_view text);

/// Sends following messages to `handle`, in the thread that reports them; they are neither printed nor kept.
/// An empty `handle` restores the default.
void set_handler(std::function<void(std::string_view text)> handle);

std::vector<std::string> warnings();

std::vector<std::string> notes();

/// Shows `line` in place below the other lines, for a progress bar; an empty line removes it. For terminals only.
void status(std::string_view line);

}  // namespace weft::log
