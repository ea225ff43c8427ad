#include "lbm/bouzidi.hpp"

#include "lbm/equilibrium.hpp"
#include "lbm/sweep.hpp"

#include <algorithm>
#include <experimental/simd>

namespace thalweg::lbm {

namespace {

namespace stdx = std::experimental;

// The arithmetic runs over whole vectors of any machine; what it computes beyond the last link is zero.
constexpr int whole = static_cast<int>(LinkTable::slack);
int rounded_up(int count) { return (count + whole - 1) / whole * whole; }

}  // namespace

template <typename Real>
LinkPass<Real>::LinkPass(Populations<Real>& populations, const CellMap& cells, const RowTiles& tiles,
                         const LinkTable& links, const PeriodicBox& box, const LinkOptions& options,
                         std::vector<LinkBody>& bodies)
    : cells_(cells), tiles_(tiles), links_(links), box_(box), options_(options), bodies_(bodies) {
  for (auto& plane : deviations_) plane.resize(static_cast<std::size_t>(populations.indexing().plane_stride()));
  for (int i = 0; i < D3Q19::directions; ++i) {
    const int opposite = D3Q19::opposite(i);
    for (const std::uint32_t half : {0u, LinkTag::near}) {
      const std::uint32_t slot = static_cast<std::uint32_t>(i) | half;
      incident_[slot] = &populations.post_collision(i, 0);
      // The incoming slot also has what a wall returned, if x_ff lies beyond one.
      second_[slot] = half ? &populations.incoming(i, 0) : &populations.post_collision(opposite, 0);
      reflected_[slot] = &populations.incoming(opposite, 0);
    }
  }
}

template <typename Real>
void LinkPass<Real>::apply_tile(int tile) {
  const LinkTable::Tile& t = links_.tiles()[tile];
  const std::vector<std::uint32_t>& order = links_.chunks_in_order(tile);
  constexpr std::size_t ahead = 3;  // chunks
  for (std::size_t c = 0; c < std::min(ahead, order.size()); ++c)
    t.links.ask_for(t.chunks[order[c]].first, t.chunks[order[c]].count);
  // One plane ahead, because links reach for slots in the next plane: the straight pass for the densities brings them
  // into the cache at the speed of memory.
  const int z = tiles_.plane_of(tile);
  if (z == 0) measure_densities(tile);
  if (z + 1 < tiles_.planes()) measure_densities(tile + 1);
  plane_start_ = (z + 1) * cells_.indexing().plane_stride();
  deviation_ = deviations_[z % 2].data();
  for (std::size_t c = 0; c < order.size(); ++c) {
    if (c + ahead < order.size()) t.links.ask_for(t.chunks[order[c + ahead]].first, t.chunks[order[c + ahead]].count);
    if (c + 1 < order.size()) ask_for_slots(t.links, t.chunks[order[c + 1]]);
    const LinkTable::Chunk& chunk = t.chunks[order[c]];
    LinkBody& body = bodies_[chunk.body];
    const std::size_t end = chunk.first + chunk.count;
    for (std::size_t first = chunk.first; first < end; first += capacity) {
      const int count = static_cast<int>(std::min<std::size_t>(capacity, end - first));
      gather(body, t.links, first, count);
      reflect(body, t.links, first, count);
      scatter(t.links, first, count);
      add_momentum(body, count);
    }
  }
}

// Links never change a density: they write incoming slots of fluid cells, which hold no post-collision population of a
// fluid cell.
template <typename Real>
void LinkPass<Real>::measure_densities(int tile) {
  using Pack = stdx::native_simd<Real>;
  constexpr std::ptrdiff_t width = Pack::size(), ahead = prefetch_bytes / static_cast<std::ptrdiff_t>(sizeof(Real));
  const CellIndexing& indexing = cells_.indexing();
  if (links_.tiles()[tile].live == 0) return;
  const int z = tiles_.plane_of(tile), block = tiles_.block_of(tile);
  const std::ptrdiff_t start = (z + 1) * indexing.plane_stride();
  for (int y = tiles_.first_row(block); y < tiles_.end_row(block); ++y) {
    const std::uint8_t* fluid = cells_.fluid_in_packs(y, z);
    for (int p = 0; p < indexing.packs_per_row(); ++p) {
      if (fluid[p] == 0) continue;
      const std::ptrdiff_t cell = indexing.index(0, y, z) + p * width;
      Pack sum = 0;
      for (int i = 0; i < D3Q19::directions; ++i) {
        __builtin_prefetch(incident_[i] + cell + ahead, 1);
        sum += Pack(incident_[i] + cell, stdx::element_aligned);
      }
      sum.copy_to(deviations_[z % 2].data() + (cell - start), stdx::element_aligned);
    }
  }
}

// Asks the cache for what the links of a chunk will read and write. Inlined, because to the compiler a function that
// only asks does nothing, and a call of it can go.
template <typename Real>
[[gnu::always_inline]] inline void LinkPass<Real>::ask_for_slots(const LinkStream& links,
                                                                 const LinkTable::Chunk& chunk) const {
  for (std::size_t k = chunk.first; k < chunk.first + chunk.count; ++k) {
    const std::uint32_t slot = links.tag[k] & LinkTag::slot_mask, cell = links.cell[k];
    __builtin_prefetch(incident_[slot] + cell, 0);
    __builtin_prefetch(second_[slot] + cell, 0);
    __builtin_prefetch(reflected_[slot] + cell, 1);
  }
}

template <typename Real>
void LinkPass<Real>::gather(LinkBody& body, const LinkStream& links, std::size_t first, int count) {
  const bool local = options_.wall_density == WallDensity::local;
  Batch& b = batch_;
  int covered = 0;
  for (int k = 0; k < count; ++k) {
    const std::uint32_t tag = links.tag[first + k], cell = links.cell[first + k], slot = tag & LinkTag::slot_mask;
    const Real deviation = deviation_[cell - plane_start_];
    b.density[k] = local ? Real(1) + deviation : Real(1);
    b.incident[k] = incident_[slot][cell];
    b.second[k] = second_[slot][cell];
    covered_[covered] = k;
    covered += static_cast<int>(tag >> LinkTag::covered_shift & 1);
  }
  for (int c = 0; c < covered; ++c) b.second[covered_[c]] = covered_upstream(body, links, first + covered_[c]);
  for (int k = count; k < rounded_up(count); ++k) b.density[k] = b.incident[k] = b.second[k] = Real(0);
}

template <typename Real>
Real LinkPass<Real>::covered_upstream(const LinkBody& body, const LinkStream& links, std::size_t link) const {
  const std::uint32_t tag = links.tag[link];
  const int i = static_cast<int>(tag & LinkTag::direction_mask);
  const LinkBody& other = bodies_[tag >> LinkTag::body_shift];
  Vec3 arm = box_.difference(body.centre, other.centre);
  for (int a = 0; a < 3; ++a) arm[a] += links.arm[a][link] - (links.distance[link] + 1.0) * D3Q19::c[i][a];
  const Vec3 velocity = other.velocity + other.angular_velocity.cross(arm);
  const double deviation = static_cast<double>(deviation_[links.cell[link] - plane_start_]);
  return static_cast<Real>(equilibrium_deviation(i, deviation, velocity));
}

template <typename Real>
void LinkPass<Real>::reflect(const LinkBody& body, const LinkStream& links, std::size_t first, int count) {
  Batch& b = batch_;
  const Real vx = Real(body.velocity.x()), vy = Real(body.velocity.y()), vz = Real(body.velocity.z());
  const Real wx = Real(body.angular_velocity.x()), wy = Real(body.angular_velocity.y()),
             wz = Real(body.angular_velocity.z());
  const Real galilean = options_.momentum_exchange == MomentumExchange::galilean_invariant ? Real(1) : Real(0);
  const std::uint32_t* tags = links.tag.data() + first;
  const float* distance = links.distance.data() + first;
  const float *arm_x = links.arm[0].data() + first, *arm_y = links.arm[1].data() + first,
              *arm_z = links.arm[2].data() + first;
  const int n = rounded_up(count);
  for (int k = 0; k < n; ++k) {
    const int tag = static_cast<int>(tags[k]);
    const Real cx = Real((tag >> LinkTag::velocity_shift(0) & 3) - 1);
    const Real cy = Real((tag >> LinkTag::velocity_shift(1) & 3) - 1);
    const Real cz = Real((tag >> LinkTag::velocity_shift(2) & 3) - 1);
    const Real weight = (Real(3) - (cx * cx + cy * cy + cz * cz)) * Real(1.0 / 36.0);
    const Real ax = Real(arm_x[k]), ay = Real(arm_y[k]), az = Real(arm_z[k]), delta = Real(distance[k]);
    const Real ux = vx + (wy * az - wz * ay), uy = vy + (wz * ax - wx * az), uz = vz + (wx * ay - wy * ax);
    const Real towards_wall = cx * ux + cy * uy + cz * uz;
    const Real share = delta < Real(0.5) ? Real(2) * delta : Real(0.5) / delta;
    const Real wall_factor = delta < Real(0.5) ? Real(6) : Real(6) * share;
    const Real incident = b.incident[k];
    const Real reflected =
        share * incident + (Real(1) - share) * b.second[k] - wall_factor * weight * b.density[k] * towards_wall;
    b.reflected[k] = reflected;
    const Real sum = incident + reflected, flux = galilean * (incident - reflected);
    const Real mx = sum * cx - flux * ux, my = sum * cy - flux * uy, mz = sum * cz - flux * uz;
    b.momentum[0][k] = mx;
    b.momentum[1][k] = my;
    b.momentum[2][k] = mz;
    b.torque[0][k] = ay * mz - az * my;
    b.torque[1][k] = az * mx - ax * mz;
    b.torque[2][k] = ax * my - ay * mx;
  }
}

template <typename Real>
void LinkPass<Real>::scatter(const LinkStream& links, std::size_t first, int count) {
  for (int k = 0; k < count; ++k)
    reflected_[links.tag[first + k] & LinkTag::slot_mask][links.cell[first + k]] = batch_.reflected[k];
}

template <typename Real>
void LinkPass<Real>::add_momentum(LinkBody& body, int count) const {
  const int n = rounded_up(count);
  const auto total = [n](const Real* terms) {
    std::int64_t sum = 0;
    for (int k = 0; k < n; ++k) sum += LatticeFixed::from(static_cast<double>(terms[k]));
    return sum;
  };
  body.force += {total(batch_.momentum[0]), total(batch_.momentum[1]), total(batch_.momentum[2])};
  body.torque += {total(batch_.torque[0]), total(batch_.torque[1]), total(batch_.torque[2])};
}

template class LinkPass<float>;
template class LinkPass<double>;

}  // namespace thalweg::lbm
