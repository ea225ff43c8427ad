// Read-only views of a system's state for observers and writers, in SI units.
#pragma once

#include "core/base/types.hpp"
#include "core/parallel/decomposition.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

// A clump: a rigid grain of several spheres.
struct ClumpState {
  GlobalId id;            // that of its first member
  double mass, volume;    // kg, m^3
  Vec3 position;          // m, of its centre, inside the box
  Vec3 velocity;          // m/s, of its centre
  double kinetic_energy;  // J, with rotation
  // Unit quaternion w, x, y, z that turns vectors from the frame of its principal axes into space.
  std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};
  bool velocity_is_held = false;         // no force changes it
  Vec3 moments = Vec3::Zero();           // kg m^2, about its principal axes
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

// The grains this rank owns, in no particular order. Every span has one entry a grain. Members of clumps are among them
// as spheres that move with it, but their mass is the whole clump's: sums over grains leave out members (is_member())
// and add `clumps`.
struct GrainView {
  std::int64_t global_count = 0;  // over all ranks
  GlobalId id_limit = 0;          // ids are below it and the global count; larger where grains have come in or left
  double disk_thickness = 0.0;    // m; 0: spheres
  // N/m^3, on the volume of each besides the force of gravity: of the pressure gradient that holds a mean velocity.
  Vec3 force_density = Vec3::Zero();
  std::span<const GlobalId> id;
  std::span<const double> radius;          // m
  std::span<const double> mass;            // kg
  std::span<const Vec3> position;          // m, inside the box
  std::span<const Vec3> velocity;          // m/s
  std::span<const Vec3> angular_velocity;  // rad/s
  std::span<const Vec3> fluid_force;       // N, as applied during the last step; empty without a fluid
  std::span<const Vec3> fluid_torque;      // N m
  std::span<const Vec3> contact_force;     // N, sum over contacts at the end of the step
  std::span<const Vec3> contact_torque;    // N m, about the grain's centre

  // Clumps, where there are any:
  std::int64_t clump_count = 0, member_count = 0;  // over all ranks
  std::span<const GlobalId> clump;                 // id of a member's clump; -1: no member. Empty: there are no clumps
  std::vector<ClumpState> clumps;                  // owned by this rank as are their members, in order of id
  bool is_member(std::size_t grain) const { return !clump.empty() && clump[grain] >= 0; }
  std::int64_t body_count() const { return global_count - member_count + clump_count; }  // a clump counts once
  GlobalId end_of_ids() const { return std::max(id_limit, global_count); }
  // The motion of a grain, or of a member's clump, that is held, so that no force changes it: the sum of 1 (velocity)
  // and 2 (angular velocity). Higher bits have no meaning here. Empty: everything is free.
  std::span<const std::uint8_t> motion;
  int held(std::size_t grain) const { return motion.empty() ? 0 : motion[grain] & 3; }
  bool velocity_is_held(std::size_t grain) const { return (held(grain) & 1) != 0; }
  // Pa, of the fluid on the grain: sum F_a x_b over the surface, over the volume. Empty unless the last step measured
  // it (System::measure_grain_stress()).
  std::span<const Mat3> fluid_stress;
};

enum class FluidField { velocity, pressure, grain_id, density, shear_rate, eddy_viscosity, vorticity, q_criterion };

// Fluid fields of the cells of a block, x fastest, sampled on request; empty where not asked for. Zero in solid cells.
struct FluidFields {
  Block block;                         // in global coordinates
  std::vector<double> velocity;        // m/s, three values a cell (x, y, z together)
  std::vector<double> pressure;        // Pa above the reference (without the hydrostatic part in reduced gravity)
  std::vector<std::int32_t> grain_id;  // id of the covering grain; -1 fluid; -2, -3, ... solids
  std::vector<double> density;         // kg/m^3
  std::vector<double> shear_rate;      // 1/s, sqrt(2 S_ab S_ab) of the subgrid model
  std::vector<double> eddy_viscosity;  // m^2/s
  std::vector<double> vorticity;       // 1/s, three values a cell
  std::vector<double> q_criterion;     // 1/s^2
};

constexpr int components_of(FluidField field) {
  return field == FluidField::velocity || field == FluidField::vorticity ? 3 : 1;
}

// The values of any field but grain_id. Throws std::logic_error for that one.
std::vector<double>& values_of(FluidFields& fields, FluidField field);
const std::vector<double>& values_of(const FluidFields& fields, FluidField field);

class FluidSource {
public:
  virtual ~FluidSource() = default;

  // Fields in the cells of a region (global coordinates, the same on every rank) that this rank owns. Collective.
  virtual FluidFields sample(const std::vector<FluidField>& wanted, const Block& region) const = 0;

  // Calls visit(cell, velocity) for every fluid cell this rank owns: global cell, m/s in full precision.
  using VelocityVisitor = std::function<void(const Index3&, const Vec3&)>;
  virtual void for_each_velocity(const VelocityVisitor& visit) const = 0;

  struct State {
    Vec3 velocity;    // m/s
    double pressure;  // Pa, beyond that of the fluid at rest with its reference density
  };
  // State of a cell that this rank owns, by its global coordinates; none if a body covers it.
  virtual std::optional<State> state_in(const Index3& cell) const = 0;

  struct Drive {
    Vec3 body_force = Vec3::Zero();  // N/m^3, on every cell
    Vec3 on_top = Vec3::Zero();      // N, of the fluid on the whole face z_high, without the reference pressure
    Vec3 on_solids = Vec3::Zero();   // N, of the fluid on all solids, without the reference pressure
  };
  // Driving force of the fluid, and its force on the upper face, in the next step; its force on solids in the last one.
  // Collective; the same bits on any number of ranks.
  virtual Drive drive() const { return {}; }
};

// The momentum flux through a plane of cells (docs/theory.md, section 5, "Momentum balance by layers"): sums over its
// fluid cells.
struct PlaneMomentum {
  std::int64_t cells = 0;
  double density = 0.0;                        // kg/m^3
  Vec3 flow = Vec3::Zero();                    // rho u, kg/(m^2 s)
  std::array<double, 6> flow_flux{};           // rho u_a u_b, Pa: xx, yy, zz, xy, xz, yz
  std::array<double, 6> viscous{}, subgrid{};  // Pa, without the pressure
};

// The momentum budget of a fluid among grains in one step, over the whole domain: fluxes, sources and sinks. The same
// bits on every rank, and on any number of ranks.
struct MomentumBudget {
  std::vector<PlaneMomentum> planes;      // of cells, from the floor
  std::vector<Vec3> on_grains;            // N, by height: entry h lies h half cells above the floor, h = 0 .. 2 n_z
  std::vector<Vec3> on_solids, on_sides;  // N, on solids, and on the faces across x and y, by height as on_grains
  std::vector<Vec3> on_obstacles;         // N, by height, that of on_grains on obstacles; empty: there are none
  Vec3 on_top = Vec3::Zero();             // N, on the face z_high
  Vec3 driving = Vec3::Zero();            // N/m^3, of the force that drives the fluid
  Vec3 driving_of_grains = Vec3::Zero();  // N/m^3, that part of it which the volume of grains feels, too
};

// A contact as one of its grains feels it, and what it touches.
struct ContactEnd {
  Vec3 arm;          // m, from the grain's centre to the contact
  Vec3 force;        // N, on the grain
  GlobalId partner;  // the other grain; -1 - w for wall w
  Vec3 to_partner;   // m, from the grain's centre to the partner's; of a wall, to the nearest point of it
};

// The contacts of the grains, as each grain feels them.
class ContactSource {
public:
  virtual ~ContactSource() = default;

  // Calls visit(grain, arm, force) for every contact of every grain of the GrainView (its number there), in the order
  // of its neighbours' ids, then of its walls: m from its centre (of a clump's member, the clump's) to the contact, N
  // on the grain. A contact of two grains comes up once for each of them.
  using ContactVisitor = std::function<void(std::size_t, const Vec3&, const Vec3&)>;
  virtual void for_each_contact(const ContactVisitor& visit) const = 0;

  // Visits the lubrication forces between near surfaces, which the fluid's cells do not resolve.
  virtual void for_each_lubrication(const ContactVisitor& /*visit*/) const {}

  // Contacts of the chosen grains (chosen[n] != 0 for number n of the GrainView) with their partners. Arms are from the
  // grain's own centre, even for a member of a clump. Contacts of other grains are not computed.
  using ContactEndVisitor = std::function<void(std::size_t, const ContactEnd&)>;
  virtual void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const = 0;

  // The forces of walls on all grains of the view: contacts, then lubrication.
  virtual void for_each_wall_force(const ContactEndVisitor& /*visit*/) const {}
};

struct Snapshot {
  double time = 0.0;  // s
  std::int64_t step = 0;
  const Decomposition* decomposition = nullptr;
  GrainView grains;                          // global_count 0: no grains
  const FluidSource* fluid = nullptr;        // null: no fluid
  const ContactSource* contacts = nullptr;   // null: no grains
  const MomentumBudget* momentum = nullptr;  // of the last step; null unless requested (System::record_momentum)
};

}  // namespace thalweg
