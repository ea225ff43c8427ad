// The solid fraction around every grain: of a sphere (disk) of diameter D_i + 2 margin about its centre, and about its
// lowest and highest point, with the grain itself, from the exact common volumes (areas) of spheres (disks); what of
// the sphere lies below the floor at z = 0 does not count.
//
// It is computed again only where the grain or one of its neighbours has moved by more than a tolerance from where it
// was when last looked at; the positions then remembered, of all of them, are those that count. They are columns
// attached to every grain, so that every rank that knows a grain moves them in the same step, and a restart has the
// same bits.
#pragma once

#include "core/periodic_box.hpp"
#include "dem/grain_store.hpp"
#include "dem/moving_grains.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

struct SolidFractionParameters {
  double largest_radius = 0.0;  // m, of all grains
  double margin = 0.0;          // m, around a grain
  double tolerance = 0.0;       // m
  bool disks = false;           // upright in the plane x-z
  bool floor = true;            // at z = 0
};

class LocalSolidFraction {
public:
  static constexpr int columns = 6;  // remembered position, whether there is one, phi, phi_below - phi_above

  LocalSolidFraction(const PeriodicBox& box, const SolidFractionParameters& parameters);

  // m: no grain further from the centre of another counts for it.
  double reach() const { return 3.0 * parameters_.largest_radius + parameters_.margin; }

  void find_neighbours(const GrainStore& store, double skin);
  // Brings the columns of owned grains up to date; positions are those of `grains`.
  void update(const MovingGrains& grains, GrainStore& store);

  static double around(const GrainStore& store, std::size_t slot) { return store.attached_of(slot)[4]; }
  static double below_less_above(const GrainStore& store, std::size_t slot) { return store.attached_of(slot)[5]; }

private:
  std::span<const std::uint32_t> neighbours_of(std::size_t slot) const {
    return {neighbours_.data() + first_[slot], first_[slot + 1] - first_[slot]};
  }
  bool moved(const MovingGrain& grain, std::span<double> remembered) const;
  void evaluate(GrainStore& store, std::size_t slot) const;
  double fraction_about(const GrainStore& store, std::size_t slot, const Vec3& centre) const;

  PeriodicBox box_;
  SolidFractionParameters parameters_;
  std::vector<Vec3> images_;               // m, of which a small periodic box may have several near
  std::vector<std::size_t> first_;         // of each slot's neighbours
  std::vector<std::uint32_t> neighbours_;  // by id; of a ghost only owned ones
  std::vector<char> due_;
};

}  // namespace thalweg::dem
