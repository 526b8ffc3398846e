#include "film/image/shrink.hpp"

#include <gtest/gtest.h>

namespace weft::image {
namespace {

TEST(Shrink, IsTheMeanOfWhatAPixelCovers) {
  Image image(4, 2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) image.pixel(x, y)[2] = static_cast<std::uint8_t>(10 * x + y);
  }
  const Image small = shrink(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.pixel(0, 0)[2], 6);   // mean of 0, 10, 1 and 11: 5.5
  EXPECT_EQ(small.pixel(1, 0)[2], 26);  // mean of 20, 30, 21 and 31: 25.5
  EXPECT_EQ(shrink(image, 4).rgb, image.rgb);
  EXPECT_EQ(shrink(image, 9).width, 4) << "nothing is gained by larger ones";
}

}  // namespace
}  // namespace weft::image
