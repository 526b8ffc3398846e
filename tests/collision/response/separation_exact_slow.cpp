// Compares separating planes with exact decisions in more than a million queries. separation_exact_test.cpp runs fewer
// queries of the same kinds.
#include "collision/response/separation_exact_meshes.hpp"

namespace weft::collision {
namespace {

TEST(SeparationExactSlow, NoCertificateForPairsThatMeet) {
  expect_nothing_missed(110'000, 1000);
}

TEST(SeparationExactSlow, NoCertificateForPairsThatMeetBesideTheirCommonVertex) {
  expect_nothing_missed_in_fans(60'000, 2000);
}

TEST(SeparationExactSlow, NothingMeetsAfterEnforcement) {
  expect_nothing_meets_after_enforcement(40'000, 3000);
}

}  // namespace
}  // namespace weft::collision
