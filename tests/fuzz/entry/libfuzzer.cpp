// Entry point of libFuzzer: the function that the fuzzer calls for each input. There is one program for each target.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const weft::fuzz::Target kTarget = [] {
    for (const weft::fuzz::Target& target : weft::fuzz::targets())
      if (target.name == WEFT_FUZZ_TARGET) return target;
    throw std::logic_error("no target is called " WEFT_FUZZ_TARGET);
  }();
  kTarget.read({data, size});
  return 0;
}
