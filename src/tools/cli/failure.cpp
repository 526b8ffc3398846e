#include "tools/cli/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "core/log.hpp"

namespace weft::cli {
namespace {

// Limit on words in messages [bytes]. Longer words cannot be paths; they come from the contents of arguments or files.
// Messages show only their first kShownWordBytes bytes.
constexpr std::size_t kMaxWordBytes = 4096, kShownWordBytes = 200;

std::string shorten_words(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t size = std::min(text.find_first_of(" \n"), text.size());
    std::string_view word = text.substr(0, size);
    if (size > kMaxWordBytes) {
      word = word.substr(0, kShownWordBytes);
      while (!word.empty() && (word.back() & 0x80) != 0) word.remove_suffix(1);  // drops a truncated UTF-8 character
      result += fmt::format("{}... ({} bytes)", word, size);
    } else {
      result += word;
    }
    if (size < text.size()) result += text[size];
    text.remove_prefix(std::min(size + 1, text.size()));
  }
  return result;
}

}  // namespace

Failure describe_failure(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    return {error.code(), shorten_words(error.what())};
  } catch (const std::bad_alloc&) {
    return {ExitCode::internal, "out of memory; a smaller scene or picture may fit"};
  } catch (const std::filesystem::filesystem_error& error) {
    // No earlier check refused this path. Possible causes: no such folder, name too long, no permission.
    const bool too_long = error.code() == std::errc::filename_too_long;
    return {too_long ? ExitCode::usage : ExitCode::output_failed,
            fmt::format("{}: cannot be used: {}", error.path1().string().substr(0, 200), error.code().message())};
  } catch (const std::exception& error) {
    return {ExitCode::internal, fmt::format("unexpected: {}", error.what())};
  } catch (...) {
    return {ExitCode::internal, "unexpected: an exception of unknown type"};
  }
}

Failure describe_replay_failure(const std::exception_ptr& exception, const std::string& cache) {
  Failure failure = describe_failure(exception);
  if (failure.code != ExitCode::internal) return failure;
  try {
    std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
    return failure;
  } catch (...) {
    return {ExitCode::asset_unreadable, fmt::format("{}: broken: {}", cache, failure.text)};
  }
}

void report(const Failure& failure) {
  // Mistakes of a scene get no prefix: they begin with file and line, as compiler messages do, so
  // that editors can jump there.
  log::info(failure.code == ExitCode::scene_invalid ? failure.text : "weft: " + failure.text);
}

}  // namespace weft::cli
