// Memory of this process.
#pragma once

#include <cstdint>

namespace weft {

/// Maximum resident memory of this process so far [bytes]; 0 if it is not known.
std::int64_t peak_memory_bytes();

/// Current resident memory of this process [bytes]; 0 if /proc is not mounted.
std::int64_t resident_bytes();

}  // namespace weft
