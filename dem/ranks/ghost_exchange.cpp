#include "dem/ranks/ghost_exchange.hpp"

#include "core/parallel/wide_rows.hpp"
#include "core/sums/sum_range.hpp"
#include "dem/ranks/grain_batch.hpp"

#include <algorithm>
#include <array>

namespace thalweg::dem {

namespace {

constexpr int motion_tag = 4101, attached_tag = 4102, values_tag = 4103, followed_tag = 4104;

struct GhostRow {
  GlobalId id;
  std::int64_t motion, material;
  GlobalId clump;
  double radius, mass;
  std::array<std::array<double, 3>, 3> value;  // position, velocity, angular velocity
  std::int64_t owner;
};

// Data of a grain in the message of a sub-step.
struct MotionRow {
  double value[9];
};

bool blocks_near(const Decomposition& d, int rank_1, int rank_2, double distance) {
  const Block b1 = d.block_of(rank_1), b2 = d.block_of(rank_2);
  for (int axis = 0; axis < 3; ++axis) {
    bool near = false;
    for (int image = -1; image <= 1; ++image) {
      if (image != 0 && !d.periodic()[axis]) continue;
      const double shift = image * d.cells()[axis] * d.spacing();
      near = near || (b1.lower[axis] * d.spacing() - distance <= b2.upper[axis] * d.spacing() + shift &&
                      b1.upper[axis] * d.spacing() + distance >= b2.lower[axis] * d.spacing() + shift);
    }
    if (!near) return false;
  }
  return true;
}

}  // namespace

GhostExchange::GhostExchange(const Decomposition& decomposition, MPI_Comm communicator, double reach, double overhang)
    : decomposition_(decomposition), communicator_(communicator), reach_(reach + overhang) {
  const int me = rank_of(communicator);
  for (int rank = 0; rank < decomposition.ranks(); ++rank)
    // A little further than the grains' own test, so that rounding cannot make this one the stricter.
    if (rank != me && blocks_near(decomposition, me, rank, 1.001 * (reach_ + overhang))) candidates_.push_back(rank);
}

void GhostExchange::build(GrainStore& store) {
  store.drop_ghosts();
  neighbours_.clear();
  values_width_ = 0;
  attached_ready_ = false;
  std::vector<GhostRow> rows;
  std::vector<double> columns;
  std::vector<int> row_to;
  for (const int rank : candidates_) {
    Neighbour neighbour{rank, {}, {}};
    for (std::size_t s = 0; s < store.owned; ++s) {
      if (!decomposition_.reaches(rank, store.position[s], reach_)) continue;
      neighbour.send.push_back(static_cast<std::uint32_t>(s));
      rows.push_back({store.id[s],
                      static_cast<std::int64_t>(store.motion[s]),
                      store.material[s],
                      store.clump[s],
                      store.radius[s],
                      store.mass[s],
                      {plain(store.position[s]), plain(store.velocity[s]), plain(store.angular_velocity[s])},
                      rank_of(communicator_)});
      row_to.push_back(rank);
      for (const double value : store.attached_of(s)) columns.push_back(value);
    }
    neighbours_.push_back(std::move(neighbour));
  }

  const std::vector<GhostRow> ghosts = exchange_rows(communicator_, rows, row_to);
  store.reserve(store.owned + ghosts.size());
  auto neighbour = neighbours_.begin();
  for (const GhostRow& g : ghosts) {
    while (neighbour->rank != g.owner) ++neighbour;
    neighbour->ghosts.push_back(static_cast<std::uint32_t>(store.total()));
    store.append(g.id, g.radius, g.mass, static_cast<Motion>(g.motion), Vec3(g.value[0].data()),
                 static_cast<int>(g.material));
    store.clump.back() = g.clump;
    store.velocity.back() = Vec3(g.value[1].data());
    store.angular_velocity.back() = Vec3(g.value[2].data());
  }
  std::erase_if(neighbours_, [](const Neighbour& n) { return n.send.empty() && n.ghosts.empty(); });
  motion_ = PackedExchange(communicator_, messages(neighbours_, motion_tag, sizeof(MotionRow)));
  follows_ = false;
  if (store.attached_width > 0) {
    const std::vector<double> ghost_columns =
        exchange_wide_rows(communicator_, std::move(columns), store.attached_width, row_to);
    std::copy(ghost_columns.begin(), ghost_columns.end(),
              store.attached.begin() + static_cast<std::ptrdiff_t>(store.owned * store.attached_width));
  }
}

std::vector<PackedExchange::Neighbour> GhostExchange::messages(const std::vector<Neighbour>& neighbours, int tag,
                                                               std::size_t bytes_per_grain) {
  std::vector<PackedExchange::Neighbour> list;
  for (const Neighbour& n : neighbours)
    list.push_back({n.rank, tag, tag, n.send.size() * bytes_per_grain, n.ghosts.size() * bytes_per_grain});
  return list;
}

void GhostExchange::follow(std::span<const PairContact> pairs, const GrainStore& store) {
  std::vector<std::uint32_t> neighbour_of(store.total());  // of a ghost: the number of the one that owns it
  follows_ = true;
  followed_.clear();
  for (const Neighbour& n : neighbours_) {
    for (const std::uint32_t ghost : n.ghosts) neighbour_of[ghost] = static_cast<std::uint32_t>(followed_.size());
    followed_.push_back({n.rank, {}, {}});
  }
  for (const PairContact& pair : pairs) {
    if (!store.is_ghost(pair.first) && !store.is_ghost(pair.second)) continue;
    const auto [own, ghost] = std::minmax(pair.first, pair.second);  // ghosts come behind
    Neighbour& neighbour = followed_[neighbour_of[ghost]];
    neighbour.send.push_back(own);
    neighbour.ghosts.push_back(ghost);
  }
  // Sorts by slot, which is the order of ids on both sides.
  const auto each_once = [](std::vector<std::uint32_t>& slots) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  };
  for (Neighbour& n : followed_) {
    each_once(n.send);
    each_once(n.ghosts);
  }
  std::erase_if(followed_, [](const Neighbour& n) { return n.send.empty(); });
  followed_motion_ = PackedExchange(communicator_, messages(followed_, followed_tag, sizeof(MotionRow)));
}

// read(slot) gives what is sent of a grain, write(slot, row) takes it.
template <typename Read, typename Write>
void GhostExchange::exchange_motion(const std::vector<Neighbour>& neighbours, PackedExchange& exchange, Read&& read,
                                    Write&& write) {
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    auto* row = exchange.send_buffer<MotionRow>(n);
    for (const std::uint32_t s : neighbours[n].send) *row++ = read(s);
  }
  exchange.start();
  exchange.finish();
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    const auto* row = exchange.receive_buffer<MotionRow>(n);
    for (const std::uint32_t s : neighbours[n].ghosts) write(s, *row++);
  }
}

void GhostExchange::refresh(GrainStore& store) {
  exchange_motion(
      neighbours_, motion_,
      [&](std::size_t s) -> MotionRow {
        const Vec3 &x = store.position[s], &v = store.velocity[s], &w = store.angular_velocity[s];
        return {{x[0], x[1], x[2], v[0], v[1], v[2], w[0], w[1], w[2]}};
      },
      [&](std::size_t s, const MotionRow& row) {
        store.position[s] = Vec3(row.value);
        store.velocity[s] = Vec3(row.value + 3);
        store.angular_velocity[s] = Vec3(row.value + 6);
      });
}

void GhostExchange::refresh(PackedGrainState& grains) {
  exchange_motion(
      follows_ ? followed_ : neighbours_, follows_ ? followed_motion_ : motion_,
      [&](std::size_t s) -> MotionRow {
        const Double4 &x = grains[s].position, &v = grains[s].velocity, &w = grains[s].spin;
        return {{x[0], x[1], x[2], v[0], v[1], v[2], w[0], w[1], w[2]}};
      },
      [&](std::size_t s, const MotionRow& row) {
        const double* value = row.value;
        grains[s].position = Double4{value[0], value[1], value[2], grains[s].position[3]};
        grains[s].velocity = Double4{value[3], value[4], value[5], 0.0};
        grains[s].spin = Double4{value[6], value[7], value[8], 0.0};
      });
}

void GhostExchange::refresh_attached(GrainStore& store, std::size_t first, std::size_t count) {
  if (!attached_ready_) {
    attached_ = PackedExchange(communicator_, messages(neighbours_, attached_tag, sizeof(double) * count));
    attached_ready_ = true;
  }
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto* value = attached_.send_buffer<double>(n);
    for (const std::uint32_t s : neighbours_[n].send)
      for (const double column : store.attached_of(s).subspan(first, count)) *value++ = column;
  }
  attached_.start();
  attached_.finish();
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    const auto* value = attached_.receive_buffer<double>(n);
    for (const std::uint32_t s : neighbours_[n].ghosts)
      for (double& column : store.attached_of(s).subspan(first, count)) column = *value++;
  }
}

// The way back: every neighbour sends what it has for its ghosts to the rank it has them from.
void GhostExchange::add_to_owners(std::vector<std::int64_t>& values, int width) {
  const std::size_t grain_bytes = sizeof(std::int64_t) * width;
  if (values_width_ != width) {
    std::vector<PackedExchange::Neighbour> list;
    for (const Neighbour& n : neighbours_)
      list.push_back({n.rank, values_tag, values_tag, n.ghosts.size() * grain_bytes, n.send.size() * grain_bytes});
    values_ = PackedExchange(communicator_, list);
    values_width_ = width;
  }
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto* value = values_.send_buffer<std::int64_t>(n);
    for (const std::uint32_t s : neighbours_[n].ghosts)
      value = std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(s) * width, width, value);
  }
  values_.start();
  values_.finish();
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    const auto* value = values_.receive_buffer<std::int64_t>(n);
    for (const std::uint32_t s : neighbours_[n].send)
      for (int k = 0; k < width; ++k) {
        std::int64_t& sum = values[static_cast<std::size_t>(s) * width + k];
        sum = exact_sum(sum, *value++);
      }
  }
}

}  // namespace thalweg::dem
