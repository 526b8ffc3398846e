#include "cli/failure.hpp"

#include <new>

namespace weft::cli {

Failure describe_failure(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::internal, "out of memory; a smaller scene or picture may fit"};
  } catch (const std::exception& error) {
    return {ExitCode::internal, fmt::format("unexpected: {}", error.what())};
  } catch (...) {
    return {ExitCode::internal, "unexpected: an exception of unknown type"};
  }
}

}  // namespace weft::cli
