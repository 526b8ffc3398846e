#include "core/numerics.hpp"

namespace weft {
namespace {

constexpr Numerics make_numerics() {
  Numerics result;
#ifdef WEFT_CHANGED_NUMERICS  // tests/tools/change_numerics.sh defines it, for example as newton.slow_after *= 10
  result.WEFT_CHANGED_NUMERICS;
#endif
  return result;
}

}  // namespace

constinit const Numerics numerics = make_numerics();

}  // namespace weft
