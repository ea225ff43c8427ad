#include "driver/cores.hpp"

#include "core/mpi_session.hpp"

#include <fmt/format.h>

#include <sched.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace thalweg::driver {

namespace {

// Cores that any rank of the node may use: each rank may have been given its own.
int cores_of(MPI_Comm node) {
  cpu_set_t mine;
  CPU_ZERO(&mine);
  sched_getaffinity(0, sizeof(mine), &mine);
  std::array<std::uint64_t, sizeof(cpu_set_t) / sizeof(std::uint64_t)> bits{};
  std::memcpy(bits.data(), &mine, sizeof(mine));
  MPI_Allreduce(MPI_IN_PLACE, bits.data(), static_cast<int>(bits.size()), MPI_UINT64_T, MPI_BOR, node);
  int cores = 0;
  for (const std::uint64_t word : bits) cores += __builtin_popcountll(word);
  std::ifstream file("/sys/fs/cgroup/cpu.max");
  std::string quota;
  if (std::getline(file, quota)) cores = std::min(cores, cores_by_quota(quota).value_or(cores));
  return cores;
}

// As the user tells Open MPI, or as it tells its ranks where it has noticed too many of them itself.
bool waiting_ranks_yield() {
  for (const char* name : {"OMPI_MCA_mpi_yield_when_idle", "OMPI_MCA_mpi_oversubscribe"})
    if (const char* value = std::getenv(name)) return std::strcmp(value, "0") != 0;
  return false;
}

}  // namespace

std::optional<int> cores_by_quota(const std::string& cpu_max) {
  long quota = 0, period = 0;
  const char* end = cpu_max.data() + cpu_max.size();
  const auto first = std::from_chars(cpu_max.data(), end, quota);
  if (first.ec != std::errc() || first.ptr == end) return std::nullopt;  // "max 100000"
  if (std::from_chars(first.ptr + 1, end, period).ec != std::errc() || period <= 0) return std::nullopt;
  return std::max(1, static_cast<int>(quota / period));
}

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
