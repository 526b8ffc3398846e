// The readers of what comes from outside, each as a function of bytes, for the fuzzer and for the test of its corpus.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace weft::fuzz {

/// Reads the bytes. Whatever they are, they are understood or refused as the reader's header says; anything else, also
/// a result that breaks what the reader promises, is thrown as std::logic_error or found by a sanitizer.
struct Target {
  std::string_view name;  ///< its corpus is the folder corpus/<name>
  void (*read)(std::span<const std::uint8_t> bytes);
};

std::span<const Target> targets();

}  // namespace weft::fuzz
