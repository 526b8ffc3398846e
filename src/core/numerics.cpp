#include "core/numerics.hpp"

namespace weft {
namespace {

constexpr Numerics chosen() {
  Numerics chosen;
#ifdef WEFT_CHANGED_NUMERICS  // defined by tests/tools/change_numerics.sh, as a statement
  chosen.WEFT_CHANGED_NUMERICS;
#endif
  return chosen;
}

}  // namespace

constinit const Numerics numerics = chosen();

}  // namespace weft
