#include "dem/grain_batch.hpp"

#include "core/mpi_session.hpp"

#include <algorithm>
#include <numeric>

namespace thalweg::dem {

namespace {

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

}  // namespace

GrainBatch owned_grains(const GrainStore& store) {
  GrainBatch batch;
  batch.rows.reserve(store.owned);
  for (std::size_t s = 0; s < store.owned; ++s)
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
  batch.attached.assign(store.attached.begin(),
                        store.attached.begin() + static_cast<std::ptrdiff_t>(store.owned * store.attached_width));
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
  if (attached_width > 0) {
    std::vector<int> each;
    each.reserve(batch.attached.size());
    for (const int to : destination) each.insert(each.end(), attached_width, to);
    arrived.attached = exchange_rows(communicator, std::move(batch.attached), each);
  }
  sort_by_id(arrived, attached_width);
  return arrived;
}

}  // namespace thalweg::dem
