// A library opened by name, for backends that may be absent.
#pragma once

#include <string>

namespace weft::render {

/// Stays open for the life of the process: a software rasteriser leaves threads and LLVM state behind.
class SharedLibrary {
 public:
  /// Throws Error(usage), as of a package that is missing, with the dynamic loader's words.
  explicit SharedLibrary(const std::string& file);

  /// Address of a function; throws Error(usage) where the library has none of that name.
  template <class Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(address(name));
  }

 private:
  void* address(const char* name) const;

  std::string file_;
  void* handle_ = nullptr;
};

}  // namespace weft::render
