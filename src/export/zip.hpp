// An archive of one file that is stored as it is: what a packed USD file is (Pixar, "Usdz File Format Specification").
#pragma once

#include <filesystem>
#include <string>

namespace weft::exporter {

/// Writes `content` into `file` under `name`, uncompressed, from a multiple of 64 bytes on, so that readers may map it.
/// The same content gives the same bytes. Throws Error(output_failed), also for what is larger than such files can be.
void write_stored(const std::filesystem::path& file, const std::string& name, const std::string& content);

}  // namespace weft::exporter
