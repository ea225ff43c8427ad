// Rigid bodies in a lattice fluid: the cells they cover, the links to the fluid around them, the patches they occlude
// from each other, and the sums of force, torque and mass of every step. Bodies have slots: first the solids, which
// stand still or move, then spheres. Lattice units.
//
// A step, in this order:
//   begin_step()             forgets the last one
//   add(), remove()          where bodies come into reach of this rank or leave it
//   move(), remap()          the motion of every sphere; cells follow where remap() says so
//   move_solid()             the motion of every solid that moves; its cells follow
//   settle()                 cells change hands
//   refill()                 uncovered cells get their populations; collective
//   update_links()           before the sweep; may overlap with the exchange of the halo
//   sweep()                  links tile by tile, each before its rows are swept; then hidden surfaces
//   body(slot)               the sums of this rank
#pragma once

#include "bodies/links/interpolated_bounce_back.hpp"
#include "bodies/links/link_builder.hpp"
#include "bodies/links/occluded_links.hpp"
#include "bodies/links/solids.hpp"
#include "bodies/map/body_map.hpp"
#include "bodies/map/body_options.hpp"
#include "bodies/map/hydrostatic.hpp"
#include "bodies/map/link_table.hpp"
#include "bodies/mass_return.hpp"
#include "bodies/refill.hpp"
#include "core/base/phase_timer.hpp"
#include "lbm/fluid/fluid.hpp"

#include <array>
#include <vector>

namespace thalweg::bodies {

// What a step measures besides the sums of every body.
struct StepMeasurements {
  bool momentum_by_height = false;  // Bodies::momentum_by_height()
  bool moments = false;             // Bodies::moments()
};

// This rank's part of the sums that a balance of the fluid needs, of one step.
struct ExchangeTotals {
  Vec3 link_momentum = Vec3::Zero();  // force on the bodies through this rank's links
  Vec3 kept = Vec3::Zero();           // part of `covered` that the bodies got
  Vec3 refilled = Vec3::Zero();       // given to uncovered cells
  Vec3 covered = Vec3::Zero();        // lost in cells that became solid
  // Angular momenta about the origin, meaningful only in a box without periodic faces.
  Vec3 link_angular_momentum = Vec3::Zero();
  Vec3 kept_angular_momentum = Vec3::Zero();
  Vec3 refilled_angular_momentum = Vec3::Zero();
  Vec3 covered_angular_momentum = Vec3::Zero();
  // Gained by the fluid, LatticeFixed sums.
  std::int64_t link_mass = 0, refilled_mass = 0, covered_mass = 0;
};

// Motion of a body in the coming step; the fields of LinkBody.
struct BodyMotion {
  Vec3 centre, velocity, angular_velocity;
  double returned;  // mass density returned by its links (mass_return.hpp)
  Vec3 returned_slope;
  double surrounding;  // rho - rho_rest of the fluid around it
};

// Motion of a solid in the coming step.
struct SolidMotion {
  RigidTransform transform;
  Vec3 velocity, angular_velocity;  // of and about its centre
  MassReturn returned;
};

template <typename Real>
class Bodies {
public:
  // The decomposition and the fluid, whose cells this marks, must outlive it. solids: where two overlap, one that
  // stands still has the cell, or else the first one, and before any sphere. Those that move begin where they are
  // given. Throws InputError where a solid that stands still covers no cell. Collective.
  Bodies(const Decomposition& decomposition, MPI_Comm communicator, lbm::Fluid<Real>& fluid, const BodyOptions& options,
         const Hydrostatic& rest, std::vector<Solid> solids = {});

  // Limits of the link format. check_block() is called before a run and throws InputError on every rank if a block has
  // too many cells; check_count() is called when bodies were added and throws Error if a rank has too many. Collective.
  void check_block(MPI_Comm communicator) const;
  template <typename Error>
  void check_count(MPI_Comm communicator) const;

  int solids() const { return map_.solids(); }  // in the slots below this
  const Solids& solid_shapes() const { return solids_; }

  const std::vector<MappedBody>& mapped() const { return map_.bodies(); }  // by slot; a free one has the id -1
  BodySlot slot_of(GlobalId id) const { return map_.slot_of(id); }         // none: not on this rank
  const LinkBody& body(BodySlot slot) const { return bodies_[index_of(slot)]; }
  const LinkSums& link_sums(BodySlot slot) const { return links_.sums_of(static_cast<int>(slot)); }
  // Whether the step measures moments(), and these: sum F_a x_b of a body, 0 of a solid.
  bool has_moments() const { return measured_.moments; }
  const FixedTensor& moments(BodySlot slot) const { return moments_[index_of(slot)]; }
  // Patches of every body that solids occlude, by slot (OccludedPatches::by_solids()); moments() does not contain them.
  std::vector<std::array<std::int64_t, 3>> occluded_by_solids() const {
    return map_.occluded_patches().by_solids(bodies_.size(), solids());
  }
  // Force on each face of the box under the patches of spheres that it occludes, this rank's share; of the last step.
  std::array<FixedVec3, 6> occluded_wall_forces() const;
  const LinkTable& links() const { return links_; }
  const ExchangeTotals& step_totals() const { return totals_; }

  // rho - 1 whose pressure counts as no force: the mean excess of the fluid.
  double reference_density() const { return options_.links.reference_density; }
  void set_reference_density(double density) { options_.links.reference_density = density; }

  void begin_step(const StepMeasurements& measured = {});
  BodySlot add(GlobalId id, double radius, GlobalId clump, const Vec3& centre);  // a new slot, with cells at `centre`
  void remove(BodySlot slot);                                                    // removes a sphere
  void move(BodySlot slot, const BodyMotion& motion);
  void remap(BodySlot slot, const Vec3& centre);
  void move_solid(int solid, const SolidMotion& motion);
  void settle();
  void refill();
  void update_links();  // writes no population
  // Applies the links and sweeps the fluid. The time goes to these phases of the timer.
  void sweep(PhaseTimer& timer, int sweep_phase, int links_phase);

  // Cells and links without a step, as at a start: nothing is refilled. After begin_step(), add() and remap().
  void settle_at_start();
  void remove_all();  // spheres

  // Fills the slots that links fill, as the sweep will do again, and changes no body. by_height: as for
  // InterpolatedBounceBack.
  void apply_links_on_copies(MomentumByHeight* by_height = nullptr) const;
  // The momentum that links and covered cells give to bodies in a step that measures it, by half planes of cells
  // (InterpolatedBounceBack); before its sweep, whose slots it fills as well.
  const MomentumByHeight& momentum_by_height();

private:
  void add_solids(MPI_Comm communicator);
  void resize_to_slots();
  void settle_cells();
  void account_for_covered_cells();
  void keep_momentum(LinkBody& body, int plane, const Vec3& position, double density, const Vec3& momentum);
  void add_link_totals();

  lbm::Fluid<Real>& fluid_;
  BodyOptions options_;
  PeriodicBox box_;  // cells
  Hydrostatic rest_;
  BodyMap map_;
  LinkTable links_;
  Solids solids_;
  LinkBuilder link_builder_;
  OccludedLinks occluded_links_;
  Refill refill_;
  std::vector<LinkBody> bodies_;     // by slot
  std::vector<double> surrounding_;  // by slot
  StepMeasurements measured_;
  std::vector<FixedTensor> moments_;     // by slot, where measured
  MomentumByHeight by_height_;           // empty unless measured
  bool settled_ = true, linked_ = true;  // cells and links are those of the present positions
  ExchangeTotals totals_;
};

}  // namespace thalweg::bodies
