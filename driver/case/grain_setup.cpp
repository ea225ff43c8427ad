#include "driver/case/grain_setup.hpp"

#include "beds/population_seeds.hpp"
#include "core/geometry/periodic_box.hpp"
#include "driver/case/solid_setup.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

// A wide skin costs nothing without a fluid, and falling grains soon use up a narrow one. In a fluid every new
// neighbour list means a new look at the links, and grains are slower.
constexpr double skin_in_diameters = 0.1, dry_skin_in_diameters = 0.5;

// Faces the fluid sticks to; the other walls of the case are not the fluid's.
dem::LubricationParameters lubrication_parameters(const Case& c, std::size_t walls) {
  const coupling::LubricationKeys& given = *c.coupling.lubrication;
  dem::LubricationParameters parameters;
  parameters.viscosity = c.fluid.density * c.fluid.kinematic_viscosity;
  parameters.normal_cut_off = given.normal_cut_off * c.domain.spacing;
  parameters.tangential_cut_off = given.tangential_cut_off * c.domain.spacing;
  parameters.minimum_gap = given.minimum_gap;
  for (const coupling::FaceKeys& face : c.domain.faces)  // in the order of planes_of()
    if (face.type != lbm::FaceType::periodic)
      parameters.walls.push_back(face.type == lbm::FaceType::no_slip || face.type == lbm::FaceType::moving);
  parameters.walls.resize(walls, false);
  return parameters;
}

// The faces that are no periodic ones, then the walls of the case.
std::vector<dem::Plane> planes_of(const Case& c, const PeriodicBox& box, const dem::ContactParameters& contact) {
  std::vector<dem::Plane> planes = dem::face_planes(box, contact);
  std::size_t number = 0;
  for (std::size_t n = 0; n < c.domain.faces.size(); ++n) {
    const coupling::FaceKeys& face = c.domain.faces[n];
    if (face.type == lbm::FaceType::periodic) continue;
    dem::Plane& plane = planes[number++];  // face_planes() has the same order and leaves out the periodic ones
    plane.rough = n == bottom && c.system == SystemKind::model_fluid && c.model_fluid.rough_floor;
    if (face.type != lbm::FaceType::moving) continue;
    plane.velocity = face.velocity;
    plane.oscillation = face.oscillation.value_or(dem::Oscillation{});
  }
  for (const beds::WallKeys& wall : c.walls) planes.push_back(plane_of(wall, contact));
  return planes;
}

std::vector<dem::Solid> solids_of(const Case& c, const dem::ContactParameters& contact) {
  std::vector<dem::Solid> solids;
  for (const SolidCase& given : c.solids) {
    dem::Solid solid;
    solid.surface = std::make_shared<dem::SolidSurface>(
        given.sphere ? dem::SolidSurface::sphere(given.sphere->centre, given.sphere->radius)
                     : dem::SolidSurface(given.surface));
    solid.friction = given.friction.value_or(contact.wall_friction);
    solid.rolling_friction = given.rolling_friction.value_or(contact.wall_rolling_friction);
    solid.motion = motion_of(given);
    solids.push_back(std::move(solid));
  }
  return solids;
}

// The box with its walls and solids where they are at the start, for the placing of grains.
beds::PackingDomain keeping_clear(beds::PackingDomain ranks, const Case& c) {
  if (c.walls.empty() && c.solids.empty()) return ranks;
  std::vector<dem::Plane> walls;
  for (const beds::WallKeys& wall : c.walls) walls.push_back(plane_of(wall, {}));
  const std::vector<dem::Solid> solids = solids_of(c, {});
  std::vector<dem::PlacedSolid> placed;
  for (const dem::Solid& solid : solids) placed.emplace_back(solid, 0.0, 0.0);
  ranks.keep_clear_of([walls, solids, placed, box = ranks.box()](const Vec3& centre, double radius) {
    const auto reaches = [&](const dem::Plane& wall) { return wall.seen_from(centre, box).distance < radius; };
    return std::any_of(walls.begin(), walls.end(), reaches) ||
           depth_in_solids(centre, radius, box, placed, solids).depth > 0.0;
  });
  return ranks;
}

}  // namespace

PeriodicBox grain_box(const Case& c) {
  constexpr double rounding = 1e-12;
  PeriodicBox box{c.domain.size, periodic_axes(c.domain)};
  for (int axis = 0; axis < 3; ++axis) {
    const double given = box.size[axis];
    const double whole = cells_of(c.domain)[static_cast<std::size_t>(axis)] * c.domain.spacing;
    const double apart = std::abs(whole - given);
    if (apart > rounding * given && apart <= whole_number_tolerance * given) box.size[axis] = whole;
  }
  return box;
}

dem::GrainParameters grain_parameters(const Case& c, const PeriodicBox& box) {
  dem::GrainParameters parameters;
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  parameters.contact = materials.front();
  parameters.contact.film_viscosity = film_viscosity(c);
  parameters.other_materials.assign(materials.begin() + 1, materials.end());
  parameters.wall_contact = wall_material_of(c.contact);
  parameters.walls = planes_of(c, box, parameters.contact);
  parameters.solids = solids_of(c, parameters.contact);
  parameters.assemblies = beds::assemblies_of(c.grains);
  if (c.coupling.lubrication) parameters.lubrication = lubrication_parameters(c, parameters.walls.size());
  parameters.time_step = grain_time_step(c);
  parameters.disk_thickness = c.disks ? c.disks->thickness : 0.0;
  parameters.sub_steps = static_cast<int>(grain_steps(c));
  parameters.skin = (has_fluid(c) ? skin_in_diameters : dry_skin_in_diameters) * smallest_diameter(c);
  parameters.initial_overlap = std::max(parameters.initial_overlap, beds::allowed_overlap(c.grains));
  return parameters;
}

dem::GrainSeeds grain_seeds(const Case& c) {
  return beds::grain_seeds(c.grains, keeping_clear(beds::PackingDomain(grain_box(c)), c));
}

dem::GrainSeeds grain_seeds(const Case& c, MPI_Comm communicator, const Decomposition& decomposition) {
  const double reach = (1.0 + dem::allowed_initial_overlap) * largest_extent(c);  // of two centres that touch
  return beds::grain_seeds(c.grains,
                           keeping_clear(beds::PackingDomain(grain_box(c), communicator, decomposition, reach), c));
}

}  // namespace thalweg::driver
