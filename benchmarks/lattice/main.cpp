// How fast the lattice runs, and how near that is to what the machine's memory allows.
//
//   mpirun -n RANKS benchmarks/lattice [NX NY NZ]
//
// Measures the bandwidth of an in-place update with all ranks at once, then the sweep with eddies and body force for
// every storage and collision, with Smagorinsky's model (bgk also with a bulk viscosity of its own) and as water with
// grains has it by default, in a periodic box and in a channel. A cell
// update moves 19 populations in and 19 out: 304 bytes in double, 152 in single; the limit is the bandwidth over that.
// Memory is given as the layout's arithmetic has it (19 populations and a word of the map for every cell, ghost and
// pad) and as the system counts it. The best of many short runs counts, because whatever else the machine does can only
// make a run slower. Ends with one line of JSON.
#include "benchmarks/lattice/bandwidth.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace thalweg::benchmark {
namespace {

struct Box {
  const char* name;
  lbm::FaceConditions faces;
};

std::vector<Box> boxes() {
  using lbm::FaceType;
  Box periodic{"periodic", {}}, channel{"channel", {}};
  channel.faces[2].type = channel.faces[3].type = FaceType::law_of_the_wall;
  channel.faces[4].type = FaceType::no_slip;
  channel.faces[5].type = FaceType::free_slip;
  return {periodic, channel};
}

template <typename Real>
constexpr double bytes_per_update = 2.0 * lbm::D3Q19::directions * sizeof(Real);

struct Collision {
  const char* name;
  lbm::CollisionModel model;
  lbm::Subgrid subgrid = lbm::Subgrid::smagorinsky(0.27);
  double bulk_relaxation_time = 0.0;
};

const Collision collisions[] = {
    {"bgk", lbm::CollisionModel::bgk},
    {"bgk, bulk", lbm::CollisionModel::bgk, lbm::Subgrid::smagorinsky(0.27), 3.0},
    {"trt", lbm::CollisionModel::trt},
    {"trt at bodies, qr, bulk", lbm::CollisionModel::trt_at_bodies, lbm::Subgrid::qr(), 1.0}};

lbm::CollisionParameters water(const Collision& collision) {
  lbm::CollisionParameters parameters;
  parameters.model = collision.model;
  parameters.bulk_relaxation_time = collision.bulk_relaxation_time;
  parameters.relaxation_time = 0.503;
  parameters.subgrid = collision.subgrid;
  parameters.force[0] = 1e-6;
  return parameters;
}

lbm::FluidState swirl(const Vec3& p) {
  return {0.0, Vec3(0.05 * std::sin(0.1 * p.y()), 0.04 * std::cos(0.1 * p.z()), 0.05 * std::sin(0.1 * p.x()))};
}

struct Result {
  double million_updates_per_second = 0.0;
  double layout_bytes_per_cell = 0.0;    // populations and map, ghosts and padding included
  double resident_bytes_per_cell = 0.0;  // what the system says this process came to hold
};

// Bytes of this process in memory.
double resident_bytes() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// Cell updates per second of all ranks, the best of many pairs of steps (one of each arrangement) within so many
// seconds.
template <typename Real>
Result measure(const Index3& cells, const Box& box, const Collision& collision, double seconds) {
  std::array<bool, 3> periodic;
  for (int a = 0; a < 3; ++a) periodic[a] = box.faces[2 * a].type == lbm::FaceType::periodic;
  const Decomposition decomposition(cells, 1.0, periodic, Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  const double resident_before = resident_bytes();
  lbm::Fluid<Real> fluid(decomposition, MPI_COMM_WORLD, water(collision), box.faces);
  fluid.initialise(swirl);
  const double resident = resident_bytes() - resident_before;
  double best = 1e30;
  const double begin = MPI_Wtime();
  bool on = true;
  while (on) {
    // Times run from the first rank to leave the first barrier to the last to reach the second: every pause counts.
    MPI_Barrier(MPI_COMM_WORLD);
    const double start = MPI_Wtime();
    for (int step = 0; step < 2; ++step) fluid.advance();
    MPI_Barrier(MPI_COMM_WORLD);
    best = std::min(best, max_over_ranks(MPI_COMM_WORLD, MPI_Wtime() - start));
    on = any_rank(MPI_COMM_WORLD, MPI_Wtime() - begin < seconds);
  }
  const double count = static_cast<double>(cells[0]) * cells[1] * cells[2];
  const double layout =
      static_cast<double>(fluid.indexing().count()) * (lbm::D3Q19::directions * sizeof(Real) + sizeof(std::int32_t));
  return {2.0 * count / best * 1e-6, sum_over_ranks(MPI_COMM_WORLD, layout) / count,
          sum_over_ranks(MPI_COMM_WORLD, resident) / count};
}

// One row of the table; the first of each storage, BGK in the periodic box, is measured longest and makes the headline.
template <typename Real>
double run_storage(const char* storage, const Index3& cells, InPlaceBandwidth& bandwidth, bool talks) {
  double headline = 0.0;
  for (const Collision& collision : collisions)
    for (const Box& box : boxes()) {
      const Result result = measure<Real>(cells, box, collision, headline == 0.0 ? 5.0 : 1.5);
      if (headline == 0.0) headline = result.million_updates_per_second;
      const double limit = bandwidth.measure(8) / bytes_per_update<Real> * 1e-6;
      if (talks)
        fmt::print("{:8} {:23} {:10} {:9.1f} {:9.0f} {:9.1f} {:9.1f} {:9.1f} {:8.1f} %\n", storage, collision.name,
                   box.name, result.million_updates_per_second, bytes_per_update<Real>, result.layout_bytes_per_cell,
                   result.resident_bytes_per_cell, limit, 100.0 * result.million_updates_per_second / limit);
    }
  return headline;
}

void run(const Index3& cells) {
  const bool talks = rank_of(MPI_COMM_WORLD) == 0;
  InPlaceBandwidth bandwidth(MPI_COMM_WORLD);
  const double first = bandwidth.measure(60);
  if (talks) {
    fmt::print("{} ranks, {} x {} x {} cells, in-place bandwidth {:.1f} GB/s\n", size_of(MPI_COMM_WORLD), cells[0],
               cells[1], cells[2], first * 1e-9);
    fmt::print("{:8} {:23} {:10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10}\n", "storage", "collision", "box", "MLUPS",
               "B/update", "B/cell", "resident", "limit", "share");
  }
  const double in_double = run_storage<double>("double", cells, bandwidth, talks);
  const double in_single = run_storage<float>("single", cells, bandwidth, talks);
  const double limit = bandwidth.measure(16);
  if (talks)
    fmt::print(
        "{{\"ranks\": {}, \"mlups_double\": {:.1f}, \"mlups_single\": {:.1f}, \"share_of_limit_double\": {:.3f}, "
        "\"share_of_limit_single\": {:.3f}, \"bandwidth_gb_s\": {:.2f}}}\n",
        size_of(MPI_COMM_WORLD), in_double, in_single, in_double * bytes_per_update<double> * 1e6 / limit,
        in_single * bytes_per_update<float> * 1e6 / limit, limit * 1e-9);
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  thalweg::Index3 cells{192, 96, 96};
  for (int a = 0; a < 3 && a + 1 < argc; ++a) cells[a] = std::max(8, std::atoi(argv[a + 1]));
  thalweg::benchmark::run(cells);
}
