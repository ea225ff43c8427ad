// Grains that change their ranks, against what each rank should have.
#include "dem/ranks/grain_batch.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

namespace thalweg::dem::grain_batch_test {
namespace {

constexpr GlobalId count = 157;
constexpr int width = 3;

int owner_of(GlobalId id, int step) {
  // Some grains never leave; in step 3 none does.
  const GlobalId moves = step == 3 ? 2 : step;
  return static_cast<int>((id * 11 + (id % 4 == 0 ? id / 7 * moves : 0)) % size_of(MPI_COMM_WORLD));
}

void add(GrainStore& store, GlobalId id) {
  const auto x = static_cast<double>(id);
  store.append(id, 1.0 + x, 2.0 + x, id % 5 == 0 ? Motion::fixed : Motion::free, Vec3(x, 0.5, -x),
               static_cast<int>(id % 3));
  store.velocity.back() = Vec3(0.1 * x, 0.2, 0.3);
  store.angular_velocity.back() = Vec3(4.0, x, 5.0);
  store.contact_force.back() = Vec3(x, x, 6.0);
  store.contact_torque.back() = Vec3(7.0, 8.0, x);
  store.load_force.back() = Vec3(-x, 9.0, 10.0);
  store.load_torque.back() = Vec3(11.0, -x, 12.0);
  store.clump.back() = id % 6 == 0 ? id : -1;
  store.offset.back() = Vec3(0.0, 0.0, x);
  for (int c = 0; c < width; ++c) store.attached_of(store.total() - 1)[static_cast<std::size_t>(c)] = 100.0 * x + c;
}

GrainStore as_owned_in(int step) {
  GrainStore store(width);
  for (GlobalId id = 0; id < count; ++id)
    if (owner_of(id, step) == rank_of(MPI_COMM_WORLD)) add(store, id);
  store.owned = store.total();
  return store;
}

void expect_same(const GrainStore& a, const GrainStore& b) {
  EXPECT_EQ(a.owned, b.owned);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.inertia, b.inertia);
  EXPECT_EQ(a.inverse_mass, b.inverse_mass);
  EXPECT_EQ(a.motion, b.motion);
  EXPECT_EQ(a.clump, b.clump);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.angular_velocity, b.angular_velocity);
  EXPECT_EQ(a.contact_force, b.contact_force);
  EXPECT_EQ(a.contact_torque, b.contact_torque);
  EXPECT_EQ(a.load_force, b.load_force);
  EXPECT_EQ(a.load_torque, b.load_torque);
  EXPECT_EQ(a.attached, b.attached);
}

TEST(MoveGrains, GivesEveryRankItsGrainsInTheOrderOfIds) {
  GrainStore store = as_owned_in(0);
  for (int step = 1; step < 8; ++step) {
    const std::size_t owned = store.total();
    add(store, count + 1);  // a ghost
    store.owned = owned;
    std::vector<int> owner;
    for (std::size_t s = 0; s < owned; ++s) owner.push_back(owner_of(store.id[s], step));
    move_grains(MPI_COMM_WORLD, store, owner);
    expect_same(store, as_owned_in(step));
  }
}

}  // namespace
}  // namespace thalweg::dem::grain_batch_test
