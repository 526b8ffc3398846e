// A library opened by name at run time, for backends that may be absent.
#pragma once

#include <string>

namespace weft::render {

/// A library that stays open until the process ends, because software rasterisers keep threads and LLVM data.
class SharedLibrary {
 public:
  /// Throws Error(usage) with the dynamic loader's message if the library cannot be opened.
  explicit SharedLibrary(const std::string& file);

  /// Address of a function; throws Error(usage) if the library lacks it.
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
