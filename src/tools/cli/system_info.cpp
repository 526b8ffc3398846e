#include "tools/cli/system_info.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <fstream>
#include <memory>

#include "core/installation.hpp"
#include "tools/cli/child_process.hpp"

namespace weft::cli {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string program_fingerprint() {
  std::ifstream program(own_installation().code.replace_filename(own_program().filename()), std::ios::binary);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::array<char, 65536> bytes;
  while (program.read(bytes.data(), bytes.size()), program.gcount() > 0)
    XXH3_64bits_update(state.get(), bytes.data(), static_cast<std::size_t>(program.gcount()));
  return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

}  // namespace weft::cli
