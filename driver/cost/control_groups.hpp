// Limits that control groups set on this process: those of a container, of a batch job, or of one inside the other.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>

namespace thalweg::driver {

struct GroupLimits {
  std::optional<int> cores;                                 // whole ones, at least 1; none: no limit
  double memory = std::numeric_limits<double>::infinity();  // bytes
};

// The tightest limits of any group that the process is in. own_groups: what /proc/self/cgroup says; hierarchies: the
// folder where they are mounted. Of either version of control groups. What cannot be read is no limit.
GroupLimits limits_of_groups(const std::string& own_groups, const std::filesystem::path& hierarchies);

// Limits of this process.
GroupLimits limits_of_groups();

// The whole cores that the text of a cgroup's cpu.max grants, e.g. "150000 100000": 1; at least 1, none if it sets no
// limit.
std::optional<int> cores_by_quota(const std::string& cpu_max);

// Limit in a cgroup's memory.max, bytes; infinity for "max" or an unreadable text.
double memory_by_quota(const std::string& memory_max);

}  // namespace thalweg::driver
