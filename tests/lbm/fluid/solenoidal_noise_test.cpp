// Random eddies to start from: no divergence, no mean, nothing left at walls, the strength asked for.
#include "lbm/fluid/solenoidal_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::lbm::solenoidal_noise_test {
namespace {

const NoiseBox flume{{48, 21, 30}, {true, false, false}, 6.0};

TEST(SolenoidalNoise, HasNoDivergenceByCentralDifferences) {
  const SolenoidalNoise noise(flume, 7);
  double largest = 0.0, strongest = 0.0;
  for (int z = 1; z < flume.cells[2] - 1; ++z)
    for (int y = 1; y < flume.cells[1] - 1; ++y)
      for (int x = 0; x < flume.cells[0]; ++x) {
        const int east = (x + 1) % flume.cells[0], west = (x + flume.cells[0] - 1) % flume.cells[0];
        const double divergence = 0.5 * (noise.velocity({east, y, z}).x() - noise.velocity({west, y, z}).x() +
                                         noise.velocity({x, y + 1, z}).y() - noise.velocity({x, y - 1, z}).y() +
                                         noise.velocity({x, y, z + 1}).z() - noise.velocity({x, y, z - 1}).z());
        largest = std::max(largest, std::abs(divergence));
        strongest = std::max(strongest, noise.velocity({x, y, z}).norm());
      }
  // Each of the 12 products is rounded at the size of the potential, at most the velocity over the smallest wave number
  // 2 pi/48 for each of 32 modes: round-off of 1e-16 x 32 x 8 x 12.
  EXPECT_LT(largest, 3e-13);
  EXPECT_GT(strongest, 1.0);
}

TEST(SolenoidalNoise, LeavesTheMeanAlongEveryLineAlone) {
  const SolenoidalNoise noise(flume, 3);
  for (int z = 0; z < flume.cells[2]; z += 3)
    for (int y = 0; y < flume.cells[1]; y += 4) {
      Vec3 sum = Vec3::Zero();
      for (int x = 0; x < flume.cells[0]; ++x) sum += noise.velocity({x, y, z});
      EXPECT_LT(sum.norm() / flume.cells[0], 1e-13) << y << " " << z;
    }
}

TEST(SolenoidalNoise, FadesTowardsWallsAndBelowTheBed) {
  const NoiseBox box{{48, 48, 96}, {true, true, false}, 16.0};
  const auto strength = [&](int z) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const SolenoidalNoise noise(box, seed);
      for (int y = 0; y < 48; y += 2)
        for (int x = 0; x < 48; x += 2) sum += noise.velocity({x, y, z}).squaredNorm();
    }
    return std::sqrt(sum / (8 * 24 * 24) / 3.0);
  };
  EXPECT_EQ(strength(10), 0.0);
  EXPECT_EQ(strength(14), 0.0);
  // Half a cell from the floor p = 4 s (1 - s) = 0.025, e = 2 p^2 = 0.0012; its slope 4 p 4/80 = 0.005 acts on a
  // potential of 1/k up to 96/(2 pi) = 15: below 0.1.
  EXPECT_LT(strength(16), 0.1);
  EXPECT_LT(strength(95), 0.1);
  EXPECT_GT(strength(56), 0.9);
}

// Central differences along an axis of one or two cells are zero, and so is the wave number that they see: a mode that
// varied along it alone would have a potential without limit.
TEST(SolenoidalNoise, VariesAlongOtherAxesWhereAPeriodicOneIsThin) {
  // 32 modes of sqrt(6/32) each, twice that where the envelope rises.
  const double most = 2.0 * 32.0 * std::sqrt(6.0 / 32.0);
  for (const int width : {1, 2}) {
    const SolenoidalNoise noise({{60, width, 30}, {false, true, false}, 0.0}, 3);
    double strongest = 0.0;
    for (int z = 0; z < 30; ++z)
      for (int y = 0; y < width; ++y)
        for (int x = 0; x < 60; ++x) strongest = std::max(strongest, noise.velocity({x, y, z}).norm());
    EXPECT_GT(strongest, 1.0) << width;
    EXPECT_LT(strongest, most) << width;
  }
  EXPECT_EQ(SolenoidalNoise({{2, 2, 2}, {true, true, true}, 0.0}, 3).velocity({0, 1, 0}), Vec3(Vec3::Zero()));
}

TEST(SolenoidalNoise, HasTheStrengthAskedFor) {
  // In a periodic box the mean square of all modes adds up exactly, but for pairs with the same wave number: 32 modes
  // on 8 x 9 x 9 wave numbers share one in half the boxes, each changing the sum by at most 2/32.
  const NoiseBox box{{32, 32, 32}, {true, true, true}, 0.0};
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const SolenoidalNoise noise(box, seed);
    double sum = 0.0;
    for (int z = 0; z < 32; ++z)
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) sum += noise.velocity({x, y, z}).squaredNorm();
    EXPECT_NEAR(sum / (3 * 32 * 32 * 32), 1.0, 0.2) << seed;
  }
  EXPECT_NE(SolenoidalNoise(box, 1).velocity({3, 4, 5}), SolenoidalNoise(box, 2).velocity({3, 4, 5}));
  EXPECT_EQ(SolenoidalNoise(box, 1).velocity({3, 4, 5}), SolenoidalNoise(box, 1).velocity({3, 4, 5}));
}

}  // namespace
}  // namespace thalweg::lbm::solenoidal_noise_test
