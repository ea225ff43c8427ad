// Regions of the box, and lattices on which grains are put at the start: the same on every rank, without communication.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace thalweg::beds {

// A part of the box, m. On a periodic axis that it spans whole, grains may sit across the face.
struct Region {
  Vec3 lower, upper;
  bool plane = false;  // centres in the middle of the region's y only: disks
};

inline Region whole(const PeriodicBox& box) { return {Vec3::Zero(), box.size}; }

// True if the region meets itself through the periodic faces of this axis.
bool wraps(const PeriodicBox& box, const Region& region, int axis);

// Throws InputError where the region is not in the box, or empty.
void check_region(const PeriodicBox& box, const Region& region);

// Solid fraction of random close packing of equal spheres, and of disks in their plane: no bed is denser.
inline constexpr double densest_bed = 0.64, densest_disks = 0.84;

// Solid fraction of a bed that has settled far from walls, between random loose and random close packing: 0.55 to 0.64
// of spheres, 0.77 to 0.84 of disks.
inline constexpr double settled_bed = 0.6, settled_disks = 0.8;

// That of a bed in this box. Along a side wall a sixth of a diameter stays empty, so that of spheres it is 0.6 times
// 1 - d/(3 W) for each axis in plan along which walls are W apart (cases/settled_bed/README.md, "Between walls").
// diameter: m, of a grain that stands for all.
double settled_fraction(const PeriodicBox& box, double diameter, bool disks);

// Places of `count` equal grains spread over the region as evenly as a cubic lattice allows: the lattice with the
// widest spacing that has enough sites, sites left over spread evenly, each centre moved at random by up to 1 % of a
// diameter (less where there is no room) so that grains do not stack perfectly. clearance: m, surface to the region's
// faces that are not periodic. The constructor throws InputError saying how many would fit.
class UniformSites {
public:
  UniformSites(const PeriodicBox& box, const Region& region, std::int64_t count, double radius, double clearance,
               std::uint64_t seed);

  // Largest number of grains of this radius (m) on a lattice along each axis.
  static std::array<std::int64_t, 3> most(const PeriodicBox& box, const Region& region, double radius,
                                          double clearance);

  Vec3 centre(std::int64_t grain) const;  // m, wrapped; grain: 0 .. count - 1

private:
  PeriodicBox box_;
  Region region_;
  std::int64_t count_;
  std::uint64_t seed_;
  Vec3 lower_, extent_;
  std::array<std::int64_t, 3> along_{1, 1, 1};  // sites along each axis
  double jitter_ = 0.0;                         // m
};

// The centres (m) of all `count` grains.
std::vector<Vec3> uniform_packing(const PeriodicBox& box, const Region& region, std::int64_t count, double radius,
                                  double clearance, std::uint64_t seed);

}  // namespace thalweg::beds
