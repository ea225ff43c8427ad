#include "dem/local_solid_fraction.hpp"

#include "dem/cell_grid.hpp"
#include "dem/lens.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace thalweg::dem {

namespace {

Vec3 remembered_position(const GrainStore& store, std::size_t slot) {
  return Vec3::Map(store.attached_of(slot).data());
}

double size_of_grain(double radius, bool disk) {
  return disk ? std::numbers::pi * radius * radius : 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

}  // namespace

LocalSolidFraction::LocalSolidFraction(const PeriodicBox& box, const SolidFractionParameters& parameters)
    : box_(box), parameters_(parameters) {
  std::array<int, 3> most{0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) most[axis] = box.periodic[axis] && box.size[axis] < 2.0 * reach() ? 1 : 0;
  for (int k = -most[2]; k <= most[2]; ++k)
    for (int j = -most[1]; j <= most[1]; ++j)
      for (int i = -most[0]; i <= most[0]; ++i) images_.emplace_back(i * box.size[0], j * box.size[1], k * box.size[2]);
}

void LocalSolidFraction::find_neighbours(const GrainStore& store, double skin) {
  const double limit = reach() + skin;
  const CellGrid grid(box_, limit, store.position);
  const std::span<const std::uint32_t> slot = grid.order();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // of slot, to slot
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const std::uint32_t a = slot[m], b = slot[n];
    if (store.is_ghost(a) && store.is_ghost(b)) return;
    if (box_.difference(store.position[a], store.position[b]).squaredNorm() > limit * limit) return;
    pairs.emplace_back(a, b);
    pairs.emplace_back(b, a);
  });
  std::sort(pairs.begin(), pairs.end(), [&store](const auto& p, const auto& q) {
    return p.first != q.first ? p.first < q.first : store.id[p.second] < store.id[q.second];
  });
  first_.assign(store.total() + 1, 0);
  for (const auto& [from, to] : pairs) ++first_[from + 1];
  for (std::size_t s = 0; s < store.total(); ++s) first_[s + 1] += first_[s];
  neighbours_.clear();
  for (const auto& [from, to] : pairs) neighbours_.push_back(to);
  due_.assign(store.total(), 0);
}

bool LocalSolidFraction::moved(const MovingGrain& grain, std::span<double> remembered) const {
  const Vec3 position = vector_of(grain.position);
  const double limit = parameters_.tolerance * parameters_.tolerance;
  if (remembered[3] != 0.0 && box_.difference(position, Vec3::Map(remembered.data())).squaredNorm() <= limit)
    return false;
  Vec3::Map(remembered.data()) = position;
  remembered[3] = 1.0;
  return true;
}

void LocalSolidFraction::update(const MovingGrains& grains, GrainStore& store) {
  bool any = false;
  for (std::size_t s = 0; s < store.total(); ++s) {
    if (!moved(grains[s], store.attached_of(s))) continue;
    any = true;
    due_[s] = 1;
    for (const std::uint32_t neighbour : neighbours_of(s)) due_[neighbour] = 1;
  }
  if (!any) return;
  for (std::size_t s = 0; s < store.owned; ++s)
    if (due_[s]) evaluate(store, s);
  std::fill(due_.begin(), due_.end(), 0);
}

void LocalSolidFraction::evaluate(GrainStore& store, std::size_t slot) const {
  const Vec3 centre = remembered_position(store, slot), down = Vec3(0.0, 0.0, store.radius[slot]);
  const std::span<double> columns_here = store.attached_of(slot);
  columns_here[4] = fraction_about(store, slot, centre);
  columns_here[5] = fraction_about(store, slot, centre - down) - fraction_about(store, slot, centre + down);
}

double LocalSolidFraction::fraction_about(const GrainStore& store, std::size_t slot, const Vec3& centre) const {
  const bool disks = parameters_.disks;
  const double radius = store.radius[slot] + parameters_.margin;
  const auto common = [&](std::size_t other) {
    const Vec3 nearest = box_.difference(remembered_position(store, other), centre);
    double sum = 0.0;
    for (const Vec3& image : images_) {
      const double distance = (nearest + image).norm();
      sum += disks ? common_area(radius, store.radius[other], distance)
                   : common_volume(radius, store.radius[other], distance);
    }
    return sum;
  };
  double solid = common(slot);
  for (const std::uint32_t neighbour : neighbours_of(slot)) solid += common(neighbour);
  if (!parameters_.floor) return solid / size_of_grain(radius, disks);
  return solid / (disks ? area_above(radius, centre.z()) : volume_above(radius, centre.z()));
}

}  // namespace thalweg::dem
