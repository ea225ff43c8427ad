// The grains a rank knows, as a structure of arrays: those it owns in [0, owned), sorted by id, then its ghosts, copies
// of grains owned elsewhere, in [owned, total()). SI units. Slots change only in GrainDynamics::turn_over(), prepare(),
// prepare_part() and load().
#pragma once

#include "core/base/types.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

// Components of the motion that forces may change. A held component keeps the velocity it was given (zero: it does not
// move). A member of a clump (clumps.hpp) is moved by the clump and holds what the clump holds.
enum class Motion : std::uint8_t { free = 0, held_translation = 1, held_rotation = 2, fixed = 3, member = 4 };

inline bool holds_translation(Motion motion) { return (static_cast<unsigned>(motion) & 1u) != 0; }
inline bool holds_rotation(Motion motion) { return (static_cast<unsigned>(motion) & 2u) != 0; }
inline bool is_fixed(Motion motion) { return holds_translation(motion) && holds_rotation(motion); }
inline bool is_member(Motion motion) { return (static_cast<unsigned>(motion) & 4u) != 0; }
inline Motion member_of(Motion clump) { return static_cast<Motion>(static_cast<unsigned>(clump) | 4u); }

struct GrainStore {
  static constexpr double of_sphere = 0.4, of_disk = 0.5;  // I/(m R^2), of a disk about its axis

  explicit GrainStore(int attached_columns = 0, double inertia_shape = of_sphere)
      : attached_width(attached_columns), shape(inertia_shape) {}

  std::size_t owned = 0;
  std::size_t total() const { return id.size(); }

  std::vector<GlobalId> id;
  std::vector<double> radius;  // m
  std::vector<double> mass;    // kg; of a clump's member: of the clump, which is what contacts feel
  // kg m^2, 2/5 m R^2; disks 1/2 m R^2. Of a clump's member with its radius and the clump's mass: no moment of the
  // clump, and only the dashpot of rolling friction takes it for one.
  std::vector<double> inertia;
  std::vector<double> inverse_mass;     // 1/kg, 0 where the translation is held, and of a clump's members
  std::vector<double> inverse_inertia;  // 1/(kg m^2), 0 where the rotation is held, and of a clump's members
  std::vector<Motion> motion;
  std::vector<GlobalId> clump;         // id of the clump the grain is a member of: that of its first member; else -1
  std::vector<Vec3> offset;            // m, of a clump's member: from its centre, in the frame of its principal axes
  std::vector<std::uint8_t> material;  // number in the table of materials
  std::vector<Vec3> position;          // m, global and unshifted, also of ghosts
  std::vector<Vec3> velocity;          // m/s
  std::vector<Vec3> angular_velocity;  // rad/s
  std::vector<Vec3> contact_force;     // N, sum over contacts at the last evaluation; of ghosts meaningless
  std::vector<Vec3> contact_torque;    // N m
  std::vector<Vec3> load_force;        // N, set from outside, constant during the sub-steps; of ghosts not used
  std::vector<Vec3> load_torque;       // N m

  // Columns of the caller (for example the last fluid load): carried at migration, given to new ghosts, saved and
  // loaded, never interpreted here. Grain `slot` has attached_width values from slot * attached_width on.
  int attached_width;
  double shape;  // of all grains: of_sphere or of_disk
  std::vector<double> attached;
  std::span<double> attached_of(std::size_t slot) {
    return {attached.data() + slot * attached_width, static_cast<std::size_t>(attached_width)};
  }
  std::span<const double> attached_of(std::size_t slot) const {
    return {attached.data() + slot * attached_width, static_cast<std::size_t>(attached_width)};
  }

  bool is_ghost(std::size_t slot) const { return slot >= owned; }

  void clear();
  void reserve(std::size_t grains);
  // A grain at rest without forces at the end of the arrays; its attached columns are zero.
  void append(GlobalId grain, double grain_radius, double grain_mass, Motion grain_motion, const Vec3& grain_position,
              int grain_material = 0);
  void drop_ghosts();

private:
  template <typename Visitor>
  void for_each_column(Visitor&& visit);
};

}  // namespace thalweg::dem
