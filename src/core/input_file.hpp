// Reads input files: only regular files, because reading a pipe or a device may never end. Every Error names its file.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <string>

#include "core/error.hpp"

namespace weft {

/// Maximum size of a text file that is read as a whole [bytes]. The statistics of 100,000 frames have 70 MB.
inline constexpr std::uintmax_t kMaxTextBytes = std::uintmax_t{256} << 20;
inline constexpr std::uintmax_t kAnySize = std::numeric_limits<std::uintmax_t>::max();

/// Returns all bytes of a regular file. Throws std::runtime_error, with the reason but without the
/// file's name, if `file` is not a regular file, is larger than `max_bytes` or the free memory, or
/// cannot be read.
std::string read_bytes(const std::filesystem::path& file, std::uintmax_t max_bytes = kAnySize);

/// Like read_bytes(), but throws Error(asset_unreadable) with the name of the file and the reason.
std::string read_file(const std::filesystem::path& file, std::uintmax_t max_bytes = kAnySize);

/// Throws std::runtime_error with the reason if `file` is not a regular file or cannot be opened. Call it before a
/// library opens `file` itself.
void check_is_file(const std::filesystem::path& file);

/// Returns the first bytes of a regular file, at most `count`; empty if the file cannot be read.
std::string read_start(const std::filesystem::path& file, std::size_t count);
/// Returns the last bytes of a regular file, at most `count`; empty if the file cannot be read.
std::string read_end(const std::filesystem::path& file, std::size_t count);

/// Returns the result of `read`, which parses `file`. If `read` throws a std::exception that is not an Error, throws
/// Error(asset_unreadable) with the name of the file instead, so that a broken file does not count as an internal
/// error.
template <class Read>
auto read_checked(const std::filesystem::path& file, const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::asset_unreadable, "{}: too large for the memory of this machine", file.string());
  } catch (const std::exception& error) {
    throw Error(ExitCode::asset_unreadable, "{}: broken: {}", file.string(), error.what());
  }
}

}  // namespace weft
