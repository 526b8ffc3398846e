#include "core/numerics.hpp"

namespace weft {
namespace {

constexpr Numerics chosen() {
  Numerics chosen;
#ifdef WEFT_CHANGED_NUMERICS  // tests/tools/change_numerics.sh defines it, for example as newton.slow_after *= 10
  chosen.WEFT_CHANGED_NUMERICS;
#endif
  return chosen;
}

}  // namespace

constinit const Numerics numerics = chosen();

}  // namespace weft
