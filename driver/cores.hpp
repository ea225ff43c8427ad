// How many cores the ranks of a node have: fewer cores than ranks cost far more than their share, because ranks that
// wait for a message do so busily.
#pragma once

#include <mpi.h>

#include <optional>
#include <string>

namespace thalweg::driver {

// The whole cores that the text of a cgroup's cpu.max grants, e.g. "150000 100000": 1; at least 1, none if it sets no
// limit.
std::optional<int> cores_by_quota(const std::string& cpu_max);

// A warning with what to do about it if ranks of this communicator outnumber the cores of their node, by the
// scheduler's set and the container's quota, and do not yield; empty otherwise. On the first rank, of the most crowded
// node. Collective.
std::string crowding_warning(MPI_Comm communicator);

}  // namespace thalweg::driver
