// What observers say that they keep of each grain (observer_memory.hpp), against what they allocate.
#include "analysis/observers/observer_list.hpp"
#include "tests/analysis/made_up_grains.hpp"

#include <gtest/gtest.h>

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

// Every allocation of the test program is counted, as the C library has it.
namespace {

std::atomic<std::int64_t> bytes_in_use{0};

void* counted(void* block) {
  if (block) bytes_in_use += static_cast<std::int64_t>(malloc_usable_size(block) + sizeof(std::size_t));
  return block;
}

void* counted_or_throw(void* block) {
  if (!block) throw std::bad_alloc();
  return counted(block);
}

void release(void* block) {
  if (block) bytes_in_use -= static_cast<std::int64_t>(malloc_usable_size(block) + sizeof(std::size_t));
  std::free(block);
}

void* aligned(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(step, (size + step - 1) / step * step);
}

}  // namespace

void* operator new(std::size_t size) { return counted_or_throw(std::malloc(size)); }
void* operator new[](std::size_t size) { return counted_or_throw(std::malloc(size)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(std::malloc(size)); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t a) { return counted_or_throw(aligned(size, a)); }
void* operator new[](std::size_t size, std::align_val_t a) { return counted_or_throw(aligned(size, a)); }
void operator delete(void* block) noexcept { release(block); }
void operator delete[](void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { release(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { release(block); }

namespace thalweg::analysis::observer_memory_test {
namespace {

constexpr double dt = 0.01, diameter = 0.5;  // s, m
const MPI_Comm alone = MPI_COMM_SELF;        // each rank by itself

// Four contacts of every grain that is asked for.
class FourContacts : public ContactSource {
public:
  void for_each_contact(const ContactVisitor&) const override {}
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    for (std::size_t n = 0; n < chosen.size(); ++n)
      for (GlobalId partner = 0; partner < 4 && chosen[n] != 0; ++partner)
        visit(n, {Vec3(0.0, 0.0, -0.25), Vec3(0.0, 0.0, 1.0), partner, Vec3(0.0, 0.0, -0.5)});
  }
};

RunContext run_of(GlobalId ids) {
  RunContext run;
  run.box = {Vec3(20.0, 10.0, 5.0), {true, true, false}};
  run.until = 10.0;
  run.gravity = Vec3(0.0, 0.0, -9.81);
  run.fluid = FluidContext{1000.0, 1e-6, 1.0};
  GrainContext grains;
  grains.populations.push_back({"0", 0, ids, [](double) { return Vec3(Vec3::Zero()); }});
  grains.reference_diameter = grains.smallest_diameter = grains.largest_diameter = diameter;
  grains.smallest_free = grains.largest_free = diameter;
  grains.size_class_edges = {0.4, 0.6};
  grains.reference_density = 2650.0;
  const auto none = [](double, double) { return Vec3(Vec3::Zero()); };
  grains.body_force = grains.submerged_weight = grains.buoyancy = none;
  run.grains = grains;
  return run;
}

// Bytes that an observer keeps of so many grains at rest after so many steps.
template <typename Keys>
double bytes_kept(const Keys& keys, GlobalId ids, int steps) {
  const MadeUpGrains grains(alone, ids, [](GlobalId id) {
    const auto n = static_cast<double>(id);
    return MadeUpGrain{0.5 * diameter, 1.0, Vec3::Zero(), Vec3::Zero(),
                       Vec3(std::fmod(0.37 * n, 20.0), std::fmod(0.59 * n, 10.0), 0.25 + std::fmod(0.13 * n, 2.0))};
  });
  const FourContacts contacts;
  const RunContext run = run_of(ids);
  const std::int64_t before = bytes_in_use;
  const std::unique_ptr<Observer> observer = make_observer(keys, run, {alone, *grains.snapshot(0.0).decomposition, dt});
  for (int step = 0; step < steps; ++step) {
    Snapshot snapshot = grains.snapshot(dt * step);
    snapshot.step = step;
    snapshot.contacts = &contacts;
    observer->observe(snapshot);
  }
  return static_cast<double>(bytes_in_use - before);
}

template <typename Keys>
ObserverMemory memory_said(const Keys& keys, GlobalId ids) {
  return memory_of(keys, run_of(ids), {static_cast<double>(ids), dt});
}

// Bytes of each id, and as the observer says it: by two numbers of ids, so that all that is common drops out.
constexpr GlobalId few = 2000, many = 6000;
template <typename Keys>
double kept_of_an_id(const Keys& keys) {
  return (bytes_kept(keys, many, 5) - bytes_kept(keys, few, 5)) / static_cast<double>(many - few);
}
template <typename Keys>
double said_of_an_id(const Keys& keys) {
  return (memory_said(keys, many).of_ids - memory_said(keys, few).of_ids) / static_cast<double>(many - few);
}

template <typename Keys>
void expect_right(const Keys& keys, double least) {
  const double kept = kept_of_an_id(keys), said = said_of_an_id(keys);
  EXPECT_NEAR(said, kept, 0.03 * kept) << Keys::section;
  EXPECT_GT(kept, least) << Keys::section;
}

// Those that keep nothing of a grain: less than a byte of each. (Not here: those that look at a fluid.)
template <typename Keys>
void expect_nothing(const Keys& keys) {
  EXPECT_EQ(said_of_an_id(keys), 0.0) << Keys::section;
  EXPECT_NEAR(kept_of_an_id(keys), 0.0, 1.0) << Keys::section;
}

TEST(ObserverMemory, OfEveryGrain) {
  expect_right(TransportRateKeys{}, 30.0);
  expect_right(BedSurfaceKeys{}, 200.0);
  expect_right(BedSurfaceKeys{.pixel = diameter / 5.0}, 50.0);
  expect_right(ReachKeys{}, 270.0);
  expect_right(EntrainmentKeys{.grains = {0, 1}}, 500.0);
}

TEST(ObserverMemory, OfObserversOfMeans) {
  expect_nothing(FractionalTransportKeys{});
  expect_nothing(GrainProfilesKeys{});
  expect_nothing(PopulationLoadsKeys{});
}

// Of a watched grain, by two lengths of its memory.
TEST(ObserverMemory, OfGrainsThatAreWatched) {
  EntrainmentKeys shorter{.grains = {}, .memory = 0.2}, longer{.grains = {}, .memory = 0.8};
  for (GlobalId id = 0; id < 40; ++id) shorter.grains.push_back(id), longer.grains.push_back(id);
  const double kept = bytes_kept(longer, 100, 100) - bytes_kept(shorter, 100, 100);
  const double said = memory_said(longer, 100).of_ids - memory_said(shorter, 100).of_ids;
  EXPECT_NEAR(said, kept, 0.03 * kept);
  EXPECT_GT(kept, 40 * 60 * 500.0);
  EXPECT_GT(memory_said(EntrainmentKeys{}, 100000).of_ids, memory_said(EntrainmentKeys{.grains = {0}}, 100000).of_ids);
}

// Records of a hundred steps: as many numbers of each quantity, 100 times 54 times 3, as a list that doubles is nearly
// full of.
TEST(ObserverMemory, OfTracks) {
  TracksKeys keys;
  keys.every = dt;
  for (GlobalId id = 0; id < 54; ++id) keys.grains.push_back(id);
  const double kept = bytes_kept(keys, 60, 100), said = memory_said(keys, 60).on_first_rank;
  EXPECT_NEAR(said / grown_list, kept, 0.05 * kept);
  TracksKeys seldom = keys;
  seldom.every = 10 * dt;
  EXPECT_LT(memory_said(seldom, 60).on_first_rank, 0.2 * said);
}

TEST(ObserverMemory, OfAllRequested) {
  RequestedObservers requested;
  requested.of<TransportRateKeys>().emplace();
  const RunSize size{1000.0, dt};
  const RunContext run = run_of(1000);
  const double hops = memory_of(requested, run, size).of_ids;
  EXPECT_EQ(hops, memory_said(TransportRateKeys{}, 1000).of_ids);
  requested.of<ReachKeys>().emplace();
  requested.of<ProbesKeys>().emplace().points = {Vec3(1.0, 1.0, 1.0)};
  EXPECT_EQ(memory_of(requested, run, size).of_ids, hops + memory_said(ReachKeys{}, 1000).of_ids);
  EXPECT_GT(memory_of(requested, run, size).on_first_rank, 0.0);
  RunContext dry = run;
  dry.fluid.reset();
  EXPECT_EQ(memory_of(requested, dry, size).on_first_rank, 0.0);  // as there is nothing to probe
}

}  // namespace
}  // namespace thalweg::analysis::observer_memory_test
