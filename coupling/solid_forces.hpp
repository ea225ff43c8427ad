// The force of the fluid on every solid in the last step, over all ranks, as reports and checkpoints have it. Lattice
// units.
#pragma once

#include "bodies/bodies.hpp"
#include "core/archive.hpp"

#include <mpi.h>

#include <vector>

namespace thalweg::coupling {

class SolidForces {
public:
  SolidForces(MPI_Comm communicator, int solids) : communicator_(communicator), solids_(solids) {}

  // Collective.
  template <typename Real>
  std::vector<Vec3> of(const bodies::Bodies<Real>& bodies) const {
    return in_vectors(sums_of(bodies));
  }
  template <typename Real>
  void save(const bodies::Bodies<Real>& bodies, ArchiveWriter& archive) const {
    write(sums_of(bodies), archive);
  }
  // Until forget(), those of the checkpoint. Throws InputError where the archive does not hold as many solids.
  void load(ArchiveReader& archive);
  void forget() { loaded_.clear(); }

private:
  // Integers, so that no order of ranks matters.
  template <typename Real>
  std::vector<std::int64_t> sums_of(const bodies::Bodies<Real>& bodies) const {
    if (!loaded_.empty()) return loaded_;
    std::vector<std::int64_t> sums;
    for (int s = 0; s < solids_; ++s) {
      const FixedVec3& force = bodies.body(s).force;
      sums.insert(sums.end(), {force.x, force.y, force.z});
    }
    return over_ranks(std::move(sums));
  }
  std::vector<std::int64_t> over_ranks(std::vector<std::int64_t> sums) const;
  static std::vector<Vec3> in_vectors(const std::vector<std::int64_t>& sums);
  void write(const std::vector<std::int64_t>& sums, ArchiveWriter& archive) const;

  MPI_Comm communicator_;
  int solids_;
  std::vector<std::int64_t> loaded_;
};

}  // namespace thalweg::coupling
