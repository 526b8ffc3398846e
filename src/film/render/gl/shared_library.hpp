// A library opened by name at run time, for backends that may be absent.
#pragma once

#include <string>

namespace weft::render {

/// A library that stays open until the process ends, because software rasterisers keep threads and LLVM data.
class SharedLibrary {
 public:
  /// Throws Error(usage) with the dynamic loader's message if the library cannot be opened.
  explicit SharedLibrary(const std::string& file);

  /// Converts to a pointer to a function of any type.
  struct Function {
    void* address;
    template <class Type>
    operator Type*() const {
      return reinterpret_cast<Type*>(address);
    }
  };
  /// Throws Error(usage) if the library lacks the function.
  Function function(const char* name) const;

 private:
  std::string file_;
  void* handle_ = nullptr;
};

}  // namespace weft::render
