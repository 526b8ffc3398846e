// What machine this is and what it gave us.
#pragma once

#include <string>

namespace weft::cli {

/// Model name of the processor; "unknown" where the system does not tell.
std::string cpu_model();

/// The same for the very same program only, 16 hexadecimal digits.
std::string program_fingerprint();

}  // namespace weft::cli
