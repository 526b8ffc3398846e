// A zip archive of uncompressed files, as packed USD requires (Pixar, "Usdz File Format Specification").
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::exporter {

struct StoredFile {
  std::string name, content;
};

/// Writes the files uncompressed, each aligned to 64 bytes, so that readers may map them into memory. The same content
/// gives the same bytes. Throws Error(output_failed), also if the archive would exceed 4 GiB.
void write_stored(const std::filesystem::path& file, const std::vector<StoredFile>& files);

}  // namespace weft::exporter
