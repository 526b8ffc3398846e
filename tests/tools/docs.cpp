// Rewrites the generated parts of the documentation: weft_docs ROOT, or `ninja docs`.
#include <cstdio>
#include <exception>

#include "core/input_file.hpp"
#include "core/temporary_file.hpp"
#include "docs/generated.hpp"
#include "docs/markdown.hpp"

int main(int argc, char** argv) {
  using namespace weft::docs;
  if (argc != 2) {
    std::fprintf(stderr, "expected: the top folder of the sources\n");
    return 2;
  }
  try {
    const std::filesystem::path root = argv[1];
    for (const auto& file : pages(root)) {
      const std::string old_text = weft::read_file(root / file), text = regenerated(root, file, old_text);
      if (text == old_text) continue;
      weft::write_file(root / file, text);
      std::printf("%s\n", file.c_str());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
