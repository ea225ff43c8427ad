#include "driver/cost/memory.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "driver/cost/control_groups.hpp"
#include "driver/cost/disk_space.hpp"
#include "driver/cost/performance_model.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/setup/build_system.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace thalweg::driver {

namespace {

constexpr double usable = 0.9;  // of a node; the rest is the system's

// Value of an entry of a file in /proc, KiB; 0 if it is missing.
double kibibytes_in(const char* file, const char* name) {
  std::ifstream status(file);
  for (std::string word; status >> word;)
    if (double kibibytes = 0.0; word == name && status >> kibibytes) return kibibytes;
  return 0.0;
}

}  // namespace

double memory_of_this_node() {
  const double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return std::min(bytes, limits_of_groups().memory);
}

double free_memory_for_runs() {
  const double free = 1024.0 * kibibytes_in("/proc/meminfo", "MemAvailable:"), there = memory_of_this_node();
  return usable * (free > 0.0 ? std::min(free, there) : there);
}

double usable_memory_of_this_node() { return usable * memory_of_this_node(); }

double memory_on_one_rank(const Case& c) {
  if (c.system == SystemKind::continuum) return bytes_of_program();
  return rank_work(c, decomposition_of(c, {1, 1, 1}), 0).memory;
}

std::string memory_line(double needed, double there) {
  std::string line = "memory     about " + bytes_text(needed) + " on one rank";
  if (needed > usable * there) line += fmt::format(": more than the {} of this machine", bytes_text(there));
  return line;
}

void refuse_without_memory(double needed, double on_node, double there) {
  if (on_node <= usable * there) return;
  throw InputError(fmt::format(
      "the run takes about {} of memory{}, and {} has {}: use at least {:.0f} such nodes (planned by check "
      "--ranks), a larger domain.spacing, or fewer grains.",
      bytes_text(needed), on_node < needed ? fmt::format(", {} of it on one node", bytes_text(on_node)) : "",
      on_node < needed ? "that" : "this machine", bytes_text(there), std::ceil(needed / (usable * there))));
}

void refuse_without_memory(const Case& c) {
  const double needed = memory_on_one_rank(c);
  refuse_without_memory(needed, needed, memory_of_this_node());
}

void refuse_without_memory(const Case& c, MPI_Comm communicator, const Index3& layout) {
  if (c.system == SystemKind::continuum) return;
  MPI_Comm node = MPI_COMM_NULL;
  MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, rank_of(communicator), MPI_INFO_NULL, &node);
  const double mine = rank_work(c, decomposition_of(c, layout), rank_of(communicator)).memory;
  const double on_node = sum_over_ranks(node, mine), there = memory_of_this_node();
  MPI_Comm_free(&node);
  struct {
    double load;
    int rank;
  } fullest{on_node / there, rank_of(communicator)};
  MPI_Allreduce(MPI_IN_PLACE, &fullest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, communicator);
  double worst[2] = {on_node, there};
  MPI_Bcast(worst, 2, MPI_DOUBLE, fullest.rank, communicator);
  refuse_without_memory(sum_over_ranks(communicator, mine), worst[0], worst[1]);
}

void forget_largest_memory() { std::ofstream("/proc/self/clear_refs") << 5; }  // proc(5)

MemoryUse memory_use(MPI_Comm communicator) {
  const double mine = 1024.0 * kibibytes_in("/proc/self/status", "VmHWM:");
  return {sum_over_ranks(communicator, mine), max_over_ranks(communicator, mine)};
}

}  // namespace thalweg::driver
