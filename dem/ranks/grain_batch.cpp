#include "dem/ranks/grain_batch.hpp"

#include "core/parallel/wide_rows.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace thalweg::dem {

namespace {

void add_grain(const GrainStore& store, std::size_t s, GrainBatch& batch) {
  batch.rows.push_back({store.id[s],
                        static_cast<std::int64_t>(store.motion[s]),
                        store.material[s],
                        store.radius[s],
                        store.mass[s],
                        {plain(store.position[s]), plain(store.velocity[s]), plain(store.angular_velocity[s]),
                         plain(store.contact_force[s]), plain(store.contact_torque[s]), plain(store.load_force[s]),
                         plain(store.load_torque[s])},
                        store.clump[s],
                        plain(store.offset[s])});
  const std::span<const double> attached = store.attached_of(s);
  batch.attached.insert(batch.attached.end(), attached.begin(), attached.end());
}

}  // namespace

void sort_by_id(GrainBatch& batch, int width) {
  std::vector<std::size_t> order(batch.rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return batch.rows[a].id < batch.rows[b].id; });
  GrainBatch sorted;
  sorted.rows.reserve(order.size());
  sorted.attached.reserve(batch.attached.size());
  for (const std::size_t from : order) {
    sorted.rows.push_back(batch.rows[from]);
    for (int c = 0; c < width; ++c) sorted.attached.push_back(batch.attached[from * width + c]);
  }
  batch = std::move(sorted);
}

GrainBatch owned_grains(const GrainStore& store) {
  GrainBatch batch;
  batch.rows.reserve(store.owned);
  batch.attached.reserve(store.owned * store.attached_width);
  for (std::size_t s = 0; s < store.owned; ++s) add_grain(store, s, batch);
  return batch;
}

GrainBatch marked_grains(const GrainStore& store, std::span<const char> marks) {
  GrainBatch batch;
  for (std::size_t s = 0; s < store.owned; ++s)
    if (marks[s] != 0) add_grain(store, s, batch);
  return batch;
}

void replace_owned(GrainStore& store, const GrainBatch& batch) {
  store.clear();
  store.reserve(batch.rows.size());
  for (const GrainRow& row : batch.rows) {
    const auto vector = [&row](GrainRow::Vector which) { return Vec3(row.value[which].data()); };
    store.append(row.id, row.radius, row.mass, static_cast<Motion>(row.motion), vector(GrainRow::position),
                 static_cast<int>(row.material));
    store.velocity.back() = vector(GrainRow::velocity);
    store.angular_velocity.back() = vector(GrainRow::angular_velocity);
    store.contact_force.back() = vector(GrainRow::contact_force);
    store.contact_torque.back() = vector(GrainRow::contact_torque);
    store.load_force.back() = vector(GrainRow::load_force);
    store.load_torque.back() = vector(GrainRow::load_torque);
    store.clump.back() = row.clump;
    store.offset.back() = Vec3(row.offset.data());
  }
  store.attached = batch.attached;
  store.owned = batch.rows.size();
}

GrainBatch exchange_grains(MPI_Comm communicator, GrainBatch batch, const std::vector<int>& destination,
                           int attached_width) {
  GrainBatch arrived;
  arrived.rows = exchange_rows(communicator, std::move(batch.rows), destination);
  arrived.attached = exchange_wide_rows(communicator, std::move(batch.attached),
                                        static_cast<std::size_t>(attached_width), destination);
  sort_by_id(arrived, attached_width);
  return arrived;
}

void replace_marked(GrainStore& store, std::span<const char> marks, const GrainBatch& batch) {
  const auto width = static_cast<std::ptrdiff_t>(store.attached_width);
  GrainBatch all;
  all.rows.reserve(store.owned + batch.rows.size());
  all.attached.reserve(all.rows.capacity() * store.attached_width);
  std::size_t next = 0;  // of the batch
  const auto add_below = [&](GlobalId id) {
    for (; next < batch.rows.size() && batch.rows[next].id < id; ++next) {
      all.rows.push_back(batch.rows[next]);
      const auto first = batch.attached.begin() + static_cast<std::ptrdiff_t>(next) * width;
      all.attached.insert(all.attached.end(), first, first + width);
    }
  };
  for (std::size_t s = 0; s < store.owned; ++s) {
    if (marks[s] != 0) continue;
    add_below(store.id[s]);
    add_grain(store, s, all);
  }
  add_below(std::numeric_limits<GlobalId>::max());
  replace_owned(store, all);
}

void move_grains(MPI_Comm communicator, GrainStore& store, const std::vector<int>& owner) {
  const int me = rank_of(communicator);
  std::vector<char> leaves(store.owned);
  std::vector<int> destination;
  for (std::size_t s = 0; s < store.owned; ++s)
    if (owner[s] != me) {
      leaves[s] = 1;
      destination.push_back(owner[s]);
    }
  const GrainBatch arrived =
      exchange_grains(communicator, marked_grains(store, leaves), destination, static_cast<int>(store.attached_width));
  if (destination.empty() && arrived.rows.empty()) return store.drop_ghosts();
  replace_marked(store, leaves, arrived);
}

}  // namespace thalweg::dem
