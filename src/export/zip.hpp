// An archive of files that are stored as they are: what a packed USD file is (Pixar, "Usdz File Format Specification").
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::exporter {

struct StoredFile {
  std::string name, content;
};

/// Writes the files, uncompressed, each from a multiple of 64 bytes on, so that readers may map it. The same content
/// gives the same bytes. Throws Error(output_failed), also for what is larger than such files can be.
void write_stored(const std::filesystem::path& file, const std::vector<StoredFile>& files);

}  // namespace weft::exporter
