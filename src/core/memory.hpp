// What the system says of the memory of this process.
#pragma once

#include <cstdint>

namespace weft {

/// The most memory that the process held so far [bytes].
std::int64_t peak_memory_bytes();

/// What it holds now [bytes].
std::int64_t memory_bytes();

}  // namespace weft
