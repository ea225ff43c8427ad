// Grains as bodies in the lattice fluid: what a grain does becomes the motion of its body, and what the body felt in a
// step becomes the load of the grain and the mass that it owes to the fluid. SI units on the side of the grains,
// lattice units on that of the bodies.
#pragma once

#include "bodies/bodies.hpp"
#include "core/base/units.hpp"
#include "coupling/loads/grain_exchange.hpp"
#include "coupling/loads/grain_sums.hpp"
#include "coupling/loads/light_load.hpp"
#include "coupling/loads/load_averaging.hpp"
#include "dem/grain_dynamics.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::coupling {

template <typename Real>
class GrainBodies {
public:
  // Both must outlive it; the grains carry GrainExchange::width attached columns.
  GrainBodies(MPI_Comm communicator, dem::GrainDynamics& grains, bodies::Bodies<Real>& bodies, const PeriodicBox& box,
              const Units& units, LoadAveraging load);

  // Links of grains that have not been in this fluid before are cut where the grains are.
  void begin_where_grains_are();
  // The bodies of a start, where cells have never been fluid. Removes all spheres first.
  void place_at_start();
  // Sets rho - rho_rest around grains without an exchange yet.
  void set_surroundings(double deviation);
  // After grains have been taken from a run on another lattice, what they keep in its units means nothing.
  void forget_lattice_units();

  // Gives the bodies the present motions of their grains, with which the cells of grains that leave are refilled.
  void update_motions();
  // The motions of a step, and the cells of those that moved beyond the tolerance. slots_changed: whether grains have
  // come into reach of this rank or left it.
  void move_bodies(bool slots_changed);
  // Loads on the grains from the sums of their bodies, and what these return of mass in the next step; stresses in a
  // step that measures the bodies' moments. Collective.
  void take_loads();

  double mass_owed() const;  // to the fluid, by all ranks: exact sums of multiples of 2^-44. Collective
  std::span<const Mat3> stresses() const { return stresses_; }  // Pa, of owned grains, if the last step measured them

private:
  GrainExchange<double> exchange_of(std::size_t grain) { return GrainExchange(grains_.store().attached_of(grain)); }
  GrainExchange<const double> exchange_of(std::size_t grain) const {
    return GrainExchange(std::as_const(grains_).store().attached_of(grain));
  }
  Vec3 lattice_position(const Vec3& position) const { return position / units_.spacing; }
  void synchronise_slots();
  void update_cells();
  void collect();
  void apply();
  void set_load(std::size_t grain, const Vec3& force, const Vec3& torque);
  void apply_stresses();
  Mat3 stress_of(std::size_t grain) const;
  void settle_masses();
  void settle_mass(std::size_t first, std::size_t count);
  Mat3 moment_occluded_by_solids(std::size_t grain) const;

  MPI_Comm communicator_;
  dem::GrainDynamics& grains_;
  bodies::Bodies<Real>& bodies_;
  PeriodicBox box_;  // m
  Units units_;
  LoadAveraging load_;
  LightLoad light_load_;
  std::vector<bodies::BodySlot> slot_;  // of each grain of the store
  GrainSumRows sums_;                   // of each grain of the store
  std::vector<Mat3> stresses_;
};

}  // namespace thalweg::coupling
