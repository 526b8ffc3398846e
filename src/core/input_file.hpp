// Files from outside are read here: regular files only, since a pipe or a device may never end, and every failure
// names its file.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <string>

#include "core/error.hpp"

namespace weft {

/// Largest text that is read as a whole [bytes]; statistics of 100,000 frames have 70 MB.
inline constexpr std::uintmax_t kLargestText = std::uintmax_t{256} << 20;
inline constexpr std::uintmax_t kAnySize = std::numeric_limits<std::uintmax_t>::max();

/// All bytes of a regular file. Throws std::runtime_error with the reason alone for what is no regular file, holds more
/// than `most` bytes, or cannot be read. Never waits for a writer.
std::string read_bytes(const std::filesystem::path& file, std::uintmax_t most = kAnySize);

/// The same. Throws Error(asset_unreadable) with the name of the file and the reason.
std::string read_file(const std::filesystem::path& file, std::uintmax_t most = kAnySize);

/// For libraries that open files by themselves: throws std::runtime_error with the reason where `file` is no regular
/// file, or cannot be opened.
void check_is_file(const std::filesystem::path& file);

/// The first bytes of a regular file, at most `count`; empty where it cannot be read.
std::string read_start(const std::filesystem::path& file, std::size_t count);

/// Returns what `read` returns. What `read` throws that is no Error becomes Error(asset_unreadable) with the name of
/// the file: whatever a file holds, its reader's failure is never an internal error.
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
