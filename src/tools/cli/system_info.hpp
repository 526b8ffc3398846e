// Identification of machine and program.
#pragma once

#include <string>

namespace weft::cli {

/// Model name of the processor, or "unknown".
std::string cpu_model();

/// A hash of the program file `weft`, also in the tools program; 16 hexadecimal digits.
std::string program_fingerprint();

}  // namespace weft::cli
