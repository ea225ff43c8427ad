#include "benchmarks/dem_contacts/settled_bed.hpp"

#include "beds/packing/packing.hpp"
#include "beds/packing/random_packing.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>

namespace thalweg::benchmark {

namespace {

constexpr double density = 2550.0;       // kg/m^3
constexpr Index3 tile_cells{24, 8, 32};  // of one diameter; high enough for the loose grains at the start
constexpr double settling_time = 0.35;   // s; the highest grain falls 19 diameters in 0.14 s

struct Location {
  GlobalId id;
  double position[3];
};

// The positions of all grains, by id, on every rank.
std::vector<Vec3> gathered_positions(const dem::GrainDynamics& grains, MPI_Comm communicator) {
  std::vector<Location> rows;
  std::vector<int> to;
  const dem::GrainStore& s = grains.store();
  for (int rank = 0; rank < size_of(communicator); ++rank)
    for (std::size_t i = 0; i < s.owned; ++i) {
      rows.push_back({s.id[i], {s.position[i][0], s.position[i][1], s.position[i][2]}});
      to.push_back(rank);
    }
  std::vector<Vec3> positions(static_cast<std::size_t>(grains.global_count()));
  for (const Location& place : exchange_rows(communicator, rows, to))
    positions[static_cast<std::size_t>(place.id)] = Vec3(place.position);
  return positions;
}

dem::GrainSeed glass_sphere(GlobalId id, const Vec3& position) {
  dem::GrainSeed seed;
  seed.id = id;
  seed.radius = 0.5 * diameter;
  seed.density = density;
  seed.position = position;
  return seed;
}

}  // namespace

dem::GrainParameters bed_parameters(double restitution, const PeriodicBox& box) {
  dem::GrainParameters p;
  p.contact.normal_stiffness = 20000.0;
  p.contact.tangential_stiffness = 5714.0;
  p.contact.restitution = restitution;
  p.contact.friction = p.contact.wall_friction = 0.5;
  p.contact.attraction = true;  // as LAMMPS's law has it
  p.walls = {dem::face_plane(box, 2, false, p.contact.wall_friction)};
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -gravity * mass); };
  p.time_step = 2e-6;
  p.sub_steps = 50;
  p.skin = 0.1 * diameter;
  p.initial_overlap = 0.01;
  return p;
}

Decomposition bed_decomposition(const Tiles& tiles, int ranks) {
  const Index3 cells{tile_cells[0] * tiles[0], tile_cells[1] * tiles[1], tile_cells[2]};
  return Decomposition(cells, diameter, {true, true, false}, Decomposition::best_layout(cells, ranks));
}

std::vector<dem::GrainSeed> settle_tile(MPI_Comm communicator) {
  const Decomposition decomposition = bed_decomposition({1, 1}, size_of(communicator));
  const PeriodicBox box = decomposition.box();
  const std::vector<double> radii(tile_grains, 0.5 * diameter);
  std::vector<dem::GrainSeed> seeds;
  for (const Vec3& place : beds::random_packing(box, beds::whole(box), radii, 0.0, 1))
    seeds.push_back(glass_sphere(static_cast<GlobalId>(seeds.size()), place));
  dem::GrainParameters p = bed_parameters(0.3, box);
  p.time_step = 9e-6;
  p.sub_steps = 10;
  p.skin = 0.4 * diameter;  // the grains arrive at 1.4 m/s
  dem::GrainDynamics grains(decomposition, communicator, p, seeds);
  for (double time = 0.0; time < settling_time; time += p.time_step * p.sub_steps) {
    grains.prepare();
    grains.advance(p.sub_steps);
    grains.refresh_ghosts();
  }
  const std::vector<Vec3> positions = gathered_positions(grains, communicator);
  for (dem::GrainSeed& seed : seeds) seed.position = positions[static_cast<std::size_t>(seed.id)];
  return seeds;
}

std::vector<dem::GrainSeed> lay_tiles(const std::vector<dem::GrainSeed>& tile, const Tiles& tiles) {
  std::vector<dem::GrainSeed> seeds;
  for (int j = 0; j < tiles[1]; ++j)
    for (int i = 0; i < tiles[0]; ++i)
      for (const dem::GrainSeed& grain : tile) {
        const Vec3 shift(i * tile_cells[0] * diameter, j * tile_cells[1] * diameter, 0.0);
        seeds.push_back(glass_sphere(static_cast<GlobalId>(seeds.size()), grain.position + shift));
      }
  return seeds;
}

}  // namespace thalweg::benchmark
