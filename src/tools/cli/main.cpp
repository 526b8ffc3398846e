#include "tools/cli/main.hpp"

#include <unistd.h>

#if defined(__x86_64__) && defined(__AVX2__)

// Checks the processor before any other initialisation of the program (101 is the first constructor priority that
// programs may use). The function is compiled for all x86-64 processors, so that on an old processor the program prints
// a message instead of crashing at an unknown instruction.
__attribute__((constructor(101), target("arch=x86-64"))) static void check_cpu() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return;
  static constexpr char kText[] =
      "weft: this program is built for x86-64-v3 processors (AVX2 and FMA), and this one is older; "
      "build it with cmake --preset release -DWEFT_CPU=x86-64 && ninja -C build weft\n";
  if (::write(STDERR_FILENO, kText, sizeof kText - 1) < 0) ::_exit(1);
  ::_exit(1);
}

#endif

int main(int argc, char** argv) {
  return WEFT_RUN(argc, argv);
}
