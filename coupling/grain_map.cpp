#include "coupling/grain_map.hpp"

#include <algorithm>

namespace thalweg::coupling {

int GrainMap::add(GlobalId id, double radius, GlobalId clump) {
  return new_slot({id, clump, radius, Vec3::Constant(2.0 * nowhere)});
}

void GrainMap::remove(int slot) {
  place(slot, Vec3::Constant(2.0 * nowhere));
  free_slot(slot);
}

void GrainMap::place(int slot, const Vec3& centre) {
  const double reach = grain(slot).radius;
  const Vec3 old = grain(slot).centre;
  grain(slot).centre = centre;
  const bool was_here = old.x() > nowhere, is_here = centre.x() > nowhere;
  if (was_here && is_here && (centre - old).squaredNorm() < 1.0) {
    turn_cells(slot, centre, reach + 1.0, old, centre);
  } else {
    if (was_here) turn_cells(slot, old, reach, old, centre);
    if (is_here) turn_cells(slot, centre, reach, old, centre);
  }
}

// Only cells that are inside at one of the two places and not at the other can change hands; what the grain holds or
// claims of the others stays.
void GrainMap::turn_cells(int slot, const Vec3& middle, double half_width, const Vec3& old, const Vec3& now) {
  for (int a = 0; a < 3; ++a) {
    local_cells_.along(a, middle[a], half_width, old[a], 1, before_[a]);
    local_cells_.along(a, middle[a], half_width, now[a], 1, after_[a]);
  }
  const auto offset = [](const LocalCell& place) { return place.offset; };
  x_before_.resize(before_[0].size());
  x_after_.resize(after_[0].size());
  std::transform(before_[0].begin(), before_[0].end(), x_before_.begin(), offset);
  std::transform(after_[0].begin(), after_[0].end(), x_after_.begin(), offset);
  const Sphere sphere{grain(slot).radius};
  for (std::size_t z = 0; z < after_[2].size(); ++z)
    for (std::size_t y = 0; y < after_[1].size(); ++y) {
      const Sphere::Chord before = sphere.chord(before_[1][y].offset, before_[2][z].offset),
                          after = sphere.chord(after_[1][y].offset, after_[2][z].offset);
      if (!before.missed() || !after.missed()) turn_row(slot, after_[1][y].local, after_[2][z].local, before, after);
    }
}

void GrainMap::turn_row(int slot, int y, int z, const Sphere::Chord& before, const Sphere::Chord& after) {
  const std::size_t width = x_after_.size();
  turns_.resize(width);
  unsigned any = 0;
  for (std::size_t k = 0; k < width; ++k) {
    turns_[k] = before.holds(x_before_[k]) != after.holds(x_after_[k]);
    any |= turns_[k];
  }
  for (std::size_t k = 0; any && k < width; ++k) {
    if (!turns_[k]) continue;
    const Index3 local{after_[0][k].local, y, z};
    after.holds(x_after_[k]) ? claim(slot, local) : give_up(slot, local);
  }
}

}  // namespace thalweg::coupling
