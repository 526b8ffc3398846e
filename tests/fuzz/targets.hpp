// All readers of external input, each as a function of bytes, for the fuzzer and for the test of its corpus.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace weft::fuzz {

/// Reads any bytes, which are accepted or refused as the reader's header states. Anything else, including a result that
/// breaks a promise of the reader, is thrown as std::logic_error or found by a sanitizer.
struct Target {
  std::string_view name;  ///< its corpus is the folder corpus/<name>
  void (*read)(std::span<const std::uint8_t> bytes);
};

std::span<const Target> targets();

}  // namespace weft::fuzz
