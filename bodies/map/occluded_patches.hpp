// Patches of a grain's surface that other grains or walls of the box occlude from the fluid, as vectors.
//
// A lattice line that enters a cell of grain p from a cell of grain q, or from beyond a wall, has no fluid on it. What
// such lines would add to the force in a fluid of uniform excess density D is 2 D h, with h = sum w_i c_i over them and
// c_i into p: about a sixth of the hidden area, along the normal into p. Over the whole surface of p, seen and hidden
// lines together, sum w_i c_i = 0. A fluid presses between grains as well, where the lattice has no cell for it; its
// density there is interpolated between those around the two grains, linearly between their centres, so that
//   F_p += 2 D h,   D = D_p + (D_q - D_p) R_p/(R_p + R_q),   and F_q -= the same,
// D = D_p at a wall or a solid, with R the radius. The force acts where the line between the centres
// meets the surface, and so turns no sphere. Without this term touching grains would be drawn together or pushed apart
// by any pressure but the reference. Between members of one clump is no surface.
//
// The same patches tell how much of the mass given by the links of p is given in the place of q: grains that touch and
// move together push fluid away in front of the one and draw it in behind the other. With v the mean of the two
// velocities, that is 6 h.v from p to q; only the rest of what they cost the fluid is each grain's own
// (mass_return.hpp). Where q is a solid, v is its velocity.
//
// Kept up to date with every cell that changes hands; the sums are integers, so that their history does not matter.
// Lattice units.
#pragma once

#include "bodies/map/link_table.hpp"
#include "bodies/map/mapped_body.hpp"
#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/cell_map.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace thalweg::bodies {

class OccludedPatches {
public:
  OccludedPatches(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells);

  // Call it before the map gives a cell in memory (local coordinates) to `now`, a slot or CellMap::fluid.
  void cell_changes(const Index3& local, std::int32_t now);

  // Adds to the bodies the force of the fluid on the patches occluded by this rank's cells, and subtracts from their
  // mass what is given on behalf of another body. moments, if given, gets the symmetric part of sum F_a x_b, except for
  // patches occluded by solids, whose direction follows from the whole patch (by_solids()). surrounding: rho - rho_rest
  // around each grain, by slot; reference: density deviation that exerts no force; solids: their number.
  void apply(const std::vector<MappedBody>& mapped, int solids, const std::vector<double>& surrounding,
             double reference, std::vector<LinkBody>& bodies, std::vector<FixedTensor>* moments) const;

  // The opposite of what apply() adds to grains of this rank at walls, by face.
  std::array<FixedVec3, 6> wall_forces(int solids, const std::vector<double>& surrounding, double reference) const;

  // A face of the box (0 .. 5) in the place of the other grain.
  static std::int32_t wall_of_face(int face) { return lbm::CellMap::fluid - 1 - face; }

  // h of p towards q, a slot or a wall, of this rank's cells of p.
  Vec3 patch(std::int32_t p, std::int32_t q) const;

  // h, in 36ths, of every slot towards all solids, which have the first slots; of this rank's cells.
  std::vector<std::array<std::int64_t, 3>> by_solids(std::size_t slots, int solids) const;

private:
  struct Patch {
    std::array<std::int32_t, 3> sum{};  // of w_i c_i, in 36ths
    std::int32_t lines = 0;
  };
  struct Pair {
    std::int32_t p, q;
  };
  struct Entry {
    Pair pair;
    Patch patch;
  };
  static std::uint64_t key(const Pair& pair) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(pair.p)) << 32 | static_cast<std::uint32_t>(pair.q);
  }
  static Vec3 to_vec3(const Patch& patch);                    // h
  static FixedVec3 force(const Patch& patch, double excess);  // 2 D h; excess: D less the reference
  Vec3 direction(const Pair& pair, const std::vector<LinkBody>& bodies) const;
  // arm: from the centre of p to where the patch is; excess: D less the reference.
  static void press(const Patch& patch, const Vec3& arm, double excess, LinkBody& body, FixedTensor* moment);
  void press_solid(const Patch& patch, double excess, const LinkBody& sphere, LinkBody& solid) const;
  Vec3 velocity_beside(const LinkBody& solid, const LinkBody& sphere) const;
  static void give_mass(const Patch& patch, const Vec3& velocity, LinkBody& body);
  void count(const Pair& pair, int direction, int lines);
  void erase(std::size_t place);

  PeriodicBox box_;                              // cells
  std::array<bool, 3> wall_below_, wall_above_;  // true where the block ends at a wall, along each axis
  const lbm::CellMap& cells_;
  std::vector<Entry> patches_;                               // in no order
  std::unordered_map<std::uint64_t, std::size_t> place_of_;  // in patches_, by key
};

}  // namespace thalweg::bodies
