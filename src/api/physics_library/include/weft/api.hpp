// Marks the symbols that the shared library exports.
#pragma once

#if __cplusplus < 202002L
#error "Weft needs C++20: -std=c++20, or CMAKE_CXX_STANDARD 20"
#endif

#define WEFT_API __attribute__((visibility("default")))
