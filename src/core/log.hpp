// Lines for people on standard error, whole and in order whichever thread they come from. Safe from all threads.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::log {

/// Prints one line.
void info(std::string_view line);

/// Prints `warning: text` and keeps the text for the summary at the end; the same text again is ignored.
void warn(std::string_view text);

/// Prints `note: text` and keeps the text for the summary at the end; the same text again is ignored. For what was done
/// and is not wrong.
void note(std::string_view text);

/// From now on `handle` gets warnings and notes, in the thread that they come from; they are neither printed nor kept.
/// An empty one restores that.
void set_handler(std::function<void(std::string_view text)> handle);

/// All warnings so far, in order.
std::vector<std::string> warnings();

/// All notes so far, in order.
std::vector<std::string> notes();

/// Shows `line` in place below the other lines, for a progress bar; an empty one takes it away. For terminals only.
void status(std::string_view line);

}  // namespace weft::log
