#include "driver/cost/cores.hpp"

#include "core/parallel/mpi_session.hpp"
#include "driver/cost/control_groups.hpp"

#include <fmt/format.h>

#include <sched.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

namespace thalweg::driver {

namespace {

using CoreSet = std::vector<std::uint64_t>;  // a bit for each core of the machine

// Cores assigned to this process by the scheduler. The system call fails if the set is too small for all cores.
CoreSet own_cores() {
  constexpr std::size_t least = 16, most = 1 << 14;  // for 1024 cores, and for a million
  for (std::size_t words = least; words <= most; words *= 2) {
    CoreSet cores(words);
    if (sched_getaffinity(0, words * sizeof(cores[0]), reinterpret_cast<cpu_set_t*>(cores.data())) == 0) return cores;
    if (errno != EINVAL) break;
  }
  return CoreSet(least);
}

// Number of cores, limited by the quota as well; all of the machine where the system does not tell.
int count_of(const CoreSet& set) {
  int cores = 0;
  for (const std::uint64_t word : set) cores += std::popcount(word);
  if (cores == 0) cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return std::min(cores, limits_of_groups().cores.value_or(cores));
}

// Cores that any rank of the node may use: each rank may have been given its own.
int cores_of(MPI_Comm node) {
  CoreSet set = own_cores();
  std::uint64_t words = set.size();
  MPI_Allreduce(MPI_IN_PLACE, &words, 1, MPI_UINT64_T, MPI_MAX, node);
  set.resize(words);
  MPI_Allreduce(MPI_IN_PLACE, set.data(), static_cast<int>(words), MPI_UINT64_T, MPI_BOR, node);
  return count_of(set);
}

// True if the user, or Open MPI having noticed oversubscription, has set one of these variables.
bool waiting_ranks_yield() {
  for (const char* name : {"OMPI_MCA_mpi_yield_when_idle", "OMPI_MCA_mpi_oversubscribe"})
    if (const char* value = std::getenv(name)) return std::strcmp(value, "0") != 0;
  return false;
}

}  // namespace

int available_cores() { return count_of(own_cores()); }

std::string crowding_warning(MPI_Comm communicator) {
  MPI_Comm node = MPI_COMM_NULL;
  MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, rank_of(communicator), MPI_INFO_NULL, &node);
  const int ranks = size_of(node), cores = cores_of(node);
  MPI_Comm_free(&node);
  struct {
    int too_many, node_of;
  } worst{ranks - cores, rank_of(communicator)};
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_2INT, MPI_MAXLOC, communicator);
  int crowd[2] = {ranks, cores};
  MPI_Bcast(crowd, 2, MPI_INT, worst.node_of, communicator);
  if (worst.too_many <= 0 || waiting_ranks_yield()) return "";
  return fmt::format(
      "{} ranks share {} core{} of a node, and ranks that wait keep the others from working: use at most as many ranks "
      "as cores or, with Open MPI, set OMPI_MCA_mpi_yield_when_idle=1.",
      crowd[0], crowd[1], crowd[1] == 1 ? "" : "s");
}

}  // namespace thalweg::driver
