#include "model_fluid/local_solid_fraction.hpp"

#include "dem/motion/cell_grid.hpp"
#include "dem/motion/grain_volume.hpp"
#include "dem/motion/minimum_image.hpp"
#include "model_fluid/sphere_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace thalweg::model_fluid {

namespace {

constexpr std::size_t group = 8;  // doubles of the widest vector

// Attached columns.
constexpr std::size_t solid_at = 0, solid_known = 3, weight_at = 4, clump_at = 5, clump_known = 8;

// m^3, of disks of a thickness of 1, which is their area (m^2).
double size_of_grain(double radius, bool disk) { return dem::grain_volume(radius, disk ? 1.0 : 0.0); }

bool same_bits(const std::vector<dem::Double4>& a, const std::vector<dem::Double4>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(dem::Double4)) == 0);
}

using SlotPair = std::pair<std::uint32_t, std::uint32_t>;

// All pairs of grains whose centres are at most a distance (m) apart, without those of two ghosts. Half of the pairs of
// the grid are further apart, in no order that a processor could foresee: hence without branches.
std::vector<SlotPair> pairs_within(double distance, const PeriodicBox& box, const dem::GrainStore& store) {
  const dem::CellGrid grid(box, distance, store.position);
  const std::span<const std::uint32_t> slot = grid.order();
  std::vector<dem::Double4> position;
  for (const std::uint32_t s : slot) position.push_back(dem::double4(store.position[s], store.is_ghost(s) ? 1.0 : 0.0));
  const dem::MinimumImage image(box);
  const double limit = distance * distance;
  std::vector<SlotPair> pairs(64 * store.total() + 1);
  std::size_t count = 0;
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    if (count == pairs.size()) pairs.resize(2 * count);
    const dem::Double4 d = image(position[m] - position[n]), square = d * d;
    pairs[count] = {slot[m], slot[n]};
    count += static_cast<std::size_t>((square[0] + square[1] + square[2] <= limit) &
                                      (position[m][3] + position[n][3] < 2.0));
  });
  pairs.resize(count);
  return pairs;
}

}  // namespace

LocalSolidFraction::LocalSolidFraction(const PeriodicBox& box, const SolidFractionParameters& parameters)
    : box_(box), parameters_(parameters), heights_{0.0} {
  if (parameters.lift) heights_ = {0.0, -1.0, 1.0};
  // Multiples of 2^-42 of the largest sphere, so that a sum of a thousand spheres still has them all.
  const double largest = size_of_grain(parameters.largest_radius + parameters.margin, parameters.disks);
  rounding_ = std::ldexp(1.5, std::ilogb(largest) - 42 + 52);
  // The second nearest image is at least half the box away, the third the whole box, and so on.
  std::array<int, 3> count{1, 1, 1};
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis] && !(parameters.disks && axis == 1))  // across their plane there is one of each
      count[axis] = std::max(1, static_cast<int>(std::ceil(2.0 * reach() / box.size[axis])));
  const auto further = [&box](int axis, int n) { return (n % 2 == 1 ? (n + 1) / 2 : -n / 2) * box.size[axis]; };
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) images_.emplace_back(further(0, i), further(1, j), further(2, k));
}

double LocalSolidFraction::reach() const {
  const double to_sphere = parameters_.largest_offset + (parameters_.lift ? parameters_.largest_radius : 0.0);
  const double solid = std::max(parameters_.largest_radius, parameters_.largest_member);
  // Either grain may be the tolerance away from where it counts.
  return to_sphere + parameters_.largest_radius + parameters_.margin + solid + 2.0 * parameters_.tolerance;
}

void LocalSolidFraction::weigh(dem::GrainStore& store, const dem::Clumps& clumps) const {
  if (!parameters_.clumps) return;
  for (std::size_t s = 0; s < store.owned; ++s) store.attached_of(s)[weight_at] = 1.0;
  for (std::size_t n = 0; n < clumps.size(); ++n) {
    const std::size_t first = clumps.first_slot(n), end = first + clumps.member_count(n);
    double members = 0.0;
    for (std::size_t s = first; s < end; ++s) members += size_of_grain(store.radius[s], parameters_.disks);
    const double whole = size_of_grain(clumps.radius_of(clumps[n]), parameters_.disks);
    for (std::size_t s = first; s < end; ++s) store.attached_of(s)[weight_at] = whole / members;
  }
}

void LocalSolidFraction::find_neighbours(const dem::GrainStore& store, double skin, const dem::Clumps& clumps) {
  const std::vector<SlotPair> pairs = pairs_within(reach() + skin, box_, store);
  first_.assign(store.total() + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++first_[a + 1];
    ++first_[b + 1];
  }
  for (std::size_t s = 0; s < store.total(); ++s) first_[s + 1] += first_[s];
  neighbours_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [a, b] : pairs) {
    neighbours_[next[a]++] = b;
    neighbours_[next[b]++] = a;
  }

  is_changed_.assign(store.owned, 0);
  changed_.clear();
  if (!recall(store, clumps)) return;
  sums_.assign(owned_ * heights_.size(), 0.0);
  for (std::size_t s = 0; s < owned_; ++s) {
    if (bodies()[s][3] == 0.0) continue;
    copy_neighbours(s, solids_);
    sum_own(s);
  }
}

// Takes what is remembered from the columns. False if it is known in these slots already, with all it adds up to.
bool LocalSolidFraction::recall(const dem::GrainStore& store, const dem::Clumps& clumps) {
  const std::size_t owned = std::exchange(owned_, store.owned);
  const std::vector<dem::Double4> solids = std::exchange(solids_, {}), bodies = std::exchange(bodies_, {});
  const std::vector<double> weights = std::exchange(weights_, {});
  const auto remembered = [&store](std::size_t slot, std::size_t at, std::size_t known, double radius) {
    const std::span<const double> attached = store.attached_of(slot);
    return dem::Double4{attached[at], attached[at + 1], attached[at + 2], attached[known] != 0.0 ? radius : 0.0};
  };
  solids_.resize(store.total());
  weights_.assign(store.total(), 1.0);
  for (std::size_t s = 0; s < store.total(); ++s) {
    solids_[s] = remembered(s, solid_at, solid_known, store.radius[s]);
    if (parameters_.clumps) weights_[s] = store.attached_of(s)[weight_at];
  }
  bodies_.assign(parameters_.clumps ? store.total() : 0, dem::Double4{});
  if (parameters_.clumps) {
    for (std::size_t s = 0; s < owned_; ++s)
      if (store.clump[s] < 0) bodies_[s] = solids_[s];
    for (std::size_t n = 0; n < clumps.size(); ++n) {
      const std::size_t first = clumps.first_slot(n);
      bodies_[first] = remembered(first, clump_at, clump_known, clumps.radius_of(clumps[n]));
    }
  }
  return owned != owned_ || !same_bits(solids, solids_) || !same_bits(bodies, bodies_) || weights != weights_;
}

std::span<const std::uint32_t> LocalSolidFraction::update(const dem::PackedGrainState& grains,
                                                          const dem::Clumps& clumps, dem::GrainStore& store) {
  for (const std::uint32_t s : changed_) is_changed_[s] = 0;
  changed_.clear();
  for (std::size_t s = 0; s < grains.size(); ++s)
    if (has_moved(solids_[s], grains[s].position)) move_solid(s, grains[s].position, store);
  for (std::size_t n = 0; n < clumps.size(); ++n) {
    const dem::Double4 centre = dem::double4(clumps[n].centre, clumps.radius_of(clumps[n]));
    if (has_moved(bodies_[clumps.first_slot(n)], centre)) move_clump(clumps.first_slot(n), centre, store);
  }
  return changed_;
}

bool LocalSolidFraction::has_moved(const dem::Double4& remembered, const dem::Double4& now) const {
  if (remembered[3] == 0.0) return true;
  const double limit = parameters_.tolerance * parameters_.tolerance;
  return box_.difference(dem::vector_of(now), dem::vector_of(remembered)).squaredNorm() > limit;
}

void LocalSolidFraction::move_solid(std::size_t slot, const dem::Double4& position, dem::GrainStore& store) {
  copy_neighbours(slot, bodies());
  if (solids_[slot][3] > 0.0) add_to_neighbours(slot, -1.0);
  solids_[slot] = position;
  add_to_neighbours(slot, 1.0);
  const std::span<double> attached = store.attached_of(slot);
  for (std::size_t axis = 0; axis < 3; ++axis) attached[solid_at + axis] = position[axis];
  attached[solid_known] = 1.0;
  mark(slot);
  for (const std::uint32_t neighbour : neighbours_of(slot)) mark(neighbour);

  if (slot >= owned_) return;
  if (parameters_.clumps && store.clump[slot] < 0) bodies_[slot] = position;
  if (bodies()[slot][3] == 0.0) return;
  if (parameters_.clumps) copy_neighbours(slot, solids_);
  sum_own(slot);
}

void LocalSolidFraction::move_clump(std::size_t first_member, const dem::Double4& centre, dem::GrainStore& store) {
  bodies_[first_member] = centre;
  const std::span<double> attached = store.attached_of(first_member);
  for (std::size_t axis = 0; axis < 3; ++axis) attached[clump_at + axis] = centre[axis];
  attached[clump_known] = 1.0;
  copy_neighbours(first_member, solids_);
  sum_own(first_member);
  mark(first_member);
}

void LocalSolidFraction::mark(std::size_t slot) {
  if (slot >= owned_ || is_changed_[slot]) return;
  is_changed_[slot] = 1;
  changed_.push_back(static_cast<std::uint32_t>(slot));
}

// remembered: solids_ or bodies().
void LocalSolidFraction::copy_neighbours(std::size_t slot, const std::vector<dem::Double4>& remembered) {
  const std::span<const std::uint32_t> neighbours = neighbours_of(slot);
  if (near_.slot.size() < neighbours.size() + 1 + group) {
    near_.slot.resize(2 * (neighbours.size() + 1 + group));
    for (std::vector<double>* column : {&near_.x, &near_.y, &near_.z, &near_.radius, &near_.weight, &near_.common})
      column->resize(near_.slot.size());
  }
  std::size_t n = 0;
  for (const std::uint32_t neighbour : neighbours) {
    const dem::Double4& at = remembered[neighbour];
    if (at[3] == 0.0) continue;
    near_.slot[n] = neighbour;
    near_.x[n] = at[0];
    near_.y[n] = at[1];
    near_.z[n] = at[2];
    near_.radius[n] = at[3];
    near_.weight[n] = weights_[neighbour];
    ++n;
  }
  near_.size = n + 1;
}

// Sums the volume that all solids near a grain, which have been copied, have in common with its own spheres.
void LocalSolidFraction::sum_own(std::size_t slot) {
  const std::size_t itself = near_.size - 1;
  near_.x[itself] = solids_[slot][0];
  near_.y[itself] = solids_[slot][1];
  near_.z[itself] = solids_[slot][2];
  near_.radius[itself] = solids_[slot][3];
  near_.weight[itself] = weights_[slot];
  for (std::size_t h = 0; h < heights_.size(); ++h) {
    intersect(slot, About::grain, heights_[h]);
    double sum = 0.0;
    for (std::size_t n = 0; n < near_.size; ++n) sum += near_.common[n];
    sums_[slot * heights_.size() + h] = sum;
  }
}

// Adds what a solid has in common with the spheres of its owned neighbours to their sums, or takes it away. These have
// been copied.
void LocalSolidFraction::add_to_neighbours(std::size_t slot, double sign) {
  for (std::size_t h = 0; h < heights_.size(); ++h) {
    intersect(slot, About::neighbours, heights_[h]);
    for (std::size_t n = 0; n + 1 < near_.size; ++n)
      if (near_.slot[n] < owned_) sums_[near_.slot[n] * heights_.size() + h] += sign * near_.common[n];
  }
}

void LocalSolidFraction::intersect(std::size_t slot, About about, double height) {
  std::fill_n(near_.common.begin(), near_.size, 0.0);
  const dem::Double4 grain = about == About::grain ? bodies()[slot] : solids_[slot];
  const double weight = weights_[slot];
  for (const Vec3& image : images_) {
    if (about == About::grain && parameters_.disks) add_image<About::grain, true>(grain, weight, image, height);
    if (about == About::grain && !parameters_.disks) add_image<About::grain, false>(grain, weight, image, height);
    if (about == About::neighbours && parameters_.disks)
      add_image<About::neighbours, true>(grain, weight, image, height);
    if (about == About::neighbours && !parameters_.disks)
      add_image<About::neighbours, false>(grain, weight, image, height);
  }
}

// Adds what a grain and each of its neighbours have in common, the sphere being about the one or the other, times the
// weight of the solid. It gives the same bits seen from either.
template <LocalSolidFraction::About about, bool disks>
void LocalSolidFraction::add_image(const dem::Double4& grain, double weight, const Vec3& image, double height) {
  const double *x = near_.x.data(), *y = near_.y.data(), *z = near_.z.data(), *radius = near_.radius.data(),
               *weights = near_.weight.data();
  double* common = near_.common.data();
  const double margin = parameters_.margin, rounding = rounding_;
  const auto along = [this, &image](int axis) {
    const double size = box_.size[axis], inverse = box_.periodic[axis] ? 1.0 / size : 0.0, further = image[axis];
    return [size, inverse, further](double difference) {
      const double nearest = difference - size * std::nearbyint(difference * inverse);
      return nearest - std::copysign(1.0, nearest) * further;
    };
  };
  const auto along_x = along(0), along_y = along(1), along_z = along(2);
  // Whole groups, so that every pair is computed by the same instructions, wherever it stands; what is too much is not
  // used.
  const std::size_t end = (near_.size + group - 1) / group * group;
  for (std::size_t n = 0; n < end; ++n) {
    const double counted = about == About::grain ? grain[3] : radius[n];
    const double other = about == About::grain ? radius[n] : grain[3];
    const double dx = along_x(x[n] - grain[0]), dy = along_y(y[n] - grain[1]);
    const double dz = along_z(z[n] - grain[2]) + (about == About::grain ? -height : height) * counted;
    const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double part =
        disks ? common_area(counted + margin, other, distance) : common_volume(counted + margin, other, distance);
    common[n] += (part * (about == About::grain ? weights[n] : weight) + rounding) - rounding;
  }
}

double LocalSolidFraction::fraction(std::size_t slot, int which) const {
  const double own = bodies()[slot][3], radius = own + parameters_.margin;
  const double solid = sums_[slot * heights_.size() + which];
  if (!parameters_.floor) return solid / size_of_grain(radius, parameters_.disks);
  const double height = bodies()[slot][2] + heights_[which] * own;
  return solid / (parameters_.disks ? area_above(radius, height) : volume_above(radius, height));
}

}  // namespace thalweg::model_fluid
