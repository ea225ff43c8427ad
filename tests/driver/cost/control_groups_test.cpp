// Limits set by control groups, of both versions and nested, in made-up hierarchies.
#include "driver/cost/control_groups.hpp"

#include "driver/cost/cores.hpp"
#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

namespace thalweg::driver::control_groups_test {
namespace {

using testing::put;
using testing::ScratchFolder;

TEST(ControlGroups, GrantWholeCores) {
  EXPECT_EQ(cores_by_quota("400000 100000"), 4);
  EXPECT_EQ(cores_by_quota("150000 100000\n"), 1);
  EXPECT_EQ(cores_by_quota("50000 100000"), 1);
  for (const char* none : {"max 100000", "", "100000", "-1 100000", " "})
    EXPECT_EQ(cores_by_quota(none), std::nullopt) << none;
}

TEST(ControlGroups, GrantMemory) {
  EXPECT_EQ(memory_by_quota("8589934592"), 8589934592.0);
  EXPECT_TRUE(std::isinf(memory_by_quota("max")));
  EXPECT_TRUE(std::isinf(memory_by_quota("")));
}

// Groups as Slurm arranges them: the limit of the memory is the job's, that of the cores the step's.
TEST(ControlGroups, OfAJobAreThoseOfAllGroupsAboveTheProcess) {
  const ScratchFolder folder;
  const std::filesystem::path job = folder.path() / "system.slice/slurmstepd.scope/job_17";
  put(job / "memory.max", "8589934592");
  put(job / "cpu.max", "max 100000");
  put(job / "step_0/memory.max", "max");
  put(job / "step_0/cpu.max", "300000 100000");
  const GroupLimits own = limits_of_groups("0::/system.slice/slurmstepd.scope/job_17/step_0\n", folder.path());
  EXPECT_EQ(own.memory, 8589934592.0);
  EXPECT_EQ(own.cores, 3);
  const GroupLimits others = limits_of_groups("0::/system.slice/cron\n", folder.path());
  EXPECT_TRUE(std::isinf(others.memory));
  EXPECT_EQ(others.cores, std::nullopt);
}

// In a container: the path may be that of the machine outside, and what there is lies at the root.
TEST(ControlGroups, OfAContainerAreAtTheRoot) {
  const ScratchFolder folder;
  put(folder.path() / "memory.max", "4294967296");
  put(folder.path() / "cpu.max", "200000 100000");
  for (const char* groups : {"0::/\n", "0::/docker/4711\n", "0::/../../pod\n"}) {
    const GroupLimits own = limits_of_groups(groups, folder.path());
    EXPECT_EQ(own.memory, 4294967296.0) << groups;
    EXPECT_EQ(own.cores, 2) << groups;
  }
}

TEST(ControlGroups, OfTheFirstVersionHaveHierarchiesOfTheirOwn) {
  const ScratchFolder folder;
  put(folder.path() / "memory/slurm/job_17/memory.limit_in_bytes", "8589934592");
  put(folder.path() / "memory/memory.limit_in_bytes", "9223372036854771712");  // none
  put(folder.path() / "cpu,cpuacct/slurm/job_17/cpu.cfs_quota_us", "600000");
  put(folder.path() / "cpu,cpuacct/slurm/job_17/cpu.cfs_period_us", "100000");
  put(folder.path() / "cpu,cpuacct/cpu.cfs_quota_us", "-1");
  put(folder.path() / "cpu,cpuacct/cpu.cfs_period_us", "100000");
  const std::string groups =
      "9:memory:/slurm/job_17/step_0\n4:cpu,cpuacct:/slurm/job_17/step_0\n1:name=systemd:/x\n0::/x\n";
  const GroupLimits own = limits_of_groups(groups, folder.path());
  EXPECT_EQ(own.memory, 8589934592.0);
  EXPECT_EQ(own.cores, 6);
}

TEST(Cores, ThisProcessHasSome) { EXPECT_GE(available_cores(), 1); }

}  // namespace
}  // namespace thalweg::driver::control_groups_test
