// A grain or a clump on its way into the box or out of it.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/clumps/clumps.hpp"
#include "dem/ranks/grain_batch.hpp"

#include <mpi.h>

#include <optional>
#include <vector>

namespace thalweg::dem {

struct TravellingBody {
  std::vector<GrainRow> rows;     // the grain, or the members of the clump in order of id
  std::optional<ClumpRow> clump;  // none: a grain

  GlobalId id() const { return rows.front().id; }
  double mass() const { return rows.front().mass; }  // kg, of a clump the whole
  Vec3 centre() const {                              // m
    return clump ? Vec3(clump->centre) : Vec3(rows.front().value[GrainRow::position].data());
  }
  // m, from the centre of the body to that of row r, as it is turned
  Vec3 arm(std::size_t r) const;
  double reach() const;  // m, radius of the sphere about the centre that holds all of it

  void renumber(GlobalId first_id);  // gives it the ids from this one on
  // Puts its centre at a place (m), with the motion that it has and without forces.
  void place(const Vec3& centre, const PeriodicBox& box);
  void set_velocity(const Vec3& velocity);  // m/s; it has no spin then, but one that is held
};

// The bodies that these seeds make, as they lie.
std::vector<TravellingBody> bodies_of(const GrainSeeds& seeds, const PeriodicBox& box);

// The bodies of these rows and clumps, in order of id.
std::vector<TravellingBody> bodies_of(std::vector<GrainRow> rows, std::vector<ClumpRow> clumps);

// The bodies of all ranks in order of id, on every rank. Collective.
std::vector<TravellingBody> gathered_bodies(std::vector<GrainRow> rows, std::vector<ClumpRow> clumps,
                                            MPI_Comm communicator);

}  // namespace thalweg::dem
