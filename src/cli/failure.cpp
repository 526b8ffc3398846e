#include "cli/failure.hpp"

#include <filesystem>
#include <new>
#include <system_error>

#include "core/log.hpp"

namespace weft::cli {

Failure describe_failure(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::internal, "out of memory; a smaller scene or picture may fit"};
  } catch (const std::filesystem::filesystem_error& error) {
    // A path that nobody has asked about beforehand: no folder, too long a name, no permission.
    const bool too_long = error.code() == std::errc::filename_too_long;
    return {too_long ? ExitCode::usage : ExitCode::output_failed,
            fmt::format("{}: cannot be used: {}", error.path1().string().substr(0, 200), error.code().message())};
  } catch (const std::exception& error) {
    return {ExitCode::internal, fmt::format("unexpected: {}", error.what())};
  } catch (...) {
    return {ExitCode::internal, "unexpected: an exception of unknown type"};
  }
}

void report(const Failure& failure) {
  // Mistakes of a scene name their file first, as compilers do, so that editors can jump there.
  log::info(failure.code == ExitCode::scene_invalid ? failure.text : "weft: " + failure.text);
}

}  // namespace weft::cli
