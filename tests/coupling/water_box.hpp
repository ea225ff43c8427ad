// A small resolved system for tests: 5 mm glass spheres in water or a thicker fluid, 6 to 8 cells a diameter.
#pragma once

#include "coupling/system/lattice_system.hpp"
#include "dem/motion/walls.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace thalweg::coupling {

struct WaterBox {
  Index3 cells{32, 24, 24};
  std::array<bool, 3> periodic{true, true, true};
  double spacing = 0.8e-3;  // m
  double time_step = 1e-4;  // s
  double viscosity = 1e-6;  // m^2/s
  double smagorinsky_constant = 0.27;
  double bulk_relaxation_time = 0.0;
  double ramp = 0.0;  // steps
  lbm::CollisionModel collision = lbm::CollisionModel::bgk;
  Vec3 gravity = Vec3(0.0, 0.0, 0.0);  // m/s^2; reduced: along z only the submerged weight counts
  Vec3 fluid_velocity = Vec3::Zero();  // m/s at the start
  double plate_velocity = 0.0;         // m/s along x: where not zero, top and bottom are plates that move, top along x
  bool bottom_at_rest = false;         // of two plates the lower one does not move
  FluidInitialState (*initial)(const Vec3&) = nullptr;
  bool closed = false;  // no slip at all faces that are not periodic
  bodies::LinkOptions links;
  int sub_steps = 50;
  double normal_stiffness = 20000.0;  // N/m
  bool wall_forces = false;
  bool lubrication = false;  // with the cut-offs of the case's defaults, at the floor alone
  bool keep_covered_momentum = false;
  bool full_gravity = false;  // gravity acts on everything, and buoyancy comes from the fluid
  LoadAveraging load = LoadAveraging::extrapolated;
  std::optional<lbm::FlowTarget> flow_target;
  bool target_moves_grains = true;
  std::vector<dem::GrainSeed> seeds;
  std::vector<dem::PrescribedMotion> assemblies;
  std::vector<dem::ClumpSeed> clumps;
  std::vector<dem::Sink> sinks;
  std::vector<GlobalId> obstacles;                   // whose momentum by height is counted apart
  std::vector<bodies::SolidShape> solids;            // m
  std::vector<dem::PrescribedMotion> solid_motions;  // of the first of them
};

// The same shape in other units of length.
inline bodies::SolidShape scaled(bodies::SolidShape shape, double factor) {
  if (auto* sphere = std::get_if<bodies::SolidSphere>(&shape))
    return bodies::SolidSphere{factor * sphere->centre, factor * sphere->radius};
  for (Vec3& point : std::get<TriangleMesh>(shape).points) point *= factor;
  return shape;
}

inline dem::Solid grain_solid(const bodies::SolidShape& shape) {
  const auto* sphere = std::get_if<bodies::SolidSphere>(&shape);
  return {std::make_shared<dem::SolidSurface>(sphere ? dem::SolidSurface::sphere(sphere->centre, sphere->radius)
                                                     : dem::SolidSurface(std::get<TriangleMesh>(shape))),
          0.45,
          0.0,
          {}};
}

template <typename Real>
std::unique_ptr<LatticeSystem<Real>> make_system(const WaterBox& box, MPI_Comm communicator, const Index3& layout) {
  constexpr double fluid_density = 1000.0;
  auto decomposition = std::make_unique<Decomposition>(box.cells, box.spacing, box.periodic, layout);

  LatticeParameters p;
  p.units = {box.spacing, box.time_step, fluid_density};
  p.collision.relaxation_time = p.units.relaxation_time(box.viscosity);
  p.collision.model = box.collision;
  p.collision.subgrid = lbm::Subgrid::smagorinsky(box.smagorinsky_constant);
  p.collision.bulk_relaxation_time = box.bulk_relaxation_time;
  p.ramp = box.ramp;
  p.flow_target = box.flow_target;
  p.target_moves_grains = box.flow_target && box.target_moves_grains;
  for (int a = 0; a < (box.full_gravity ? 3 : 2); ++a) p.collision.force[a] = box.gravity[a] / p.units.acceleration();
  for (int face = 0; face < 6; ++face)
    p.faces[face].type = box.periodic[face / 2] ? lbm::FaceType::periodic
                         : face == 5            ? lbm::FaceType::free_slip
                         : face == 4            ? lbm::FaceType::no_slip
                                                : lbm::FaceType::law_of_the_wall;
  for (int face = 0; box.closed && face < 6; ++face)
    if (!box.periodic[face / 2]) p.faces[face].type = lbm::FaceType::no_slip;
  for (const int face : {4, 5}) {
    if (box.plate_velocity == 0.0) continue;
    p.faces[face].type = lbm::FaceType::moving;
    const double along = face == 5 ? 1.0 : (box.bottom_at_rest ? 0.0 : -1.0);
    p.faces[face].velocity = Vec3(along * box.plate_velocity / p.units.velocity(), 0.0, 0.0);
  }
  p.bodies.links = box.links;
  p.sub_steps = box.sub_steps;
  p.wall_forces = box.wall_forces;
  p.bodies.keep_covered_momentum = box.keep_covered_momentum;
  p.bodies.obstacles = box.obstacles;
  p.full_gravity = box.full_gravity;
  p.load = box.load;
  if (box.initial)
    p.initial_fluid = box.initial;
  else
    p.initial_fluid = [u = box.fluid_velocity](const Vec3&) { return FluidInitialState{0.0, u}; };

  dem::GrainParameters g;
  g.contact.normal_stiffness = box.normal_stiffness;
  g.contact.tangential_stiffness = 0.2857 * box.normal_stiffness;
  g.contact.restitution = 0.93;
  g.contact.friction = 0.5;
  g.contact.wall_friction = 0.45;
  g.walls = dem::face_planes(decomposition->box(), g.contact);
  g.body_force = [gravity = box.gravity, full = box.full_gravity](double mass, double radius) {
    const double displaced = full ? 0.0 : fluid_density * 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius;
    return Vec3(mass * gravity.x(), mass * gravity.y(), (mass - displaced) * gravity.z());
  };
  g.assemblies = box.assemblies;
  g.sinks = box.sinks;
  std::vector<bodies::SolidShape> solids;
  p.solid_motions = box.solid_motions;
  for (const bodies::SolidShape& shape : box.solids) {
    g.solids.push_back(grain_solid(shape));
    if (solids.size() < box.solid_motions.size()) g.solids.back().motion = box.solid_motions[solids.size()];
    solids.push_back(scaled(shape, 1.0 / box.spacing));
  }
  g.time_step = box.time_step / box.sub_steps;
  g.sub_steps = box.sub_steps;
  double largest = 0.0;
  for (const dem::GrainSeed& seed : box.seeds) largest = std::max(largest, seed.radius);
  for (const dem::ClumpSeed& clump : box.clumps)
    for (const dem::PlacedSphere& member : clump.shape->members) largest = std::max(largest, member.radius);
  g.skin = largest > 0.0 ? 0.2 * largest : box.spacing;
  g.ghost_width = LatticeSystem<Real>::ghost_reach(largest, box.spacing);
  if (box.lubrication) {
    dem::LubricationParameters lubrication;
    lubrication.viscosity = fluid_density * box.viscosity;
    lubrication.normal_cut_off = 2.0 / 3.0 * box.spacing;
    lubrication.tangential_cut_off = 0.5 * box.spacing;
    for (const dem::Plane& wall : g.walls) lubrication.walls.push_back(wall.normal.z() == 1.0);
    g.lubrication = lubrication;
  }
  g.attached_width = LatticeSystem<Real>::attached_width;
  auto grains = std::make_unique<dem::GrainDynamics>(*decomposition, communicator, g, box.seeds, box.clumps);
  return std::make_unique<LatticeSystem<Real>>(std::move(decomposition), communicator, p, std::move(grains), solids);
}

// Takes a step that measures the stress of the fluid on the grains.
inline void advance_with_stress(System& system) {
  system.measure_grain_stress();
  system.advance();
}

inline dem::GrainSeed glass_sphere(GlobalId id, const Vec3& position, const Vec3& velocity = Vec3::Zero(),
                                   double radius = 2.5e-3) {
  dem::GrainSeed seed;
  seed.id = id;
  seed.radius = radius;
  seed.density = 2550.0;
  seed.position = position;
  seed.velocity = velocity;
  return seed;
}

inline dem::ClumpSeed glass_clump(GlobalId id, const std::vector<dem::PlacedSphere>& members, const Vec3& position,
                                  const Vec3& velocity = Vec3::Zero(), const Vec3& angular_velocity = Vec3::Zero()) {
  dem::ClumpSeed seed;
  seed.id = id;
  seed.shape = std::make_shared<const dem::ClumpShape>(dem::clump_shape(members));
  seed.density = 2550.0;
  seed.position = position;
  seed.velocity = velocity;
  seed.angular_velocity = angular_velocity;
  return seed;
}

// Three spheres of 4.4, 3.6 and 4 mm that overlap, none of them in a row.
inline std::vector<dem::PlacedSphere> pebble() {
  return {{{0, 0, 0}, 2.2e-3}, {{2.4e-3, 0.3e-3, 0.2e-3}, 1.8e-3}, {{-0.5e-3, 2.0e-3, 0.8e-3}, 2.0e-3}};
}

}  // namespace thalweg::coupling
