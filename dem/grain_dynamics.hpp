// The grains of a run and their motion with contacts, on the blocks of a decomposition, by velocity Verlet:
//
//   v(n+1/2) = v(n) + dt/2 a(n);  x(n+1) = x(n) + dt v(n+1/2);  forces from x(n+1), v(n+1/2);
//   v(n+1) = v(n+1/2) + dt/2 a(n+1);  the same for the angular velocity with I = 2/5 m R^2 (disks 1/2 m R^2).
//
// Clumps, rigid grains of several spheres, move as clumps.hpp says; their members are rows of the store like spheres.
// SI units. The state after any number of steps is bitwise the same on any number of ranks, in any layout, and after
// any save and load. A step of the caller (a fluid step) is
//   prepare();  ... loads into store() ...;  advance(sub_steps);  refresh_ghosts();
#pragma once

#include "core/base/archive.hpp"
#include "core/base/phase_timer.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/state/location.hpp"
#include "core/state/snapshot.hpp"
#include "core/state/system.hpp"
#include "dem/clumps/assemblies.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "dem/clumps/clumps.hpp"
#include "dem/contact/acting_state.hpp"
#include "dem/contact/lubrication.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/contact/solid.hpp"
#include "dem/force_field.hpp"
#include "dem/laws/material.hpp"
#include "dem/lightest_grain.hpp"
#include "dem/motion/grain_seed.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"
#include "dem/motion/walls.hpp"
#include "dem/ranks/ghost_exchange.hpp"
#include "dem/ranks/grain_batch.hpp"
#include "dem/supply/supply.hpp"
#include "dem/supply/turnover.hpp"

#include <mpi.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::dem {

struct GrainParameters {
  ContactParameters contact;                       // material 0
  std::vector<ContactParameters> other_materials;  // 1, 2, ...: mixed with each other as material.hpp says
  std::optional<ContactParameters> wall_contact;   // of grains with walls, where it differs (but for the friction)
  std::vector<Plane> walls;
  std::vector<Solid> solids;
  std::vector<PrescribedMotion> assemblies;  // of the rigid assemblies the seeds name
  std::vector<Supply> supplies;              // of grains like those of the start: no larger, none of other materials
  std::vector<Sink> sinks;
  // N, of a grain by its mass (kg) and radius (m, of a clump that of its volume), constant; empty: none
  std::function<Vec3(double mass, double radius)> body_force;
  double time_step = 0.0;    // s, of a sub-step: at most a 20th of the shortest contact time
  int sub_steps = 1;         // at most that many between two calls of prepare()
  double skin = 0.0;         // m: the neighbour list holds until a grain has moved half of it
  double ghost_width = 0.0;  // m: grains at least this near to a rank's block are its ghosts at all times
  int attached_width = 0;    // the caller's columns attached to every grain
  std::optional<LubricationParameters> lubrication;  // between near surfaces, in every sub-step
  std::shared_ptr<ForceField> field;                 // on every grain, in every sub-step
  double disk_thickness = 0.0;                       // m, of disks in an x-z plane: I = 1/2 m R^2; 0: spheres
  bool movable_cuts = false;                         // true if the cuts between ranks follow the grains
  double initial_overlap = allowed_initial_overlap;  // diameters, by which seeds may overlap: those of a settled bed do
};

// Throws InputError if the time step is too long for contacts among `count` grains, the lightest of each material of
// which are given.
void check_time_step(const GrainParameters& parameters, std::span<const LightestGrain> lightest, std::int64_t count);

// Throws InputError where the lubrication force, if there is one, does not suit these grains or the box
// (lubrication.hpp). largest_radius: m, of all grains.
void check_lubrication(const GrainParameters& parameters, std::span<const LightestGrain> lightest,
                       double largest_radius, const PeriodicBox& box);

// Contact of two grains, or of a grain with a wall or solid.
struct Contact {
  GlobalId first, second;  // the lower id; the higher one, or -1 - w for wall w, -1 - (number of walls + s) for solid s
  double overlap;          // m
  Vec3 normal;             // unit, from second to first
  std::vector<double> history;  // kept by its law (contact_law.hpp) at the last evaluation
};

// Name of the diagnostics of the force of all grains on a solid.
std::string solid_force_diagnostic(std::size_t solid);

class GrainDynamics {
public:
  // Each rank keeps the grains it owns. The ids of grains and of members together are 0 .. their number - 1. Throws
  // InputError, on every rank, for impossible parameters, a time step too long, or impossible seeds (grain_seed.hpp,
  // clump_seed.hpp). Contact forces are evaluated (without moving any spring), so that the first half kick has its
  // forces. No seeds: load() is to follow. Collective.
  GrainDynamics(const Decomposition& decomposition, MPI_Comm communicator, const GrainParameters& parameters,
                GrainSeeds seeds);
  // Constructor from full lists of seeds.
  GrainDynamics(const Decomposition& decomposition, MPI_Comm communicator, const GrainParameters& parameters,
                const std::vector<GrainSeed>& grains, const std::vector<ClumpSeed>& clumps = {})
      : GrainDynamics(decomposition, communicator, parameters, GrainSeeds{grains, clumps}) {}
  GrainDynamics(const GrainDynamics&) = delete;
  GrainDynamics& operator=(const GrainDynamics&) = delete;

  // Takes grains in sinks out of the box and brings in those that are due, before prepare(). True if slots changed.
  // fluid_velocity: m/s, at a point that this rank owns, for those that come in with it; empty: they come in at rest.
  // Without sinks and supplies it does nothing; with them it is up to three reductions. Collective.
  bool turn_over(const std::function<Vec3(const Vec3& point)>& fluid_velocity = {});
  bool has_turnover() const { return turnover_.any(); }  // supplies or sinks

  // Prepares the sub-steps of a fluid step: wraps positions and, if some grain may leave its half skin during them,
  // moves grains to the rank of their centre and rebuilds ghosts and neighbour list. True if slots changed. Throws
  // RunError, on every rank, if a grain has moved more than half the skin, moves more than its radius in one fluid
  // step, is beyond a wall or a non-periodic face by more than its radius, is half its radius deep in a plate or a
  // solid, or is no longer a number. One reduction. Collective.
  bool prepare();

  // Prepares a part of the sub-steps, for grains too fast for one list per fluid step. Returns the number of sub-steps
  // that may follow, at most GrainParameters::sub_steps; it depends on the state alone, not on the age of the list.
  int prepare_part();

  // Moves the grains under the loads in store(). At most GrainParameters::sub_steps since prepare(), or as many as
  // prepare_part() has allowed; after more, a grain may have outrun its list, for which the next prepare() throws.
  // Collective.
  void advance(int sub_steps);

  // Scales the body forces of the sub-steps to come: 1 at first. Not part of a checkpoint: a caller who changes it must
  // set it again after load().
  void set_body_force_factor(double factor);
  // Adds a force on their volume (N/m^3): none at first, and the same holds.
  void set_force_density(const Vec3& density);
  // Keeps both beside those that are set from now on.
  void keep_body_force();

  // After the sub-steps: wraps positions and gives ghosts the final velocities of their owners. Collective.
  void refresh_ghosts();
  // The attached columns first ... first + count - 1 of ghosts, if the caller changed those of owned grains; count must
  // always be the same.
  void refresh_ghost_attached(std::size_t first, std::size_t count);

  // Adds what every rank has for its ghosts in `values` (width integers a grain of the store) to the owners' entries:
  // sums of loads over ranks, exact in any order. Collective.
  void add_ghost_values(std::vector<std::int64_t>& values, int width) { ghosts_.add_to_owners(values, width); }

  // Loads and attached columns are the caller's to write; the rest is read-only.
  GrainStore& store() { return store_; }
  const GrainStore& store() const { return store_; }
  // N; of a clump's member its share of the clump's
  const Vec3& body_force(std::size_t owned_slot) const { return body_force_[owned_slot]; }
  // The same with the factor and the density that held when keep_body_force() was last called.
  const Vec3& kept_body_force(std::size_t owned_slot) const {
    return kept_body_force_.empty() ? body_force_[owned_slot] : kept_body_force_[owned_slot];
  }
  // m, of the sphere (disk) with the volume of a grain, or of a member's whole clump
  double volume_radius(std::size_t owned_slot) const {
    return store_.clump[owned_slot] < 0 ? store_.radius[owned_slot] : clumps_.volume_radius(store_.clump[owned_slot]);
  }
  // m, the diameter, or the width of the clump of a member (Clumps::width()).
  double width(std::size_t owned_slot) const {
    return store_.clump[owned_slot] < 0 ? 2.0 * store_.radius[owned_slot] : clumps_.width(store_.clump[owned_slot]);
  }
  const Clumps& clumps() const { return clumps_; }  // those owned here
  const GrainParameters& parameters() const { return parameters_; }
  const Decomposition& decomposition() const { return decomposition_; }  // the present one, if cuts move
  const std::vector<Plane>& walls() const { return planes_; }            // where they are now
  double time() const { return static_cast<double>(steps_done_) * parameters_.time_step; }  // s, since the start
  double largest_radius() const { return largest_radius_; }                                 // m, over all ranks
  std::int64_t global_count() const { return global_count_; }  // rows over all ranks: grains and members of clumps
  std::int64_t clump_count() const { return clump_count_; }    // over all ranks
  std::int64_t member_count() const { return member_count_; }  // members of clumps over all ranks
  std::int64_t body_count() const { return global_count_ - member_count_ + clump_count_; }       // a clump counts once
  GlobalId id_limit() const { return std::max<GlobalId>(global_count_, turnover_.id_limit()); }  // ids are below it
  // Grains in the box and the balance of turnover.hpp; empty without supplies and sinks.
  std::vector<Diagnostic> turnover_diagnostics() const;
  void show_clumps(GrainView& view) const;             // the entries of the view that clumps have
  std::span<const std::uint8_t> motion() const;        // GrainView::motion, of owned grains
  std::int64_t rebuilds() const { return rebuilds_; }  // since construction or load
  PhaseTimer& timer() { return timer_; }               // contact lists, contact forces, motion, messages

  // The touching pairs whose lower id is owned here, sorted by ids, then the touching walls of owned grains.
  std::vector<Contact> contacts() const;

  // Every contact of every owned grain, as it felt it in the last sub-step (contact_forces.hpp, acting_state.hpp); of a
  // clump's member, with the arm from the clump's centre. After a load() and in prepare() by the velocities of
  // the store.
  void for_each_contact(const std::function<void(std::size_t slot, const Vec3& arm, const Vec3& force)>& visit) const;
  // Visits the lubrication forces (lubrication.hpp) likewise; there are none without lubrication.
  void for_each_lubrication(
      const std::function<void(std::size_t slot, const Vec3& arm, const Vec3& force)>& visit) const;
  // Contacts of some owned grains (chosen[slot] != 0), of a clump's member with the arm from its own centre.
  void for_each_contact_of(std::span<const char> chosen,
                           const std::function<void(std::size_t slot, const ContactEnd& end)>& visit) const;
  // Visits the forces of walls on all owned grains: contacts, then lubrication.
  void for_each_wall_force(const std::function<void(std::size_t slot, const ContactEnd& end)>& visit) const;

  // Diagnostics over all ranks, the same bits in any layout; a clump is one grain, with the velocity of its centre, but
  // overlap and contacts are those of its members. Collective.
  std::vector<Vec3> wall_forces() const;  // N, of all grains on each wall, then each solid, by contacts and lubrication
  std::int64_t contact_count() const;     // touching pairs of grains
  // Largest of two grains, not both held, in diameters of the smaller, and of one that is not held with a wall or a
  // solid.
  double largest_overlap() const;
  double kinetic_energy() const;                  // J, with rotation
  Vec3 momentum() const;                          // kg m/s
  double largest_speed() const;                   // m/s
  double largest_free_speed() const;              // m/s, of grains that are free to move
  double largest_acceleration() const;            // m/s^2, of the same, by all forces at the end of the last step
  std::int64_t moving_count(double speed) const;  // free grains faster than speed (m/s)
  std::int64_t free_count() const;
  double moving_share(double speed) const;  // share of the free grains; 0 if there are none
  // Free grains that are not slower than speed (m/s), or not accelerated by less than this (m/s^2).
  std::int64_t restless_count(double speed, double acceleration) const;

  // Locations of these two diagnostics: the pair, or the grain in a wall, that overlaps most, and the grain or clump
  // (by its first member) with the largest speed; among equals the lowest ids. Empty if there is none. Collective.
  std::optional<Location> place_of_deepest_overlap() const;
  std::optional<Location> place_of_fastest() const;

  // Everything the next sub-step depends on, sorted by id, below `group`; collective. To be called after
  // refresh_ghosts(). Loading replaces all grains, whatever the seeds were; parameters stay those given at
  // construction. Throws InputError where the archive does not fit the box, the walls or the time step.
  void save(ArchiveWriter& archive, const std::string& group = "grains") const;
  void load(ArchiveReader& archive, const std::string& group = "grains");

  // Takes the grains of another run as a start: with their velocities, held or not, and contact springs (those with
  // walls only where there are as many walls), but not its time. with_columns: and with the attached columns, where the
  // other run had the same; else these are zero. Throws InputError where there are grains here, but not as many, or
  // where this run has rigid assemblies. Collective.
  void take(ArchiveReader& archive, const std::string& group = "grains", bool with_columns = true);

private:
  enum class Restored { whole, start, start_without_columns };
  void restore(ArchiveReader& archive, const std::string& group, Restored what);
  void check_range() const;
  void place_walls(double time, double time_of_velocity);
  void place_solids(double time, double time_of_velocity);
  Surroundings surroundings() const { return {box_, planes_, solids_, parameters_.solids}; }
  void keep_acting_state();
  ActingGrains acting_grains() const { return {store_, acting_.grains}; }
  Surroundings acting_surroundings() const {
    return acting_.grains.empty() ? surroundings()
                                  : Surroundings{box_, acting_.walls, acting_.solids, parameters_.solids};
  }
  void place_prescribed(double time, double time_of_velocity);
  double largest_prescribed_speed() const;
  void check_prescribed_speed() const;
  double step_time() const { return parameters_.time_step * parameters_.sub_steps; }
  double ghost_reach() const;
  template <typename Visitor>
  void for_each_body(Visitor&& visit) const;
  template <typename Visitor>
  void for_each_wall_overlap(Visitor&& visit) const;
  void take_seeds(GrainSeeds seeds);
  void check_kinds(std::span<const GrainSeed> grains) const;
  double list_range() const;
  void wrap_positions();
  // Distance (m) of grains and walls from where the list was built, and bound of their speed (m/s); both the largest
  // over all ranks.
  struct Outlook {
    double farthest, fastest;
  };
  Outlook look_ahead();
  double fastest_member() const;
  std::vector<std::size_t> deep_in_solids() const;
  bool rebuild_for(const Outlook& outlook, int sub_steps);
  void rebuild();
  void rebuild_with(ContactHistories histories);
  // A body in its place. Its velocity is this one (m/s), or else its own if it keeps its motion, or else the fluid's.
  struct Arrival {
    TravellingBody body;
    std::optional<Vec3> velocity;
    bool keeps_motion;
  };
  std::vector<char> slots_in_sinks() const;
  std::vector<char> slots_in_bed() const;
  std::vector<TravellingBody> take_leaving(std::span<const char> leaves) const;
  void exchange_bodies(std::span<const char> leaves, std::span<const TravellingBody> leaving,
                       std::span<const Arrival> arriving, const std::function<Vec3(const Vec3&)>& fluid_velocity);
  void count_body(const TravellingBody& body, int sign);
  void save_turnover(ArchiveWriter& archive, const std::string& group) const;
  void load_turnover(ArchiveReader& archive, const std::string& group);
  void move_cuts();
  void migrate(ContactHistories& histories);
  ContactHistories load_histories(ArchiveReader& archive, const std::string& group, const GrainBatch& batch,
                                  const std::vector<int>& owner, std::int64_t walls);
  std::vector<Clump> load_clumps(ArchiveReader& archive, const std::string& group, const GrainBatch& batch,
                                 std::vector<int>& owner);
  void build_dependents(const ContactHistories& histories);
  struct BodyForceStrength {
    double factor = 1.0;
    Vec3 density = Vec3::Zero();  // N/m^3
    bool operator==(const BodyForceStrength&) const = default;
  };
  void compute_body_forces();
  void compute_body_forces(const BodyForceStrength& strength, std::vector<Vec3>& forces);
  std::vector<Vec3> places_in_clumps() const;
  void evaluate_forces(double time_step);
  bool touches_rough_floor(double z, double radius) const { return z - planes_[*rough_floor_].point.z() < radius; }
  // Visits the grains and clumps that the rough floor holds: on_grain(slot), on_clump(n). touches(slot): true if a
  // grain touches the floor.
  template <typename Touches, typename OnGrain, typename OnClump>
  void for_each_held(Touches touches, OnGrain on_grain, OnClump on_clump) const {
    for (std::size_t s = 0; s < store_.owned; ++s)
      if (store_.clump[s] < 0 && store_.inverse_mass[s] > 0.0 && touches(s)) on_grain(s);
    for (std::size_t n = 0; n < clumps_.size(); ++n) {
      bool held = false;
      for (std::size_t s = clumps_.first_slot(n), end = s + clumps_.member_count(n); s < end; ++s)
        held = held || touches(s);
      if (held && !holds_translation(clumps_[n].motion)) on_clump(n);
    }
  }
  void hold_on_rough_floor();
  void for_each_hold(std::span<const char> chosen, const ContactSource::ContactEndVisitor& visit) const;
  template <typename Work>
  void timed(int phase, Work&& work);
  void advance_by_verlet(int sub_steps);

  Decomposition decomposition_;
  PeriodicBox box_;
  MPI_Comm communicator_;
  GrainParameters parameters_;
  MaterialTable materials_;
  double largest_radius_ = 0.0;
  double largest_offset_ = 0.0;  // m, of any member from its clump's centre, over all ranks
  std::int64_t global_count_ = 0, clump_count_ = 0, member_count_ = 0;
  std::int64_t rebuilds_ = 0;

  std::int64_t steps_done_ = 0;             // sub-steps since the start of the run
  std::vector<Plane> planes_;               // the walls where they are now
  std::optional<std::size_t> rough_floor_;  // the one of them that is rough, if any
  std::vector<PlacedSolid> solids_;
  bool walls_change_, solids_change_;
  Assemblies assemblies_;

  Turnover turnover_;

  GrainStore store_;
  GhostExchange ghosts_;
  NeighbourList list_;
  PackedGrainState moving_;  // the state during the sub-steps
  ActingState acting_;       // of the last sub-step, until the ghosts are made anew
  Clumps clumps_{parameters_.disk_thickness};
  std::vector<Vec3> listed_position_;  // of owned grains, when the list was built
  std::vector<Plane> listed_planes_;
  std::vector<PlacedSolid> listed_solids_;
  BodyForceStrength strength_, kept_strength_;
  std::vector<Vec3> body_force_, kept_body_force_;  // N, of owned grains; the kept ones only where they are others

  PhaseTimer timer_;
  int lists_phase_, forces_phase_, motion_phase_, messages_phase_;
};

}  // namespace thalweg::dem
