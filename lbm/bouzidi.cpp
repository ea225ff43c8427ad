#include "lbm/bouzidi.hpp"

#include "lbm/bouzidi_link.hpp"
#include "lbm/cli_link.hpp"
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

template <int axis>
int velocity(std::uint32_t tag) {
  return static_cast<int>(tag >> LinkTag::velocity_shift(axis) & 3) - 1;
}

template <typename Real>
std::int64_t total(const Real* terms, int n) {
  std::int64_t sum = 0;
  for (int k = 0; k < n; ++k) sum += LatticeFixed::from(static_cast<double>(terms[k]));
  return sum;
}

// Of the differences, which are exact in double: single storage loses nothing here.
template <typename Real>
std::int64_t total_difference(const Real* terms, const Real* less, int n) {
  std::int64_t sum = 0;
  for (int k = 0; k < n; ++k)
    sum += LatticeFixed::from(static_cast<double>(terms[k]) - static_cast<double>(less[k]));
  return sum;
}

}  // namespace

template <typename Real>
LinkPass<Real>::LinkPass(Fluid<Real>& fluid, const LinkTable& links, const PeriodicBox& box, const LinkOptions& options,
                         std::vector<LinkBody>& bodies, std::vector<FixedTensor>* moments, LinkBalance* balance)
    : cells_(fluid.cells()),
      tiles_(fluid.tiles()),
      links_(links),
      box_(box),
      options_(options),
      bodies_(bodies),
      moments_(moments),
      balance_(balance),
      block_(box, fluid.block().lower) {
  Populations<Real>& populations = fluid.populations();
  for (auto& plane : deviations_) plane.resize(static_cast<std::size_t>(populations.indexing().plane_stride()));
  for (int i = 0; i < D3Q19::directions; ++i) {
    const int opposite = D3Q19::opposite(i);
    for (const std::uint32_t half : {0u, near}) {
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
  const auto apply = [&]<typename Rule>() {
    if (balance_)
      apply_links<Rule, Extra::moments_and_balance>(tile);
    else if (moments_)
      apply_links<Rule, Extra::moments>(tile);
    else
      apply_links<Rule, Extra::none>(tile);
  };
  if (options_.rule == LinkRule::cli)
    apply.template operator()<CliLink>();
  else
    apply.template operator()<BouzidiLink>();
}

template <typename Real>
template <typename Rule, typename LinkPass<Real>::Extra extra>
void LinkPass<Real>::apply_links(int tile) {
  // One plane ahead, because links reach for slots in the next plane: the straight pass for the densities brings them
  // into the cache at the speed of memory.
  const int z = tiles_.plane_of(tile);
  if (z == 0) measure_densities(tile);
  if (z + 1 < tiles_.planes()) measure_densities(tile + 1);
  plane_start_ = (z + 1) * cells_.indexing().plane_stride();
  deviation_ = deviations_[z % 2].data();

  const LinkTable::Tile& t = links_.tiles()[tile];
  const std::vector<std::uint32_t>& order = links_.chunks_in_order(tile);
  constexpr std::size_t ahead = 3;  // chunks
  for (std::size_t c = 0; c < std::min(ahead, order.size()); ++c)
    t.links.ask_for(t.chunks[order[c]].first, t.chunks[order[c]].count);
  int turn = 0;
  batches_[0].count = batches_[1].count = 0;
  for (std::size_t c = 0; c < order.size(); ++c) {
    if (c + ahead < order.size()) t.links.ask_for(t.chunks[order[c + ahead]].first, t.chunks[order[c + ahead]].count);
    const LinkTable::Chunk& chunk = t.chunks[order[c]];
    for (std::uint32_t first = 0; first < chunk.count; first += capacity, turn ^= 1) {
      prepare(batches_[turn], t, z, chunk, chunk.first + first, std::min<int>(capacity, chunk.count - first));
      finish<Rule, extra>(batches_[turn ^ 1]);
    }
  }
  finish<Rule, extra>(batches_[turn ^ 1]);
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

template <typename Real>
void LinkPass<Real>::prepare(Batch& b, const LinkTable::Tile& tile, int plane, const LinkTable::Chunk& chunk,
                             std::uint32_t first, int count) const {
  const CellIndexing& indexing = cells_.indexing();
  const std::uint32_t *places = tile.links.place.data() + first, *tags = tile.links.tag.data() + first;
  b.body = &bodies_[chunk.body];
  b.tag = tags;
  b.count = count;
  const int n = rounded_up(count), start = static_cast<int>(indexing.index(0, 0, plane)),
            row = static_cast<int>(indexing.row_stride());
  if (b.body->radius > 0.0) {
    cross_sphere(*b.body, block_, plane, places, tags, n, b.distance, b.arm[0], b.arm[1], b.arm[2]);
  } else {
    for (int k = 0; k < count; ++k) {
      const LinkCrossing& crossing = tile.links.crossing[first + k];
      b.distance[k] = Real(crossing.distance);
      for (int a = 0; a < 3; ++a) b.arm[a][k] = Real(crossing.arm[a]);
    }
  }
  for (int k = count; k < n; ++k) b.distance[k] = Real(1), b.arm[0][k] = b.arm[1][k] = b.arm[2][k] = Real(0);
  for (int k = 0; k < n; ++k) {
    const int place = static_cast<int>(places[k]);
    b.cell[k] = start + (place >> LinkPlace::y_shift & 0xffff) * row + (place & 0xffff);
    b.slot[k] = (tags[k] & LinkTag::direction_mask) | (b.distance[k] < Real(0.5) ? near : 0u);
  }
  for (int k = 0; k < count; ++k) {
    const std::uint32_t slot = b.slot[k];
    const std::ptrdiff_t cell = b.cell[k];
    __builtin_prefetch(incident_[slot] + cell, 0);
    __builtin_prefetch(second_[slot] + cell, 0);
    __builtin_prefetch(reflected_[slot] + cell, 1);
  }
}

template <typename Real>
template <typename Rule, typename LinkPass<Real>::Extra extra>
void LinkPass<Real>::finish(Batch& b) {
  if (b.count == 0) return;
  gather<Rule>(b);
  reflect<Rule, extra>(b);
  for (int k = 0; k < b.count; ++k) reflected_[b.slot[k]][b.cell[k]] = b.reflected[k];
  add_momentum(b);
  if constexpr (extra != Extra::none) add_moments(b);
  if constexpr (extra == Extra::moments_and_balance) add_balance<Rule>(b);
}

template <typename Real>
template <typename Rule>
void LinkPass<Real>::gather(Batch& b) {
  const bool local = options_.wall_density == WallDensity::local;
  int covered = 0;
  for (int k = 0; k < b.count; ++k) {
    const std::uint32_t slot = b.slot[k];
    const std::ptrdiff_t cell = b.cell[k];
    b.density[k] = deviation_[cell - plane_start_];
    b.incident[k] = incident_[slot][cell];
    b.second[k] = second_[slot][cell];
    covered_[covered] = k;
    covered += static_cast<int>((slot & near) != 0) & static_cast<int>(b.tag[k] >> LinkTag::covered_shift & 1);
  }
  if (covered > 0) fill_from_covered_cells(b, covered);
  if constexpr (Rule::needs_both) look_upstream(b);
  for (int k = b.count; k < rounded_up(b.count); ++k) b.density[k] = b.incident[k] = b.second[k] = Real(0);
  for (int k = 0; k < rounded_up(b.count); ++k) b.excess[k] = b.density[k];
  for (int k = 0; k < rounded_up(b.count); ++k) b.density[k] = local ? Real(1) + b.density[k] : Real(1);
  if (!options_.rest_gradient.isZero(0.0)) subtract_rest(b);
}

// x_f from the body's centre: the arm, back by the distance.
template <typename Real>
void LinkPass<Real>::subtract_rest(Batch& b) const {
  const Vec3& gradient = options_.rest_gradient;
  const double at_centre = gradient.dot(b.body->centre - options_.rest_middle);
  for (int k = 0; k < b.count; ++k) {
    const Vec3 c(velocity<0>(b.tag[k]), velocity<1>(b.tag[k]), velocity<2>(b.tag[k]));
    const Vec3 arm(b.arm[0][k], b.arm[1][k], b.arm[2][k]);
    b.excess[k] -= static_cast<Real>(at_centre + gradient.dot(arm - static_cast<double>(b.distance[k]) * c));
  }
}

// The equilibrium at the density of x_f and the velocity that the covering body has at x_ff. With a hydrostatic
// gradient c_i.gradient = 3 c_i.F: the density a cell further out, and 3/2 w_i c_i.F.
template <typename Real>
void LinkPass<Real>::fill_from_covered_cells(Batch& b, int covered) const {
  double from[3][capacity], v[3][capacity], w[3][capacity], deviation[capacity], result[capacity];
  std::uint32_t tags[capacity];
  const Vec3& gradient = options_.rest_gradient;
  for (int c = 0; c < covered; ++c) {
    const int k = covered_[c];
    const LinkBody& other = bodies_[b.tag[k] >> LinkTag::body_shift];
    const Vec3 apart = box_.difference(b.body->centre, other.centre);
    tags[c] = b.tag[k];
    deviation[c] = static_cast<double>(b.density[k]);
    for (int a = 0; a < 3; ++a) {
      // x_ff from the other's centre: the arm, back by the distance to x_f and one link more.
      from[a][c] = apart[a] + static_cast<double>(b.arm[a][k]);
      v[a][c] = other.velocity[a];
      w[a][c] = other.angular_velocity[a];
    }
    result[c] = static_cast<double>(b.distance[k]) + 1.0;
  }
  for (int c = 0; c < covered; ++c) {
    const double cx = velocity<0>(tags[c]), cy = velocity<1>(tags[c]), cz = velocity<2>(tags[c]), back = result[c];
    const double x = from[0][c] - back * cx, y = from[1][c] - back * cy, z = from[2][c] - back * cz;
    const double ux = v[0][c] + (w[1][c] * z - w[2][c] * y), uy = v[1][c] + (w[2][c] * x - w[0][c] * z),
                 uz = v[2][c] + (w[0][c] * y - w[1][c] * x);
    const double cu = cx * ux + cy * uy + cz * uz, uu = ux * ux + uy * uy + uz * uz;
    const double weight = (3.0 - (cx * cx + cy * cy + cz * cz)) * (1.0 / 36.0);
    const double along = cx * gradient.x() + cy * gradient.y() + cz * gradient.z(), d = deviation[c] - along;
    result[c] = weight * (d + (1.0 + d) * (3.0 * cu + 4.5 * cu * cu - 1.5 * uu) + 0.5 * along);
  }
  for (int c = 0; c < covered; ++c) b.second[covered_[c]] = static_cast<Real>(result[c]);
}

// For a rule that needs both: what of the batch has no x_ff keeps the second value of Bouzidi's rule.
template <typename Real>
void LinkPass<Real>::look_upstream(Batch& b) const {
  for (int k = 0; k < b.count; ++k) {
    const std::uint32_t i = b.tag[k] & LinkTag::direction_mask;
    const bool covered = (b.tag[k] >> LinkTag::covered_shift & 1) != 0;
    b.covered[k] = covered ? Real(1) : Real(0);
    if (!covered) b.second[k] = second_[i | near][b.cell[k]] - second_[i][b.cell[k]];
  }
  for (int k = b.count; k < rounded_up(b.count); ++k) b.covered[k] = Real(0);
}

template <typename Real>
template <typename Rule, typename LinkPass<Real>::Extra extra>
void LinkPass<Real>::reflect(Batch& b) const {
  const LinkBody& body = *b.body;
  const Real vx = Real(body.velocity.x()), vy = Real(body.velocity.y()), vz = Real(body.velocity.z());
  const Real wx = Real(body.angular_velocity.x()), wy = Real(body.angular_velocity.y()),
             wz = Real(body.angular_velocity.z());
  const Real galilean = options_.momentum_exchange == MomentumExchange::galilean_invariant ? Real(1) : Real(0);
  const Real returned = Real(body.returned), sx = Real(body.returned_slope.x()), sy = Real(body.returned_slope.y()),
             sz = Real(body.returned_slope.z()), reference = Real(2.0 * options_.reference_density);
  const std::uint32_t* tags = b.tag;
  const int n = rounded_up(b.count), count = b.count;
  for (int k = 0; k < n; ++k) {
    const Real cx = Real(velocity<0>(tags[k])), cy = Real(velocity<1>(tags[k])), cz = Real(velocity<2>(tags[k]));
    const Real weight = k < count ? (Real(3) - (cx * cx + cy * cy + cz * cz)) * Real(1.0 / 36.0) : Real(0);
    const Real ax = b.arm[0][k], ay = b.arm[1][k], az = b.arm[2][k], delta = b.distance[k];
    const Real ux = vx + (wy * az - wz * ay), uy = vy + (wz * ax - wx * az), uz = vz + (wx * ay - wy * ax);
    const Real towards_wall = cx * ux + cy * uy + cz * uz;
    LinkWeights<Real> rule = Rule::weights(delta);
    if constexpr (Rule::needs_both) {
      const LinkWeights<Real> without = BouzidiLink::weights(delta);
      const bool covered = b.covered[k] != Real(0);
      rule.incident = covered ? without.incident : rule.incident;
      rule.second = covered ? without.second : rule.second;
      rule.wall = covered ? without.wall : rule.wall;
    }
    const Real incident = b.incident[k];
    const Real interpolated = rule.incident * incident + rule.second * b.second[k];
    const Real moving_wall = rule.wall * weight * b.density[k] * towards_wall;
    const Real reflected = interpolated - moving_wall + weight * (returned + (cx * sx + cy * sy + cz * sz));
    b.reflected[k] = reflected;
    b.pressure[k] = weight * b.excess[k];
    const Real sum = incident + reflected - reference * weight, flux = galilean * (incident - reflected);
    const Real mx = sum * cx - flux * ux, my = sum * cy - flux * uy, mz = sum * cz - flux * uz;
    b.momentum[0][k] = mx;
    b.momentum[1][k] = my;
    b.momentum[2][k] = mz;
    b.torque[0][k] = ay * mz - az * my;
    b.torque[1][k] = az * mx - ax * mz;
    b.torque[2][k] = ax * my - ay * mx;
    if constexpr (extra == Extra::moments_and_balance) {
      b.interpolated[k] = interpolated - incident;
      b.moving_wall[k] = -moving_wall;
    }
    if constexpr (extra != Extra::none) {
      b.moment[0][k] = mx * ax;
      b.moment[1][k] = mx * ay;
      b.moment[2][k] = mx * az;
      b.moment[3][k] = my * ax;
      b.moment[4][k] = my * ay;
      b.moment[5][k] = my * az;
      b.moment[6][k] = mz * ax;
      b.moment[7][k] = mz * ay;
      b.moment[8][k] = mz * az;
    }
  }
}

template <typename Real>
void LinkPass<Real>::add_momentum(const Batch& b) const {
  const int n = rounded_up(b.count);
  b.body->force += {total(b.momentum[0], n), total(b.momentum[1], n), total(b.momentum[2], n)};
  b.body->torque += {total(b.torque[0], n), total(b.torque[1], n), total(b.torque[2], n)};
  b.body->mass += total_difference(b.reflected, b.incident, n);
  b.body->pressure += total(b.pressure, n);
}

template <typename Real>
void LinkPass<Real>::add_moments(const Batch& b) const {
  FixedTensor& moments = (*moments_)[static_cast<std::size_t>(b.body - bodies_.data())];
  for (std::size_t k = 0; k < 9; ++k) moments.sums[k] += total(b.moment[k], rounded_up(b.count));
}

template <typename Real>
template <typename Rule>
void LinkPass<Real>::add_balance(const Batch& b) const {
  for (int k = 0; k < b.count; ++k) {
    const bool near_wall = (b.slot[k] & near) != 0, has_covered = (b.tag[k] >> LinkTag::covered_shift & 1) != 0;
    const bool reads_upstream = Rule::needs_both ? near_wall || !has_covered : near_wall;
    std::int64_t& part = !reads_upstream ? balance_->same_cell : has_covered ? balance_->covered : balance_->upstream;
    part += LatticeFixed::from(static_cast<double>(b.interpolated[k]));
    balance_->moving_wall += LatticeFixed::from(static_cast<double>(b.moving_wall[k]));
  }
}

template class LinkPass<float>;
template class LinkPass<double>;

}  // namespace thalweg::lbm
