// Identifies the processor and the program.
#pragma once

#include <string>

namespace weft::cli {

/// Model name of the processor, or "unknown".
std::string cpu_model();

/// Hash of the program file `weft`, also if the running program is weft-tools; 16 hexadecimal digits.
std::string program_fingerprint();

}  // namespace weft::cli
