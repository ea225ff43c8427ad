#include "bodies/links/interpolated_bounce_back.hpp"

#include "bodies/links/fixed_sums.hpp"
#include "bodies/links/link_rules.hpp"
#include "core/base/check.hpp"
#include "core/base/prefetch.hpp"
#include "lbm/lattice/equilibrium.hpp"

#include <algorithm>
#include <array>

namespace thalweg::bodies {

namespace stdx = std::experimental;

namespace {

// Copies a few whole vectors, for which a call of memmove takes longer. count: a multiple of links_at_a_time.
void copy_whole_vectors(const std::uint32_t* from, int count, std::uint32_t* to) {
  using Words = stdx::native_simd<std::uint32_t>;
  static_assert(links_at_a_time % Words::size() == 0);
  for (int k = 0; k < count; k += static_cast<int>(Words::size()))
    Words(from + k, stdx::element_aligned).copy_to(to + k, stdx::element_aligned);
}

}  // namespace

template <typename Real>
InterpolatedBounceBack<Real>::InterpolatedBounceBack(lbm::Fluid<Real>& fluid, const LinkTable& links,
                                                     const PeriodicBox& box, const LinkOptions& options,
                                                     std::vector<LinkBody>& bodies, std::vector<FixedTensor>* moments,
                                                     int solids, MomentumByHeight* by_height)
    : cells_(fluid.cells()),
      tiles_(fluid.tiles()),
      links_(links),
      box_(box),
      options_(options),
      bodies_(bodies),
      moments_(moments),
      solids_(solids),
      by_height_(by_height),
      block_(box, fluid.block().lower),
      next_(fluid.populations(), fluid.tiles()),
      has_rest_(!options.rest_gradient.isZero(0.0)) {
  CHECK(links.tiles().size() == static_cast<std::size_t>(tiles_.count()));
  CHECK(!moments || moments->size() == bodies.size());
  CHECK(!by_height || by_height->on_grains.size() == static_cast<std::size_t>(2 * fluid.indexing().size()[2] + 1));
  lbm::Populations<Real>& populations = fluid.populations();
  for (std::vector<Real>& deviations : deviations_)
    deviations.resize(static_cast<std::size_t>(populations.indexing().plane_stride()));
  sent_ = populations.sent();
  slots_ = LinkSlots(populations);
  base_ = populations.plane(LinkSlots::middle);
}

template <typename Real>
void InterpolatedBounceBack<Real>::apply_tile(int tile) {
  CHECK(tile == last_tile_ + 1 && tile < tiles_.count());
  last_tile_ = tile;
  const auto apply = [&]<typename Rule>() {
    moments_ ? apply_links<Rule, true>(tile) : apply_links<Rule, false>(tile);
  };
  if (options_.rule == LinkRule::cli)
    apply.template operator()<CliLink>();
  else
    apply.template operator()<BouzidiLink>();
}

template <typename Real>
template <typename Rule, bool with_moments>
void InterpolatedBounceBack<Real>::apply_links(int tile) {
  // Densities are measured one plane ahead: links also read slots of the next plane, and this sequential pass brings
  // them into the cache at the speed of memory.
  const int z = tiles_.plane_of(tile);
  if (z == 0) measure_densities(tile);
  if (z + 1 < tiles_.planes()) measure_densities(tile + 1);
  parity_ = z % 2;

  const LinkTable::Tile& t = links_.tiles()[tile];
  if (t.live == 0) return;
  if (z + 2 < tiles_.planes() && links_.tiles()[tile + 2].live > 0)
    next_.begin(tile + 2);
  else
    next_.begin_nothing();
  const std::vector<LinkTable::LinkRange>& ranges = links_.ranges_in_order(tile);
  const auto ask_for = [&](std::size_t r) {
    if (r >= ranges.size()) return;
    t.links.prefetch(ranges[r].first, ranges[r].count);
    const auto body = static_cast<std::size_t>(ranges[r].body);
    prefetch(bodies_[body]);
    if constexpr (with_moments) prefetch((*moments_)[body]);
  };
  constexpr std::size_t ahead = 3;  // runs
  for (std::size_t r = 0; r < ahead; ++r) ask_for(r);
  int turn = 0;
  std::size_t done = 0;
  for (Batch& batch : batches_) batch.clear(z);
  const auto pass_on = [&] {
    prepare<Rule>(batches_[turn]);
    turn ^= 1;
    finish<Rule, with_moments>(batches_[turn]);
    batches_[turn].clear(z);
    next_.advance(static_cast<double>(done) / static_cast<double>(t.live));
  };
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    ask_for(r + ahead);
    const LinkTable::LinkRange& range = ranges[r];
    for (int from = 0; from < static_cast<int>(range.count);) {
      Batch& batch = batches_[turn];
      const int count = std::min(capacity - batch.size, static_cast<int>(range.count) - from);
      append(batch, t, range, from, count);
      from += count;
      done += static_cast<std::size_t>(count);
      if (batch.size == capacity) pass_on();
    }
  }
  pass_on();
  finish<Rule, with_moments>(batches_[turn ^ 1]);
}

// Links never change what is measured: they write incoming slots of fluid cells, which hold no post-collision
// population of a fluid cell.
template <typename Real>
void InterpolatedBounceBack<Real>::measure_densities(int tile) {
  if (links_.tiles()[tile].live == 0) return;
  constexpr std::ptrdiff_t width = Pack::size();
  const lbm::CellIndexing& indexing = cells_.indexing();
  const int z = tiles_.plane_of(tile), block = tiles_.block_of(tile);
  const std::ptrdiff_t start = (z + 1) * indexing.plane_stride();
  for (int y = tiles_.first_row(block); y < tiles_.end_row(block); ++y) {
    const std::uint8_t* fluid = cells_.fluid_in_packs(y, z);
    for (int p = 0; p < indexing.packs_per_row(); ++p) {
      if (fluid[p] == 0) continue;
      const std::ptrdiff_t cell = indexing.index(0, y, z) + p * width;
      Pack sum = 0;
      lbm::for_each_direction([&]<int i>() __attribute__((always_inline)) {
        sum += Pack(sent_[i] + cell, stdx::element_aligned);
      });
      sum.copy_to(deviations_[z % 2].data() + (cell - start), stdx::element_aligned);
    }
  }
}

// Links [from, from + count) of a run, where there is room for them.
template <typename Real>
void InterpolatedBounceBack<Real>::append(Batch& b, const LinkTable::Tile& tile, const LinkTable::LinkRange& range,
                                          int from, int count) const {
  const int start = b.size, n = padded(count);
  const std::int32_t body = range.body;
  const std::uint32_t first = range.first + static_cast<std::uint32_t>(from);
  const int narrow = std::clamp(static_cast<int>(range.narrow) - from, 0, count);
  b.piece[b.pieces++] = {body, start, count, narrow == count ? n : narrow};
  copy_whole_vectors(tile.links.xy.data() + first, n, b.xy + start);
  copy_whole_vectors(tile.links.tag.data() + first, n, b.tag + start);
  std::fill_n(b.body + start / links_at_a_time, n / links_at_a_time, body);
  b.size += n;
  const LinkBody& of = bodies_[static_cast<std::size_t>(body)];
  if (of.radius > 0.0) {
    find_crossings(Sphere{of.radius}, of.centre, block_, b.plane, b.xy + start, b.tag + start, n, b.distance + start,
                   b.arm[0] + start, b.arm[1] + start, b.arm[2] + start);
  } else {
    for (int k = 0; k < n; ++k) {
      const LinkCrossing& crossing = tile.links.crossing[first + k];
      b.distance[start + k] = Real(crossing.distance);
      for (int a = 0; a < 3; ++a) b.arm[a][start + k] = Real(crossing.arm[a]);
    }
  }
}

template <typename Real>
template <typename Rule>
void InterpolatedBounceBack<Real>::prepare(Batch& b) const {
  slots_.find(b.plane, b.xy, b.tag, b.size, b.distance, b.cell, b.incident_at, b.second_at, b.reflected_at);
  for (int k = 0; k < b.size; ++k) {
    __builtin_prefetch(base_ + b.incident_at[k], 0);
    __builtin_prefetch(base_ + b.second_at[k], 0);
    __builtin_prefetch(base_ + b.reflected_at[k], 1);
  }
  std::uint32_t flags = 0;
  for (int k = 0; k < b.size; ++k) flags |= b.tag[k];
  b.leaks = (flags & LinkTag::enclosed) != 0;
  find_narrow<Rule>(b);
}

template <typename Real>
template <typename Rule>
void InterpolatedBounceBack<Real>::find_narrow(Batch& b) const {
  int count = 0;
  for (int p = 0; p < b.pieces && !Rule::needs_both; ++p)
    for (int k = b.piece[p].first; k < b.piece[p].narrow_end(); ++k) {
      b.narrow[count] = k;
      count += static_cast<int>(b.distance[k] < Real(0.5));
    }
  b.narrow_count = count;
  for (int c = 0; c < count; ++c) prefetch(bodies_[LinkTag::upstream_body(b.tag[b.narrow[c]])]);
}

template <typename Real>
template <typename Rule, bool with_moments>
void InterpolatedBounceBack<Real>::finish(const Batch& b) {
  gather<Rule>(b);
  for (int p = 0; p < b.pieces; ++p) {
    const Piece& piece = b.piece[p];
    reflect<Rule, with_moments>(b, piece);
    add_momentum(piece);
    add_pressure_and_mass(piece);
    if (by_height_) add_by_height(b, piece);
    if constexpr (with_moments)
      if (piece.body >= solids_) add_moments(piece);
  }
  for (int k = 0; k < b.size; ++k) base_[b.reflected_at[k]] = values_.reflected[k];
}

template <typename Real>
template <typename Rule>
void InterpolatedBounceBack<Real>::gather(const Batch& b) {
  const Real* deviation = deviations_[parity_].data();
  for (int k = 0; k < b.size; ++k) {
    values_.deviation[k] = deviation[b.cell[k]];
    values_.incident[k] = base_[b.incident_at[k]];
    values_.second[k] = base_[b.second_at[k]];
  }
  if constexpr (Rule::needs_both) {
    clear_second_of_narrow(b);
    gather_upstream(b);
  } else {
    if (b.narrow_count > 0) gather_narrow(b);
  }
  if (has_rest_) subtract_rest(b);
  if (b.leaks) find_leaks(b);
}

// Narrow links have half-way bounce-back here. Their slot of x_ff belongs to a solid cell and may hold an infinity or
// NaN, which a weight of 0 would not remove.
template <typename Real>
void InterpolatedBounceBack<Real>::clear_second_of_narrow(const Batch& b) {
  for (int p = 0; p < b.pieces; ++p)
    std::fill(values_.second + b.piece[p].first, values_.second + b.piece[p].narrow_end(), Real(0));
}

template <typename Real>
void InterpolatedBounceBack<Real>::find_leaks(const Batch& b) {
  const Real around = static_cast<Real>(options_.reference_density);
  for (int k = 0; k < b.size; ++k)
    values_.leak[k] = (b.tag[k] & LinkTag::enclosed) != 0 ? excess()[k] - around : Real(0);
}

// x_f from the body's centre: the arm, back by the distance.
template <typename Real>
void InterpolatedBounceBack<Real>::subtract_rest(const Batch& b) {
  const Vec3& gradient = options_.rest_gradient;
  for (int p = 0; p < b.pieces; ++p) {
    const Piece& piece = b.piece[p];
    const double at_centre = gradient.dot(bodies_[static_cast<std::size_t>(piece.body)].centre - options_.rest_middle);
    for (int k = piece.first; k < piece.filled_end(); ++k) {
      const Vec3 c(component(b.tag[k], 0), component(b.tag[k], 1), component(b.tag[k], 2));
      const Vec3 arm(b.arm[0][k], b.arm[1][k], b.arm[2][k]);
      values_.excess[k] = values_.deviation[k] -
                          static_cast<Real>(at_centre + gradient.dot(arm - static_cast<double>(b.distance[k]) * c));
    }
  }
}

template <typename Real>
void InterpolatedBounceBack<Real>::gather_narrow(const Batch& b) {
  upstream_.begin(b.narrow_count);
  for (int c = 0; c < b.narrow_count; ++c) {
    const int k = b.narrow[c];
    const LinkBody& other = bodies_[LinkTag::upstream_body(b.tag[k])];
    // Both vectors lead to nearest images, and of a solid as long as half the box they may go round it together.
    const Vec3 round =
        box_.difference(body_of(b, k).centre, other.centre) + Vec3(b.arm[0][k], b.arm[1][k], b.arm[2][k]);
    upstream_.take(c, b.tag[k], b.distance[k], box_.difference(round, Vec3::Zero()), values_.deviation[k], other);
  }
  upstream_.find_populations(options_.rest_gradient);
  for (int c = 0; c < b.narrow_count; ++c) values_.second[b.narrow[c]] = static_cast<Real>(upstream_.population(c));
}

// Second value of a rule that needs both populations; narrow links have none (clear_second_of_narrow()).
template <typename Real>
void InterpolatedBounceBack<Real>::gather_upstream(const Batch& b) {
  for (int p = 0; p < b.pieces; ++p)
    for (int k = b.piece[p].narrow_end(); k < b.piece[p].filled_end(); ++k)
      values_.second[k] =
          base_[slots_.one_back(b.incident_at[k], b.tag[k])] - base_[slots_.one_back(b.reflected_at[k], b.tag[k])];
}

template <typename Real>
template <typename Rule, bool with_moments>
void InterpolatedBounceBack<Real>::reflect(const Batch& b, const Piece& piece) {
  constexpr int width = static_cast<int>(Pack::size());
  const Body body(bodies_[static_cast<std::size_t>(piece.body)]);
  const Pack zero = Real(0), lane([](auto j) { return Real(static_cast<int>(j)); });
  const Pack galilean = options_.momentum_exchange == MomentumExchange::galilean_invariant ? Real(1) : Real(0);
  const Pack reference = Real(2.0 * options_.reference_density);
  for (int k = piece.first; k < piece.filled_end(); k += width) {
    const auto at = [k](const Real* values) { return Pack(values + k, stdx::element_aligned); };
    const auto put = [k](const Pack& pack, Real* values) { pack.copy_to(values + k, stdx::element_aligned); };
    const Ints tag(b.tag + k, stdx::element_aligned);
    const Pack cx = velocity(tag, 0), cy = velocity(tag, 1), cz = velocity(tag, 2);
    const Pack squared = cx * cx + cy * cy + cz * cz, ax = at(b.arm[0]), ay = at(b.arm[1]), az = at(b.arm[2]);
    const Pack weight = (Pack(Real(3)) - squared) * Pack(Real(1.0 / 36.0));
    const Pack ux = body.vx + (body.wy * az - body.wz * ay), uy = body.vy + (body.wz * ax - body.wx * az),
               uz = body.vz + (body.wx * ay - body.wy * ax);
    const Pack towards_wall = cx * ux + cy * uy + cz * uz;
    LinkWeights<Pack> rule = Rule::weights(at(b.distance));
    if constexpr (Rule::needs_both) {  // half-way bounce-back in a gap of one cell
      const typename Pack::mask_type narrow = lane < Pack(Real(piece.narrow_end() - k));
      rule.incident = chosen<Pack>(narrow, Pack(Real(1)), rule.incident);
      rule.second = chosen<Pack>(narrow, Pack(Real(0)), rule.second);
      rule.wall = chosen<Pack>(narrow, Pack(Real(6)), rule.wall);
    }
    const Pack deviation = at(values_.deviation), incident = at(values_.incident);
    const Pack density = Pack(Real(1)) + deviation;
    const Pack interpolated = rule.incident * incident + rule.second * at(values_.second);
    const Pack moving_wall = rule.wall * weight * density * towards_wall;
    Pack returned = body.returned + (cx * body.sx + cy * body.sy + cz * body.sz);
    if (b.leaks) returned -= at(values_.leak);
    const Pack reflected = interpolated - moving_wall + weight * returned;
    put(reflected, values_.reflected);
    // Copies count nowhere.
    const typename Pack::mask_type counts = lane < Pack(Real(piece.end() - k));
    const Pack taken = chosen<Pack>(counts, incident, zero), given = chosen<Pack>(counts, reflected, zero),
               counted = chosen<Pack>(counts, weight, zero);
    put(taken, values_.taken);
    put(given, values_.given);
    put(counted * at(excess()), values_.pressure);
    const Pack sum = taken + given - reference * counted, flux = galilean * (taken - given);
    const Pack mx = sum * cx - flux * ux, my = sum * cy - flux * uy, mz = sum * cz - flux * uz;
    put(mx, values_.momentum[0]);
    put(my, values_.momentum[1]);
    put(mz, values_.momentum[2]);
    put(ay * mz - az * my, values_.torque[0]);
    put(az * mx - ax * mz, values_.torque[1]);
    put(ax * my - ay * mx, values_.torque[2]);
    if constexpr (with_moments) {
      const Pack m[3] = {mx, my, mz}, arm[3] = {ax, ay, az};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) put(m[i] * arm[j], values_.moment[i][j]);
    }
  }
}

// Three sums at a time: more of them do not fit into the registers of AVX2.
template <typename Real>
FixedVec3 InterpolatedBounceBack<Real>::sum_of(const Piece& piece, const Real (&terms)[3][capacity]) {
  static_assert(capacity <= FixedSums<3>::most_terms);
  FixedSums<3> sums;
  for (int k = piece.first; k < piece.filled_end(); k += FixedSums<3>::width)
    sums.add({wide(terms[0] + k), wide(terms[1] + k), wide(terms[2] + k)});
  return {sums[0], sums[1], sums[2]};
}

template <typename Real>
void InterpolatedBounceBack<Real>::add_momentum(const Piece& piece) const {
  LinkBody& body = bodies_[static_cast<std::size_t>(piece.body)];
  body.force += sum_of(piece, values_.momentum);
  if (body.turns) body.torque += sum_of(piece, values_.torque);
}

template <typename Real>
void InterpolatedBounceBack<Real>::add_pressure_and_mass(const Piece& piece) const {
  FixedSums<2> sums;
  for (int k = piece.first; k < piece.filled_end(); k += FixedSums<2>::width)
    // The difference is exact in double: single storage loses nothing here.
    sums.add({wide(values_.pressure + k), wide(values_.given + k) - wide(values_.taken + k)});
  LinkBody& body = bodies_[static_cast<std::size_t>(piece.body)];
  body.pressure = exact_sum(body.pressure, sums[0]);
  body.mass = exact_sum(body.mass, sums[1]);
}

template <typename Real>
void InterpolatedBounceBack<Real>::add_moments(const Piece& piece) const {
  FixedTensor& moments = (*moments_)[static_cast<std::size_t>(piece.body)];
  for (int row = 0; row < 3; ++row) moments.add(row, sum_of(piece, values_.moment[row]));
}

template <typename Real>
void InterpolatedBounceBack<Real>::add_by_height(const Batch& b, const Piece& piece) const {
  const bool is_obstacle = bodies_[static_cast<std::size_t>(piece.body)].is_obstacle;
  for (int k = piece.first; k < piece.end(); ++k) {
    const auto at = [&](int axis) { return LatticeFixed::from(static_cast<double>(values_.momentum[axis][k])); };
    by_height_->add(piece.body, is_obstacle, 2 * b.plane + 1 + component(b.tag[k], 2), {at(0), at(1), at(2)});
  }
}

template class InterpolatedBounceBack<float>;
template class InterpolatedBounceBack<double>;

}  // namespace thalweg::bodies
