// The share of a machine's memory that a run takes, and the refusal of one that does not fit.
#include "driver/cost/memory.hpp"

#include "core/base/error.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/cost/machine.hpp"
#include "driver/cost/run_cost.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::memory_test {
namespace {

std::string refusal(double needed, double on_node, double there) {
  try {
    refuse_without_memory(needed, on_node, there);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Memory, IsRefusedWhereTheMachineHasLess) {
  EXPECT_EQ(refusal(20e9, 20e9, 24e9), "");
  EXPECT_TRUE(contains(refusal(95e9, 95e9, 24e9),
                       "takes about 95 GB of memory, and this machine has 24 GB: use at least 5 such nodes"));
  EXPECT_EQ(refusal(80e9, 20e9, 24e9), "");  // on four nodes
  EXPECT_TRUE(contains(refusal(80e9, 40e9, 24e9), "80 GB of memory, 40 GB of it on one node, and that has 24 GB"));
}

TEST(Memory, ReportSaysWhatIsNotThere) {
  EXPECT_EQ(memory_line(10e9, 24e9), "memory     about 10 GB on one rank");
  EXPECT_TRUE(contains(memory_line(95e9, 24e9), ": more than the 24 GB of this machine"));
}

TEST(Memory, OfThisNode) {
  EXPECT_GT(memory_of_this_node(), 1e8);
  EXPECT_GT(free_memory_for_runs(), 1e7);
  EXPECT_LT(free_memory_for_runs(), memory_of_this_node());
}

// At least 19 single-precision values a cell beside the program, and not more than twice that with flags and the links
// of 1000 grains; the machine of a test has it.
TEST(Memory, IsThatOfTheLatticeAboveAll) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  const double lattice = 240.0 * 80.0 * 212.0 * 19.0 * 4.0;
  EXPECT_GT(memory_on_one_rank(c), bytes_of_program() + lattice);
  EXPECT_LT(memory_on_one_rank(c), bytes_of_program() + 2.0 * lattice);
  EXPECT_NO_THROW(refuse_without_memory(c));
  c.domain.size = Vec3(12.0, 40.0, 106.0);
  EXPECT_THROW(refuse_without_memory(c), InputError);
}

// Caches hold the lattice of a small box, and the speed of one in the flume's resolution is that of memory.
TEST(Memory, BoundsTheSpeedOfLargeLattices) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  EXPECT_EQ(bytes_of_lattice(c), 240.0 * 80.0 * 212.0 * 19.0 * 4.0);
  EXPECT_TRUE(exceeds_caches(bytes_of_lattice(c)));
  c.domain.size = Vec3(0.020, 0.010, 0.020);
  EXPECT_FALSE(exceeds_caches(bytes_of_lattice(c)));
  c.system = SystemKind::grains;
  EXPECT_EQ(bytes_of_lattice(c), 0.0);
}

// 72 bytes in the book of the reach and 27 columns of static pixels, of eight bytes, with their place, of each id.
TEST(Memory, OfMeasurementsOfEveryGrain) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  const double before = memory_on_one_rank(c);
  c.analysis.observers.of<analysis::ReachKeys>().emplace();
  const double ids = ids_of_run(c), more = memory_on_one_rank(c) - before;
  EXPECT_EQ(ids, static_cast<double>(grain_rows(c)));
  EXPECT_GT(more, 200.0 * ids);
  EXPECT_LT(more, 400.0 * ids);
}

// Grains that are supplied and leave again take no room of their own, but their ids do: 72 bytes for hops.
TEST(Memory, OfMeasurementsGrowsWithWhatIsSupplied) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  c.analysis.observers.of<analysis::TransportRateKeys>().emplace();
  c.run.until = 10.0;
  const double rows = static_cast<double>(grain_rows(c));
  beds::SupplyKeys supply;
  supply.rate = 1e5;
  supply.from = 2.0;
  c.supplies = {supply};
  c.sinks.resize(1);
  EXPECT_NEAR(ids_of_run(c), rows + 8e5, 1.0);
  const double more = memory_of_observers(c).of_ids;
  EXPECT_NEAR(more, 1.5 * 72.0 * ids_of_run(c), 0.01 * more);
  supply.rate = 1e4;
  c.supplies.push_back(supply);  // ids of which most are not used
  EXPECT_NEAR(ids_of_run(c), rows + 1.6e6, 1.0);
  const double on_one = memory_on_one_rank(c);
  c.supplies.clear();
  EXPECT_GT(on_one, memory_on_one_rank(c) + 60.0 * 1.6e6);
}

}  // namespace
}  // namespace thalweg::driver::memory_test
