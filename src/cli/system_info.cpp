#include "cli/system_info.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <iterator>

#include "cli/child_process.hpp"
#include "core/installation.hpp"

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
  const std::string bytes{std::istreambuf_iterator<char>(program), {}};
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace weft::cli
