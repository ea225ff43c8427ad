// The solid fraction around every grain, the grain included: of a sphere (disk) of diameter D_i + 2 margin about its
// centre and, if asked for, about its lowest and highest point, from the exact common volumes (areas) of spheres
// (disks). The part of the sphere below the floor at z = 0 does not count.
//
// A clump is one grain: its centre is the centre of mass, D_i is that of the sphere (disk) of its volume, and its
// members count as solid with a weight, its volume over the sum of theirs, since they overlap.
//
// A grain counts at the position it had when last looked at; it is looked at again once it has moved from there by more
// than a tolerance, and only then are its own solid fractions and those of its neighbours brought up to date. The
// remembered positions are columns attached to every grain, so that every rank that knows a grain looks in the same
// step, and a restart has the same bits. Common volumes are rounded to a multiple of a small power of two: sums of them
// are exact, and depend neither on their order nor on the paths of the grains.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/clumps/clumps.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::model_fluid {

struct SolidFractionParameters {
  double largest_radius = 0.0;  // m, of all grains; a clump's is that of the sphere (disk) of its volume
  double margin = 0.0;          // m, around a grain
  double tolerance = 0.0;       // m
  bool disks = false;           // upright in the plane x-z
  bool floor = true;            // at z = 0
  bool lift = true;             // below_less_above() is wanted
  bool clumps = false;          // there are some
  double largest_member = 0.0;  // m, radius of their members
  double largest_offset = 0.0;  // m, of a member from its clump's centre
};

class LocalSolidFraction {
public:
  LocalSolidFraction(const PeriodicBox& box, const SolidFractionParameters& parameters);

  // Attached to every grain: its remembered position and whether there is one; with clumps also its weight and, of the
  // first member, the clump's remembered centre and whether there is one.
  int columns() const { return parameters_.clumps ? 9 : 4; }
  // Fills in the weights of owned grains.
  void weigh(dem::GrainStore& store, const dem::Clumps& clumps) const;

  // m: no grain further from the centre of another counts for it.
  double reach() const;

  void find_neighbours(const dem::GrainStore& store, double skin, const dem::Clumps& clumps);
  // Brings the columns and the solid fractions of owned grains up to date; positions are those of `grains` and
  // `clumps`. Returns the owned slots whose solid fraction may have changed, in no particular order, valid until the
  // next call.
  std::span<const std::uint32_t> update(const dem::PackedGrainState& grains, const dem::Clumps& clumps,
                                        dem::GrainStore& store);

  // Solid fraction around a grain, or around the clump whose first member this is.
  double around(std::size_t slot) const { return fraction(slot, 0); }
  // phi_below - phi_above; only with SolidFractionParameters::lift.
  double below_less_above(std::size_t slot) const { return fraction(slot, 1) - fraction(slot, 2); }

private:
  // The one of a pair that has the sphere.
  enum class About { grain, neighbours };
  // A grain's remembered neighbours, and the grain itself as the last of them, copied for loops over all of them.
  struct Near {
    std::vector<std::uint32_t> slot;
    std::vector<double> x, y, z, radius;  // m, remembered
    std::vector<double> weight;
    std::vector<double> common;  // m^3 (m^2), of the last pass
    std::size_t size = 0;        // the vectors are longer
  };

  std::span<const std::uint32_t> neighbours_of(std::size_t slot) const {
    return {neighbours_.data() + first_[slot], first_[slot + 1] - first_[slot]};
  }
  // The grains that solid fractions are of.
  const std::vector<dem::Double4>& bodies() const { return parameters_.clumps ? bodies_ : solids_; }
  bool recall(const dem::GrainStore& store, const dem::Clumps& clumps);
  bool has_moved(const dem::Double4& remembered, const dem::Double4& now) const;
  void move_solid(std::size_t slot, const dem::Double4& position, dem::GrainStore& store);
  void move_clump(std::size_t first_member, const dem::Double4& centre, dem::GrainStore& store);
  void mark(std::size_t slot);

  void copy_neighbours(std::size_t slot, const std::vector<dem::Double4>& remembered);
  void sum_own(std::size_t slot);
  void add_to_neighbours(std::size_t slot, double sign);
  void intersect(std::size_t slot, About about, double height);
  template <About about, bool disks>
  void add_image(const dem::Double4& grain, double weight, const Vec3& image, double height);

  double fraction(std::size_t slot, int which) const;

  PeriodicBox box_;
  SolidFractionParameters parameters_;
  std::vector<double> heights_;       // radii: where the spheres of a grain are, above its centre
  double rounding_;                   // added and taken away, rounds a common volume
  std::vector<Vec3> images_;          // m, beyond the nearest image, that may reach a grain as well
  std::size_t owned_ = 0;             // slots
  std::vector<dem::Double4> solids_;  // m, remembered position and radius; radius 0: not yet
  std::vector<dem::Double4> bodies_;  // with clumps: the same of owned grains and, by first member, of clumps
  std::vector<double> weights_;       // of the solids
  std::vector<double> sums_;          // m^3 (m^2), of each owned slot's spheres
  std::vector<std::size_t> first_;    // of each slot's neighbours
  std::vector<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> changed_;  // owned slots
  std::vector<char> is_changed_;
  Near near_;
};

}  // namespace thalweg::model_fluid
