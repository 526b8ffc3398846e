// Memory of this process.
#pragma once

#include <cstdint>

namespace weft {

/// Maximum resident memory of this process so far [bytes].
std::int64_t peak_memory_bytes();

/// Current resident memory [bytes].
std::int64_t resident_bytes();

}  // namespace weft
