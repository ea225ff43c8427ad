// Rigid assemblies: grains that move together as one body with a prescribed motion, whatever forces act on them.
#pragma once

#include "core/base/archive.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/motion/grain_seed.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"
#include "dem/motion/prescribed_motion.hpp"

#include <mpi.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thalweg::dem {

class Assemblies {
public:
  // motions: one for each assembly, by the numbers in the seeds. Throws InputError for an impossible motion, or for a
  // seed whose assembly does not exist or that is not fixed.
  Assemblies(const std::vector<PrescribedMotion>& motions, std::span<const GrainSeed> seeds);

  bool any() const { return !members_.empty(); }
  double largest_speed() const { return largest_speed_; }  // m/s, of any member at any time

  // Finds the members among the owned grains; to be called when slots have changed.
  void find(const GrainStore& store);

  // Places owned members as they are at one time (s), wrapped into the box, with their velocities at another (s).
  void place(PackedGrainState& grains, const PeriodicBox& box, double time, double time_of_velocity) const;

  // The initial places of all members, which every rank knows; loading replaces those of the seeds, and throws
  // InputError where the archive has none or more than here. Collective.
  void save(ArchiveWriter& archive, const std::string& group, MPI_Comm communicator) const;
  void load(ArchiveReader& archive, const std::string& group);

private:
  struct Member {
    GlobalId id;
    std::int64_t assembly;
    Vec3 at_start;  // m
  };
  struct OwnedMember {
    std::uint32_t slot;
    std::size_t member;
  };

  void find_largest_speed();

  std::vector<PrescribedMotion> motions_;
  std::vector<Member> members_;     // sorted by id
  std::vector<OwnedMember> owned_;  // of this rank
  double largest_speed_ = 0.0;
};

// Throws InputError where an assembly turns and two of its grains touch across a periodic face, unless that is across
// the axis of its rotation alone: they would turn about different images of the axis, and part. Positions must be in
// the box.
void check_whole(const std::vector<PrescribedMotion>& motions, std::span<const GrainSeed> seeds,
                 const PeriodicBox& box);

}  // namespace thalweg::dem
