// Speed of the whole coupled step on a settled bed under flowing water, everything included.
//
//   mpirun -n 2 coupled_bed [--box bed|box|flume|quickstart] [--steps N] [--flow N] [--storage single|double]
//                           [--published]
//
// bed: 240 x 80 x 200 cells and 2884 grains of 10 cells; box: 160 x 160 x 128 cells and 2250 grains of 10 cells; flume:
// 147 x 13 x 184 cells and 969 grains of 6.13 cells between law-of-the-wall sides; quickstart: that case, 72 x 13 x 90
// cells and 230 grains of 6 cells. The grains settle under their submerged weight and rest on their contacts. Then
// water flows over them, 500 steps (--flow) before the timing begins, with 50 DEM sub-steps a step. Printed for single
// and double storage: milliseconds a step by phase, MLUPS over all cells, links and contacts a grain, nanoseconds a
// link, and the ratio to the pure lattice sweep over the same box in the same run. The last line is the same as JSON.
#include "beds/packing/packing.hpp"
#include "core/parallel/mpi_session.hpp"
#include "coupling/system/lattice_system.hpp"
#include "dem/motion/walls.hpp"
#include "io/files/json_object.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace thalweg;
using Clock = std::chrono::steady_clock;

constexpr double density = 2550.0, water = 1000.0, gravity = 9.8;
constexpr int sub_steps = 50;

struct Box {
  std::string name;
  Index3 cells;
  int grains;
  double diameter, spacing, time_step, slope;  // m, m, s, 1
  bool side_walls = false;                     // law of the wall at both y faces
  bool published = false;                      // the collision and subgrid model of Zhang et al. (2022)
};

const std::vector<Box> boxes{{"bed", {240, 80, 200}, 2884, 5e-3, 0.5e-3, 2e-5, 0.016},
                             {"box", {160, 160, 128}, 2250, 5e-3, 0.5e-3, 2e-5, 0.016},
                             {"flume", {147, 13, 184}, 969, 4.95e-3, 0.8077e-3, 1e-4, 0.0445, true},
                             {"quickstart", {72, 13, 90}, 230, 4.95e-3, 0.825e-3, 1e-4, 0.08, true}};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

dem::GrainParameters grain_parameters(const Box& box, const Decomposition& decomposition) {
  dem::GrainParameters p;
  p.contact.normal_stiffness = 20000.0;
  p.contact.tangential_stiffness = 5714.0;
  p.contact.restitution = 0.93;
  p.contact.friction = 0.5;
  p.contact.wall_friction = 0.45;
  p.walls = dem::face_planes(decomposition.box(), p.contact);
  p.body_force = [slope = box.slope](double mass, double radius) {
    const double displaced = water * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    return Vec3(gravity * (mass - displaced) * Vec3(slope, 0.0, -1.0));
  };
  p.time_step = box.time_step / sub_steps;
  p.sub_steps = sub_steps;
  p.skin = 0.1 * box.diameter;
  p.initial_overlap = 0.01;
  return p;
}

// The grains after sinking to the floor for 0.6 s, losing most of their energy in every contact.
std::vector<dem::GrainSeed> settled(const Box& box, const Decomposition& decomposition) {
  std::vector<dem::GrainSeed> seeds;
  const beds::Region region = beds::whole(decomposition.box());
  for (const Vec3& position :
       beds::uniform_packing(decomposition.box(), region, box.grains, 0.5 * box.diameter, 0.0, 1)) {
    dem::GrainSeed seed;
    seed.id = static_cast<GlobalId>(seeds.size());
    seed.radius = 0.5 * box.diameter;
    seed.density = density;
    seed.position = position;
    seeds.push_back(seed);
  }
  dem::GrainParameters p = grain_parameters(box, decomposition);
  p.contact.restitution = 0.3;
  p.time_step = 8e-6;
  p.sub_steps = 10;
  p.skin = 0.15 * box.diameter;
  dem::GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, seeds);
  for (int k = 0; k < 7500; ++k) {
    grains.prepare();
    grains.advance(p.sub_steps);
    grains.refresh_ghosts();
  }
  std::vector<double> positions(3 * seeds.size(), 0.0);
  for (std::size_t g = 0; g < grains.store().owned; ++g)
    for (int a = 0; a < 3; ++a) positions[3 * grains.store().id[g] + a] = grains.store().position[g][a];
  MPI_Allreduce(MPI_IN_PLACE, positions.data(), static_cast<int>(positions.size()), MPI_DOUBLE, MPI_SUM,
                MPI_COMM_WORLD);
  for (std::size_t g = 0; g < seeds.size(); ++g) seeds[g].position = Vec3(&positions[3 * g]);
  return seeds;
}

// Collision as `thalweg run` has it by default, or as published; with a bulk viscosity.
lbm::CollisionParameters collision_of(const Box& box) {
  const Units units{box.spacing, box.time_step, water};
  lbm::CollisionParameters p;
  p.relaxation_time = units.relaxation_time(1e-6);
  p.model = box.published ? lbm::CollisionModel::bgk : lbm::CollisionModel::trt_at_bodies;
  p.magic_parameter = lbm::traits_of(p.model).usual_magic_parameter;
  p.subgrid = box.published ? lbm::Subgrid::smagorinsky(0.27) : lbm::Subgrid::qr();
  p.bulk_relaxation_time = 1.0;
  p.force[0] = box.slope * gravity / units.acceleration();
  return p;
}

lbm::FaceConditions faces_of(const Box& box) {
  lbm::FaceConditions faces;
  if (box.side_walls) faces[2].type = faces[3].type = lbm::FaceType::law_of_the_wall;
  faces[4].type = lbm::FaceType::no_slip;
  faces[5].type = lbm::FaceType::free_slip;
  return faces;
}

template <typename Real>
std::unique_ptr<coupling::LatticeSystem<Real>> flowing_bed(const Box& box, const Decomposition& decomposition,
                                                           const std::vector<dem::GrainSeed>& seeds) {
  coupling::LatticeParameters p;
  p.units = {box.spacing, box.time_step, water};
  p.collision = collision_of(box);
  p.faces = faces_of(box);
  p.sub_steps = sub_steps;
  double bed = 0.0;
  for (const dem::GrainSeed& seed : seeds) bed = std::max(bed, seed.position.z());
  p.initial_fluid = [bed](const Vec3& x) {
    const double height = x.z() - bed;
    const double u = height > 2e-4 ? 0.09 / 0.41 * std::log(height / 1.7e-4) : 0.0;
    return coupling::FluidInitialState{0.0,
                                       Vec3(u, 0.05 * u * std::sin(400.0 * x.x()), 0.05 * u * std::cos(300.0 * x.y()))};
  };
  dem::GrainParameters g = grain_parameters(box, decomposition);
  g.ghost_width = coupling::LatticeSystem<Real>::ghost_reach(0.5 * box.diameter, box.spacing);
  g.attached_width = coupling::LatticeSystem<Real>::attached_width;
  auto grains = std::make_unique<dem::GrainDynamics>(decomposition, MPI_COMM_WORLD, g, seeds);
  return std::make_unique<coupling::LatticeSystem<Real>>(std::make_unique<Decomposition>(decomposition), MPI_COMM_WORLD,
                                                         p, std::move(grains));
}

// Best of the repetitions of a lattice step without grains, in seconds.
template <typename Real>
double pure_sweep(const Box& box, const Decomposition& decomposition, int steps) {
  lbm::Fluid<Real> fluid(decomposition, MPI_COMM_WORLD, collision_of(box), faces_of(box));
  double best = 1e9;
  for (int k = 0; k < steps; ++k) {
    MPI_Barrier(MPI_COMM_WORLD);
    const auto start = Clock::now();
    fluid.advance();
    fluid.advance();
    best = std::min(best, max_over_ranks(MPI_COMM_WORLD, 0.5 * seconds_since(start)));
  }
  return best;
}

template <typename Real>
void measure(const Box& box, const Decomposition& decomposition, const std::vector<dem::GrainSeed>& seeds, int steps,
             int flow, io::JsonObject& json) {
  const bool first_rank = rank_of(MPI_COMM_WORLD) == 0;
  const std::string storage = sizeof(Real) == 4 ? "single" : "double";
  const auto system = flowing_bed<Real>(box, decomposition, seeds);
  for (int k = 0; k < flow; ++k) system->advance();
  double best = 1e9;
  std::vector<std::pair<std::string, double>> phases;  // of the best pair, s on this rank
  for (int k = 0; k < steps; k += 2) {                 // pairs: the two kinds of lattice step differ
    system->timer().reset();
    MPI_Barrier(MPI_COMM_WORLD);
    const auto start = Clock::now();
    system->advance();
    system->advance();
    const double taken = max_over_ranks(MPI_COMM_WORLD, 0.5 * seconds_since(start));
    if (taken >= best) continue;
    best = taken;
    phases = system->timer().seconds();
  }
  const double cells = static_cast<double>(system->cells());
  const auto links =
      static_cast<double>(sum_over_ranks(MPI_COMM_WORLD, static_cast<std::int64_t>(system->bodies().links().count())));
  const std::int64_t moving = system->grains().moving_count(1e-3 * box.spacing / box.time_step);
  const double pure = pure_sweep<Real>(box, decomposition, std::max(6, steps / 2));
  const double mlups = cells / best / 1e6;
  if (first_rank)
    fmt::print("{} {}: {:.2f} ms a step (best), {:.1f} MLUPS, {:.2f} x the pure sweep ({:.1f} MLUPS)\n", box.name,
               storage, 1e3 * best, mlups, best / pure, cells / pure / 1e6);
  double link_seconds = 0.0;
  for (const auto& [phase, seconds] : phases) {
    const double mean = 0.5 * sum_over_ranks(MPI_COMM_WORLD, seconds) / size_of(MPI_COMM_WORLD);  // of a step
    if (phase == "links") link_seconds = mean;
    if (first_rank) fmt::print("  {:<10} {:8.3f} ms\n", phase, 1e3 * mean);
    std::string key = phase;
    std::replace(key.begin(), key.end(), ' ', '_');
    json.set("ms_per_step_" + key + "_" + storage, 1e3 * mean);
  }
  const auto contacts = static_cast<double>(system->grains().contact_count());
  const double ns_per_link = 1e9 * link_seconds * size_of(MPI_COMM_WORLD) / links;
  if (first_rank)
    fmt::print(
        "  {:.0f} links and {:.1f} contacts a grain, {:.1f} ns a link and rank; {} of {} grains move by a "
        "thousandth of a cell a step\n",
        links / box.grains, contacts / box.grains, ns_per_link, moving, box.grains);
  json.set("mlups_" + storage, mlups).set("ms_per_step_" + storage, 1e3 * best);
  json.set("ratio_to_pure_sweep_" + storage, best / pure).set("ns_per_link_" + storage, ns_per_link);
  json.set("links_per_grain", links / box.grains).set("moving_grains", moving);
}

}  // namespace

int main(int argc, char** argv) {
  MpiSession session(argc, argv);
  CLI::App app{"Speed of the whole coupled step on a settled bed under flowing water."};
  std::string name = "bed", storage;
  int steps = 20, flow = 500;
  app.add_option("--box", name, "bed, box, flume or quickstart")
      ->check(CLI::IsMember({"bed", "box", "flume", "quickstart"}));
  app.add_option("--steps", steps, "timed steps, in pairs")->check(CLI::PositiveNumber);
  app.add_option("--storage", storage, "single or double; both if not given")
      ->check(CLI::IsMember({"single", "double"}));
  app.add_option("--flow", flow, "steps of flow before the timing")->check(CLI::NonNegativeNumber);
  bool published = false;
  app.add_flag("--published", published, "bgk and Smagorinsky's model, in place of the program's defaults");
  CLI11_PARSE(app, argc, argv);
  steps = std::max(2, steps / 2 * 2);
  Box box = *std::find_if(boxes.begin(), boxes.end(), [&](const Box& b) { return b.name == name; });
  box.published = published;
  const Index3 layout = Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD));
  const Decomposition decomposition(box.cells, box.spacing, {true, !box.side_walls, false}, layout);
  const auto start = Clock::now();
  const std::vector<dem::GrainSeed> seeds = settled(box, decomposition);
  if (rank_of(MPI_COMM_WORLD) == 0)
    fmt::print("{} grains settled in {:.1f} s; {} ranks, layout {} x {} x {}\n", box.grains, seconds_since(start),
               size_of(MPI_COMM_WORLD), layout[0], layout[1], layout[2]);
  io::JsonObject json;
  json.set("benchmark", "coupled_bed").set("box", box.name).set("ranks", size_of(MPI_COMM_WORLD));
  if (storage != "double") measure<float>(box, decomposition, seeds, steps, flow, json);
  if (storage != "single") measure<double>(box, decomposition, seeds, steps, flow, json);
  if (rank_of(MPI_COMM_WORLD) == 0) fmt::print("{}\n", json.line());
}
