// All readers of external input, each as a function of bytes, for the fuzzer and for the test of its corpus.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace weft::fuzz {

/// Reads any bytes. The reader must accept or refuse them as its header states. Any other result is an error:
/// std::logic_error if a promise of the reader is broken, or a report of a sanitizer.
struct Target {
  std::string_view name;  ///< its corpus is the folder corpus/<name>
  void (*read)(std::span<const std::uint8_t> bytes);
};

std::span<const Target> targets();

}  // namespace weft::fuzz
