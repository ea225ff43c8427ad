#include "driver/check_report.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver {
namespace {

TEST(CheckReport, SaysHowManyNodesTheMemoryTakes) {
  EXPECT_EQ(memory_line(10e9, 24e9), "memory     about 10 GB");
  EXPECT_EQ(memory_line(95e9, 24e9),
            "memory     about 95 GB: more than the 24 GB of this machine; take at least 5 such nodes");
}

TEST(Cost, CountsCellsAndSteps) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  const Cost cost = cost_of(c, 10e9);
  EXPECT_EQ(cost.cells, 240.0 * 80.0 * 212.0);
  EXPECT_EQ(cost.steps, 1.5e6);  // 30 s of 2e-5 s
  EXPECT_EQ(cost.cell_updates, cost.cells * 1.5e6);
  EXPECT_EQ(cost.grain_steps, 1000.0 * 50.0 * 1.5e6);
  // At least 19 single-precision values a cell, and not more than twice that with flags and the links of 1000 grains.
  EXPECT_GT(cost.memory, cost.cells * 19 * 4);
  EXPECT_LT(cost.memory, cost.cells * 19 * 4 * 2);
  const Cost on_faster_memory = cost_of(c, 20e9);
  EXPECT_LT(on_faster_memory.core_seconds, cost.core_seconds);
  EXPECT_GT(on_faster_memory.core_seconds, 0.5 * cost.core_seconds);  // the grains do not get faster
}

// A link takes 10 ns (docs/architecture.md) and up to four times that on other machines, and the sweep half of what
// that bandwidth allows: the 1.6 million links of 1000 grains, 10 cells each, cost several times as much as the water
// without them.
TEST(Cost, TakesAccountOfTheLinks) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  const double with_grains = cost_of(c, 42e9).core_seconds;
  c.grains.clear();
  const double water = cost_of(c, 42e9).core_seconds;
  EXPECT_NEAR(water, 1.5e6 * 240.0 * 80.0 * 212.0 * 152.0 / (0.5 * 42e9), 0.5 * water);
  EXPECT_GT(with_grains - water, 1.5e6 * 1.58e6 * 10e-9);
  EXPECT_LT(with_grains - water, 1.5e6 * (1.58e6 * 40e-9 + 50.0 * 1000.0 * 400e-9));
}

TEST(CheckReport, AsksForContactsAsLongAsSoundGoesAroundAGrain) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  const auto line = [&c]() -> std::string {
    for (const std::string& text : check_report(c, 10e9))
      if (text.starts_with("rebound")) return text;
    return {};
  };
  // Ten cells a diameter: pi 5 sqrt(3) = 27.2 steps around.
  EXPECT_NE(line().find("the 27.2 that sound takes around a grain"), std::string::npos) << line();
  // A contact lasts pi sqrt(m/(2 k)): as long as that with the stiffness that the line asks for, m = pi/6 d^3 rho.
  const double mass = std::numbers::pi / 6.0 * std::pow(5e-3, 3) * c.grains[0].density;
  const double longest = 0.5 * mass * std::pow(std::numbers::pi / (27.2 * *c.fluid.time_step), 2);
  c.contact.normal_stiffness = 1.01 * longest;
  EXPECT_NE(line(), "");
  c.contact.normal_stiffness = 0.99 * longest;
  EXPECT_EQ(line(), "");
}

}  // namespace
}  // namespace thalweg::driver
