// The clumps a rank owns, and how they move: rigid bodies whose members are rows of GrainStore.
//
// Contacts, ghosts and fluid see the members as spheres that move as points of the body, v_m = V + w x r_m, all with
// its angular velocity w. Forces and torques on members go to the centre of mass, in the order of ids,
//   F = sum F_m,   T = sum (T_m + r_m x F_m),
// and move it by the velocity Verlet of grain_dynamics.hpp: half kicks of V and of the angular momentum L, a drift of
// the centre, and the free rotation of rigid_rotation.hpp in between. A clump is owned by the rank of its centre, and
// with it are its members, wherever they are. SI units.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/parallel/decomposition.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <mpi.h>

#include <functional>
#include <utility>
#include <vector>

namespace thalweg::dem {

struct Clump {
  GlobalId id;  // of its first member; members have consecutive ids
  std::int64_t members;
  Motion motion;
  double mass, volume;     // kg, m^3
  Vec3 moments;            // kg m^2, about the principal axes
  Quaternion orientation;  // of the principal axes
  Vec3 centre;             // m, global
  Vec3 velocity;           // m/s, of the centre
  Vec3 angular_momentum;   // kg m^2/s, about the centre
  Vec3 angular_velocity;   // rad/s

  double kinetic_energy() const {
    return 0.5 * mass * velocity.squaredNorm() + 0.5 * angular_velocity.dot(angular_momentum);
  }
};

// A clump as a row of plain values, for messages between ranks and for files.
struct ClumpRow {
  GlobalId id;
  std::int64_t members, motion;
  double mass, volume;
  double moments[3], orientation[4], centre[3], velocity[3], angular_momentum[3], angular_velocity[3];
};

ClumpRow row_of(const Clump& clump);
Clump clump_of(const ClumpRow& row);
Clump clump_of(const ClumpSeed& seed, const PeriodicBox& box);

class Clumps {
public:
  explicit Clumps(double disk_thickness = 0.0) : disk_thickness_(disk_thickness) {}  // m; 0: of spheres

  bool empty() const { return clumps_.empty(); }
  std::size_t size() const { return clumps_.size(); }
  const Clump& operator[](std::size_t n) const { return clumps_[n]; }
  std::size_t first_slot(std::size_t n) const { return first_slot_[n]; }  // slot of the first member in the store

  // Replaces all clumps; their ids must ascend. find_members() and compute_body_forces() must follow.
  void replace(std::vector<Clump> clumps) { clumps_ = std::move(clumps); }

  // Finds the members among the owned grains of the store; compute_body_forces() must follow.
  void find_members(const GrainStore& store);

  // body_force: as in GrainParameters, for a clump's mass and the radius of the sphere (disk) of its volume.
  void compute_body_forces(const std::function<Vec3(double, double)>& body_force);

  // Gives the members shares of their clump's body force that have no moment about its centre.
  void share_body_force(std::vector<Vec3>& of_slot) const;

  double volume_radius(GlobalId clump) const;  // m, of the sphere (disk) of the volume of a clump owned here
  // m, shortest axis of the ellipsoid of the mass and the moments of a clump owned here; at least a fifth of the
  // diameter of its volume, which a plate that is given by its moments could fall below.
  double width(GlobalId clump) const;
  double radius_of(const Clump& clump) const;  // the same
  std::size_t member_count(std::size_t n) const { return static_cast<std::size_t>(clumps_[n].members); }

  void wrap(const PeriodicBox& box);

  // Sets the owner (a rank) of every member to that of its clump's centre.
  void assign_owners(const Decomposition& decomposition, std::vector<int>& owner_of_slot) const;
  // Sends every clump to the rank of its centre. Collective.
  void migrate(const Decomposition& decomposition, MPI_Comm communicator);

  // Takes the loads of the store, with torques about the present centres; to be called before the sub-steps.
  void gather_loads(const GrainStore& store);
  // Sets a load (N) at the centre during the sub-steps; the store gets it in equal shares on the members.
  void set_central_force(std::size_t n, const Vec3& force, GrainStore& store);
  // Stops the clump along x and y and balances the force on it in these directions, without a torque.
  void stop_along_floor(std::size_t n, PackedGrainState& grains);
  // `count` half kicks (one or two) by the members' present forces. time_step: s.
  void half_kicks(const PackedGrainState& grains, double time_step, int count);
  void drift(double time_step);  // s
  // Writes position, velocity and spin of all members.
  void place(PackedGrainState& grains, const PeriodicBox& box) const;

  // Force (N) and torque (N m) about the centre, of all contacts, loads and the body force, from the store.
  Vec3 force(std::size_t n, const GrainStore& store) const;
  Vec3 torque(std::size_t n, const GrainStore& store) const;

  // The largest acceleration (m/s^2) that loads and body forces give any member of a clump that is free to move.
  double largest_pull(const GrainStore& store) const;

private:
  const Clump& with_id(GlobalId id) const;  // owned here
  Vec3 arm(std::size_t n, std::size_t member) const { return arms_[first_arm_[n] + member]; }
  void turn_arms(std::size_t n);
  void gather_load(std::size_t n, const GrainStore& store);
  void add_loads(std::size_t n, const GrainStore& store, Vec3& force, Vec3& torque) const;

  // Load on a clump besides contacts, about its centre.
  struct Load {
    Vec3 force, torque;
  };

  double disk_thickness_;
  std::vector<Clump> clumps_;  // sorted by id
  std::vector<std::size_t> first_slot_, first_arm_;
  std::vector<Vec3> offsets_, arms_;  // m, centre to member: in the frame of the principal axes, in space
  std::vector<Vec3> body_force_;      // N
  std::vector<Load> loads_;
};

}  // namespace thalweg::dem
