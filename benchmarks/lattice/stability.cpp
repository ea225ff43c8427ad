// The stability map of the collisions: how near to 1/2 the relaxation time may come at a given velocity.
//
//   bin/stability                half an hour
//   bin/stability TAU_B...       some minutes: a part of the map at each of these bulk relaxation times
//
// Three flows at a lattice velocity u, for tau - 1/2 from 0.1 to 1e-4, with and without eddies (trt_at_bodies is bgk
// here):
//   vortex   a Taylor-Green vortex of three dimensions in a periodic box of 32 cells, for so many turnover times that
//            the flow has broken down to the size of a cell. Stable: its kinetic energy never grew beyond its start.
//   stream   a uniform stream with a little noise in a periodic box.
//   couette  a shear flow with a little noise between a plate at rest and one that moves.
// The last two are stable if the part of the velocity that alternates from one cell to the next along x did not grow:
// viscosity damps it first of all, and no flow that the lattice resolves has any. Where it grows, eddies may still hold
// it; a last table says at what level. Prints tables in Markdown.
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace thalweg::benchmark {
namespace {

constexpr double excesses[] = {1e-1, 5e-2, 3e-2, 2e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4};  // tau - 1/2
constexpr double velocities[] = {0.02, 0.05, 0.1, 0.15};

constexpr lbm::CollisionModel models[] = {lbm::CollisionModel::bgk, lbm::CollisionModel::trt};

struct Eddies {
  const char* name;
  lbm::Subgrid model;
};

std::vector<Eddies> all_eddies() {
  return {{"no subgrid model", lbm::Subgrid::none()},
          {"C_s = 0.17", lbm::Subgrid::smagorinsky(0.17)},
          {"C_s = 0.27", lbm::Subgrid::smagorinsky(0.27)},
          {"qr", lbm::Subgrid::qr()}};
}

struct Setting {
  lbm::CollisionModel model;
  double excess, velocity;
  lbm::Subgrid subgrid;
  double bulk = 0.0;

  lbm::CollisionParameters parameters() const {
    lbm::CollisionParameters p;
    p.model = model;
    p.relaxation_time = 0.5 + excess;
    p.subgrid = subgrid;
    p.bulk_relaxation_time = bulk;
    return p;
  }
};

bool vortex_survives(const Setting& s) {
  constexpr int side = 32;
  constexpr double turnovers = 12.0;  // the vortex breaks down after about nine
  const Decomposition decomposition({side, side, side}, 1.0, {true, true, true}, {1, 1, 1});
  lbm::Fluid<float> fluid(decomposition, MPI_COMM_SELF, s.parameters(), {});
  const double k = 2.0 * std::numbers::pi / side, velocity = s.velocity;
  fluid.initialise([&](const Vec3& p) {
    const double x = k * p.x(), y = k * p.y(), z = k * p.z();
    const double pressure = velocity * velocity / 16.0 * (std::cos(2 * x) + std::cos(2 * y)) * (std::cos(2 * z) + 2.0);
    return lbm::FluidState{3.0 * pressure, velocity * Vec3(std::sin(x) * std::cos(y) * std::cos(z),
                                                           -std::cos(x) * std::sin(y) * std::cos(z), 0.0)};
  });
  const auto energy = [&] {
    double sum = 0.0;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) sum += fluid.state_at(fluid.indexing().index(x, y, z)).velocity.squaredNorm();
    return sum;
  };
  const double start = energy();
  const int steps = static_cast<int>(turnovers / (k * velocity));
  for (int step = 1; step <= steps; ++step) {
    fluid.advance();
    if ((step % 50 == 0 || step == steps) && !(energy() <= 1.05 * start)) return false;
  }
  return true;
}

// Root mean square of (u(x - 1) - 2 u(x) + u(x + 1))/4: a quarter of it passes only what alternates.
double alternating(const lbm::Fluid<double>& fluid) {
  const Index3& n = fluid.indexing().size();
  const auto velocity = [&](int x, int y, int z) {
    return fluid.state_at(fluid.indexing().index((x + n[0]) % n[0], y, z)).velocity;
  };
  double sum = 0.0;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x)
        sum += (0.25 * (velocity(x - 1, y, z) - 2.0 * velocity(x, y, z) + velocity(x + 1, y, z))).squaredNorm();
  return std::sqrt(sum / (static_cast<double>(n[0]) * n[1] * n[2]));
}

// A box with noise of a thousandth of the velocity: its alternating part at the start and after so many steps.
struct Noise {
  double start, end;
};

Noise follow_noise(const Setting& s, bool plates, int steps) {
  const Index3 cells{16, 16, 16};
  const Decomposition decomposition(cells, 1.0, {true, true, !plates}, {1, 1, 1});
  lbm::FaceConditions faces;
  if (plates) {
    faces[4].type = lbm::FaceType::no_slip;
    faces[5].type = lbm::FaceType::moving;
    faces[5].velocity.x() = s.velocity;
  }
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, s.parameters(), faces);
  std::mt19937 bits(1);
  const auto noise = [&] { return 1e-3 * s.velocity * (2.0 * static_cast<double>(bits()) / 0x1p32 - 1.0); };
  fluid.initialise([&](const Vec3& p) {
    return lbm::FluidState{0.0, Vec3((plates ? p.z() / cells[2] : 1.0) * s.velocity + noise(), noise(), noise())};
  });
  const double start = alternating(fluid);
  for (int step = 0; step < steps; ++step) fluid.advance();
  return {start, alternating(fluid)};
}

bool noise_dies(const Setting& s, bool plates) {
  const Noise noise = follow_noise(s, plates, 2000);
  return noise.end <= noise.start;
}

// The fastest of these velocities before the first with which a run fails, as a text.
template <typename Survives>
std::string fastest_stable(Setting s, const char* none, Survives survives) {
  double best = 0.0;
  for (const double velocity : velocities) {
    s.velocity = velocity;
    if (!survives(s)) break;
    best = velocity;
  }
  return best == 0.0 ? none : fmt::format("{:g}", best);
}

template <typename Survives>
void print_map(const char* title, const Eddies& eddies, Survives survives) {
  fmt::print("\n{}, {}: largest lattice velocity that stays stable\n\n| tau - 1/2 |", title, eddies.name);
  for (const lbm::CollisionModel m : models) fmt::print(" {} |", lbm::traits_of(m).name);
  fmt::print("\n|---|---|---|\n");
  for (const double excess : excesses) {
    fmt::print("| {:g} |", excess);
    for (const lbm::CollisionModel m : models)
      fmt::print(" {} |", fastest_stable({m, excess, 0.0, eddies.model}, "unstable", survives));
    fmt::print("\n");
    std::fflush(stdout);
  }
}

void print_noise(const Eddies& eddies) {
  constexpr double velocity = 0.1;
  fmt::print("\ncouette, {}: alternating part after 6000 steps at {} cells a step, in per cent of that\n\n",
             eddies.name, velocity);
  fmt::print("| tau - 1/2 | bgk | trt |\n|---|---|---|\n");
  for (const double excess : excesses) {
    fmt::print("| {:g} |", excess);
    for (const lbm::CollisionModel m : models)
      fmt::print(" {:.2f} |", 100.0 / velocity * follow_noise({m, excess, velocity, eddies.model}, true, 6000).end);
    fmt::print("\n");
  }
  std::fflush(stdout);
}

// Vortex, stream and couette without eddies, and with them the noise that couette flow leaves as in print_noise.
void print_bulk(double bulk) {
  for (const double excess : {1e-2, 1e-3, 1e-4}) {
    fmt::print("| {:g} | {:g} |", bulk, excess);
    for (const lbm::CollisionModel m : models) {
      const Setting s{m, excess, 0.0, lbm::Subgrid::none(), bulk};
      fmt::print(" {} / {} / {} |", fastest_stable(s, "-", vortex_survives),
                 fastest_stable(s, "-", [](const Setting& t) { return noise_dies(t, false); }),
                 fastest_stable(s, "-", [](const Setting& t) { return noise_dies(t, true); }));
    }
    for (const lbm::CollisionModel m : models)
      fmt::print(" {:.2f} |",
                 1e3 * follow_noise({m, excess, 0.1, lbm::Subgrid::smagorinsky(0.27), bulk}, true, 6000).end);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

void run_bulk(int count, char** times) {
  fmt::print("| tau_b | tau - 1/2 |");
  for (const lbm::CollisionModel m : models) fmt::print(" {} |", lbm::traits_of(m).name);
  for (const lbm::CollisionModel m : models) fmt::print(" {}, noise |", lbm::traits_of(m).name);
  fmt::print("\n|---|---|---|---|---|---|\n");
  for (int n = 0; n < count; ++n) print_bulk(std::atof(times[n]));
}

void run() {
  for (const Eddies& eddies : all_eddies()) {
    print_map("vortex", eddies, vortex_survives);
    print_map("stream", eddies, [](const Setting& s) { return noise_dies(s, false); });
    print_map("couette", eddies, [](const Setting& s) { return noise_dies(s, true); });
    print_noise(eddies);
  }
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  if (argc > 1)
    thalweg::benchmark::run_bulk(argc - 1, argv + 1);
  else
    thalweg::benchmark::run();
}
