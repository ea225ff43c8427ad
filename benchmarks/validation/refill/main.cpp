// How rough the force on a moving grain is with each refill of the cells it uncovers, or with other bulk viscosities:
//
//   bin/refill                every refill
//   bin/refill TAU_B...       the first refill at each of these bulk relaxation times (0: as the shear's)
//   bin/refill covered        the first refill, with the momentum of covered cells lost and given to the grain, and
//   past a sphere
//                             at rest, which covers none
//   bin/refill links          the first refill, with each rule of links, bgk and trt, bulk relaxation time 1
//   bin/refill drag           the first refill from Re_p = 1 to 200 (0.02 cells a step)
//
// A sphere of ten cells moves at constant velocity, not along the lattice and without turning, through fluid at rest in
// a periodic box of 56 x 48 x 48 cells: at Re_p = 20 (tau = 0.55, no subgrid model), and as a grain in water at the
// flume's step (tau - 1/2 = 2.4e-4, 0.012 cells a step, C_s = 0.27). It crosses 12 diameters; the last 8 count. Noise
// of the force is given over the mean drag, of the torque over drag times radius, in two measures: the root mean square
// of the change from one exchange to the next, and that of what is left of the load that the grains feel when its mean
// over the time of crossing a cell is subtracted. Prints a table in Markdown.
#include "core/parallel/mpi_session.hpp"
#include "coupling/system/lattice_system.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace thalweg::benchmark {
namespace {

// The fate of the momentum of covered cells; none: the sphere rests, and the fluid moves past it.
enum class Covered { lost, to_grain, none };

struct Regime {
  const char* name;
  double relaxation_time, smagorinsky_constant, speed;  // lattice units
};

struct Setting {
  std::string name;
  double bulk_relaxation_time = 0.0;
  Covered covered = Covered::lost;
  bodies::LinkRule links = bodies::LinkRule::bouzidi;
  lbm::CollisionModel collision = lbm::CollisionModel::bgk;
};

constexpr double radius = 5.0;

std::unique_ptr<coupling::LatticeSystem<double>> make(const Regime& regime, const Vec3& velocity,
                                                      const Setting& setting) {
  const Index3 cells{56, 48, 48};
  auto decomposition =
      std::make_unique<Decomposition>(cells, 1.0, std::array<bool, 3>{true, true, true}, Index3{1, 1, 1});
  coupling::LatticeParameters p;
  p.units = {1.0, 1.0, 1.0};
  p.collision.relaxation_time = regime.relaxation_time;
  p.collision.subgrid = lbm::Subgrid::smagorinsky(regime.smagorinsky_constant);
  p.collision.bulk_relaxation_time = setting.bulk_relaxation_time;
  p.collision.model = setting.collision;
  p.bodies.links.rule = setting.links;
  p.bodies.keep_covered_momentum = setting.covered != Covered::lost;
  const bool held = setting.covered == Covered::none;
  p.initial_fluid = [u = held ? Vec3(-velocity) : Vec3(Vec3::Zero())](const Vec3&) {
    return coupling::FluidInitialState{0.0, u};
  };
  p.sub_steps = 1;
  dem::GrainSeed seed;
  seed.radius = radius;
  seed.density = 2.55;
  seed.position = Vec3(28.13, 24.37, 23.71);
  seed.velocity = held ? Vec3(Vec3::Zero()) : velocity;
  seed.motion = dem::Motion::fixed;
  dem::GrainParameters g;
  g.contact.normal_stiffness = g.contact.tangential_stiffness = 1.0;
  g.contact.restitution = 0.9;
  g.time_step = 1.0;
  g.skin = 1.0;
  g.ghost_width = coupling::LatticeSystem<double>::ghost_reach(radius, 1.0);
  g.attached_width = coupling::LatticeSystem<double>::attached_width;
  auto grains =
      std::make_unique<dem::GrainDynamics>(*decomposition, MPI_COMM_SELF, g, std::vector<dem::GrainSeed>{seed});
  return std::make_unique<coupling::LatticeSystem<double>>(std::move(decomposition), MPI_COMM_SELF, p,
                                                           std::move(grains));
}

double step_to_step(const std::vector<Vec3>& values) {
  double sum = 0.0;
  for (std::size_t n = 1; n < values.size(); ++n) sum += (values[n] - values[n - 1]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

// Root mean square of what a mean over 2 half + 1 steps leaves.
double roughness(const std::vector<Vec3>& values, int half) {
  double sum = 0.0;
  int count = 0;
  for (int n = half; n + half < static_cast<int>(values.size()); ++n) {
    Vec3 mean = Vec3::Zero();
    for (int k = n - half; k <= n + half; ++k) mean += values[static_cast<std::size_t>(k)];
    sum += (values[static_cast<std::size_t>(n)] - mean / (2 * half + 1)).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / count);
}

void measure(const Regime& regime, const Setting& setting) {
  const Vec3 along = Vec3(1.0, 0.37, 0.21).normalized();
  const auto system = make(regime, regime.speed * along, setting);
  const int crossing = static_cast<int>(1.0 / regime.speed), steps = static_cast<int>(120.0 / regime.speed);
  std::vector<Vec3> force, torque, load, load_torque;
  Vec3 total = Vec3::Zero();
  for (int step = 0; step < steps; ++step) {
    system->advance();
    if (step < steps / 3) continue;
    const dem::GrainStore& store = system->grains().store();
    const coupling::GrainExchange last(store.attached_of(0));
    force.push_back(last.last_force());
    torque.push_back(last.last_torque());
    load.push_back(store.load_force[0]);
    load_torque.push_back(store.load_torque[0]);
    total += load.back();
  }
  const double drag = -total.dot(along) / static_cast<double>(load.size()), moment = drag * radius;
  const int half = crossing / 2;
  std::printf("%s\n", fmt::format("| {} | {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.5g} |", regime.name, setting.name,
                                  step_to_step(force) / drag, roughness(load, half) / drag,
                                  step_to_step(torque) / moment, roughness(load_torque, half) / moment, drag)
                          .c_str());
  std::fflush(stdout);
}

// The heading of the column and the settings that are varied, by the words of the command line.
std::pair<std::string, std::vector<Setting>> settings_of(int argc, char** argv) {
  const std::string mode = argc == 2 ? argv[1] : "";
  if (mode == "covered") {
    std::vector<Setting> settings;
    for (const double bulk : {0.0, 3.0})
      for (const auto& [covered, name] :
           {std::pair{Covered::lost, "lost"}, {Covered::to_grain, "to_grain"}, {Covered::none, "none: sphere at rest"}})
        settings.push_back({fmt::format("{}, tau_b = {}", name, bulk), bulk, covered});
    return {"covered", settings};
  }
  if (mode == "links") {
    std::vector<Setting> settings;
    for (const lbm::CollisionModel collision : {lbm::CollisionModel::bgk, lbm::CollisionModel::trt})
      for (const auto& [links, rule] :
           {std::pair{bodies::LinkRule::bouzidi, "bouzidi"}, {bodies::LinkRule::cli, "cli"}})
        settings.push_back(
            {fmt::format("{}, {}", rule, lbm::traits_of(collision).name), 1.0, Covered::lost, links, collision});
    return {"links", settings};
  }
  if (argc > 1) {
    std::vector<Setting> settings;
    for (int n = 1; n < argc; ++n) settings.push_back({argv[n], std::atof(argv[n])});
    return {"tau_b", settings};
  }
  return {"refill", {{"equilibrium"}}};
}

void print_heading(const std::string& varied) {
  fmt::print("| flow | {} | force, step to step | within a cell | torque, step to step | within a cell | drag |\n",
             varied);
  fmt::print("|---|---|---|---|---|---|---|\n");
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  using namespace thalweg;
  MpiSession session(argc, argv);
  if (argc == 2 && std::string(argv[1]) == "drag") {
    benchmark::print_heading("refill");
    for (const int reynolds : {1, 5, 20, 50, 100, 200}) {
      const std::string name = fmt::format("Re_p = {}", reynolds);
      benchmark::measure({name.c_str(), 0.5 + 3.0 * 0.02 * 10.0 / reynolds, 0.0, 0.02}, {"equilibrium"});
    }
    return 0;
  }
  const auto [varied, settings] = benchmark::settings_of(argc, argv);
  benchmark::print_heading(varied);
  for (const benchmark::Regime& regime : {benchmark::Regime{"Re_p = 20", 0.55, 0.0, 20.0 * 0.05 / 3.0 / 10.0},
                                          benchmark::Regime{"water", 0.50024, 0.27, 0.012}})
    for (const benchmark::Setting& setting : settings) measure(regime, setting);
  return 0;
}
