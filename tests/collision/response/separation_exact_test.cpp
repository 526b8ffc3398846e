// Compares separating planes with exact decisions. separation_exact_slow.cpp runs more queries of the same kinds.
#include "collision/response/separation_exact_meshes.hpp"

namespace weft::collision {
namespace {

TEST(SeparationExact, NoCertificateForPairsThatMeet) {
  expect_nothing_missed(4'000, 1);
}

TEST(SeparationExact, NoCertificateForPairsThatMeetBesideTheirCommonVertex) {
  expect_nothing_missed_in_fans(2'000, 2);
}

TEST(SeparationExact, NothingMeetsAfterEnforcement) {
  expect_nothing_meets_after_enforcement(1'000, 3);
}

}  // namespace
}  // namespace weft::collision
