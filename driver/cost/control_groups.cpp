#include "driver/cost/control_groups.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <vector>

namespace thalweg::driver {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

void tighten(GroupLimits& limits, const fs::path& group) {
  const std::string quota_v1 = first_line(group / "cpu.cfs_quota_us") + " " + first_line(group / "cpu.cfs_period_us");
  for (const std::string& quota : {first_line(group / "cpu.max"), quota_v1})
    if (const std::optional<int> cores = cores_by_quota(quota))
      limits.cores = std::min(*cores, limits.cores.value_or(*cores));
  for (const char* name : {"memory.max", "memory.limit_in_bytes"})
    limits.memory = std::min(limits.memory, memory_by_quota(first_line(group / name)));
}

// The group at `path` in a hierarchy, and those it is in. In a container the path may be that of the machine outside,
// which is not there; its root is.
void tighten_up_to_the_root(GroupLimits& limits, const fs::path& hierarchy, fs::path path) {
  for (path = path.relative_path(); !path.empty(); path = path.parent_path()) tighten(limits, hierarchy / path);
  tighten(limits, hierarchy);
}

}  // namespace

GroupLimits limits_of_groups(const std::string& own_groups, const fs::path& hierarchies) {
  GroupLimits limits;
  std::istringstream lines(own_groups);
  for (std::string line; std::getline(lines, line);) {  // NUMBER:CONTROLLERS:PATH, without controllers in version 2
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (controllers.empty())
      for (const fs::path& hierarchy : {hierarchies, hierarchies / "unified"})
        tighten_up_to_the_root(limits, hierarchy, path);
    std::istringstream names(controllers);
    for (std::string name; std::getline(names, name, ',');)
      for (const std::string& folder : {name, controllers})
        if (name == "cpu" || name == "memory") tighten_up_to_the_root(limits, hierarchies / folder, path);
  }
  return limits;
}

GroupLimits limits_of_groups() {
  std::ifstream file("/proc/self/cgroup");
  std::ostringstream text;
  text << file.rdbuf();
  return limits_of_groups(text.str(), "/sys/fs/cgroup");
}

std::optional<int> cores_by_quota(const std::string& cpu_max) {
  long quota = 0, period = 0;
  const char* end = cpu_max.data() + cpu_max.size();
  const auto first = std::from_chars(cpu_max.data(), end, quota);
  if (first.ec != std::errc() || first.ptr == end || quota <= 0) return std::nullopt;  // "max 100000", "-1 100000"
  if (std::from_chars(first.ptr + 1, end, period).ec != std::errc() || period <= 0) return std::nullopt;
  return std::max(1, static_cast<int>(quota / period));
}

double memory_by_quota(const std::string& memory_max) {
  double bytes = 0.0;
  const char* end = memory_max.data() + memory_max.size();
  const bool is_number = std::from_chars(memory_max.data(), end, bytes).ec == std::errc();
  return is_number && bytes > 0.0 ? bytes : std::numeric_limits<double>::infinity();
}

}  // namespace thalweg::driver
