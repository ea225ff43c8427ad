#include "io/vtk/grain_fields.hpp"

#include <algorithm>
#include <numbers>

namespace thalweg::io {

namespace {

// Clumps are in order of id, and a member is on the rank of its clump.
const ClumpState& clump_of_member(const GrainView& grains, std::size_t n) {
  return *std::lower_bound(grains.clumps.begin(), grains.clumps.end(), grains.clump[n],
                           [](const ClumpState& state, GlobalId wanted) { return state.id < wanted; });
}

}  // namespace

const std::vector<NamedChoice<GrainField>>& grain_fields() {
  static const std::vector<NamedChoice<GrainField>> fields{
      {GrainField::id, "id"},
      {GrainField::clump, "clump", "id of the clump of a member, else -1"},
      {GrainField::radius, "radius", "m, always written"},
      {GrainField::speed, "speed", "m/s"},
      {GrainField::velocity, "velocity", "m/s"},
      {GrainField::angular_velocity, "angular_velocity", "rad/s"},
      {GrainField::contact_force, "contact_force", "N"},
      {GrainField::contact_stress, "contact_stress", "Pa, xx, xy, xz, yx, ..."},
      {GrainField::fluid_force, "fluid_force", "N"},
      {GrainField::fluid_stress, "fluid_stress", "Pa, xx, xy, xz, yx, ..."},
      {GrainField::population, "population", "its number in grains, from 0"},
      {GrainField::held, "held", "0 free, 1 velocity held, 2 angular velocity held, 3 both, as for fixed grains"},
      {GrainField::density, "density", "kg/m^3"},
      {GrainField::orientation, "orientation", "of clumps, a unit quaternion w, x, y, z"}};
  return fields;
}

int components_of(GrainField field) {
  switch (field) {
    case GrainField::velocity:
    case GrainField::angular_velocity:
    case GrainField::contact_force:
    case GrainField::fluid_force:
      return 3;
    case GrainField::orientation:
      return 4;
    case GrainField::contact_stress:
    case GrainField::fluid_stress:
      return 9;
    default:
      return 1;
  }
}

bool there_is(GrainField field, const GrainFieldFacts& facts) {
  if (field == GrainField::clump || field == GrainField::orientation) return facts.clumps;
  if (field == GrainField::fluid_force) return facts.fluid_force;
  if (field == GrainField::fluid_stress) return facts.fluid_stress;
  return true;
}

double density_of(const GrainView& grains, std::size_t n) {
  if (grains.is_member(n)) {
    const ClumpState& clump = clump_of_member(grains, n);
    return clump.mass / clump.volume;
  }
  const double r = grains.radius[n];
  const double height = grains.disk_thickness > 0.0 ? grains.disk_thickness : 4.0 / 3.0 * r;
  return grains.mass[n] / (height * std::numbers::pi * r * r);
}

std::array<double, 4> orientation_of(const GrainView& grains, std::size_t n) {
  if (!grains.is_member(n)) return {1.0, 0.0, 0.0, 0.0};
  return clump_of_member(grains, n).orientation;
}

}  // namespace thalweg::io
