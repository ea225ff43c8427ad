// The contracts of a step with bodies: what is called out of order or for the wrong kind of body ends at once.
#include "bodies/bodies.hpp"

#include "core/base/check.hpp"

#include <gtest/gtest.h>

namespace thalweg::bodies::bodies_test {
namespace {

class BodyContracts : public ::testing::Test {
protected:
  BodyContracts()
      : bodies_(decomposition_, MPI_COMM_SELF, fluid_, {}, {}, {Solid{SolidSphere{Vec3(2.5, 2.5, 2.5), 1.2}}}) {}

  void sweep() { bodies_.sweep(timer_, phase_, phase_); }

  Decomposition decomposition_{Index3{16, 12, 12}, 1.0, {true, true, true}, Index3{1, 1, 1}};
  lbm::Fluid<double> fluid_{decomposition_, MPI_COMM_SELF, {}, {}};
  Bodies<double> bodies_;
  PhaseTimer timer_;
  int phase_ = timer_.phase("all");
};

TEST_F(BodyContracts, LinksAreThoseOfTheBodiesPresentCells) {
  bodies_.begin_step();
  bodies_.add(7, 2.5, -1, Vec3(10.0, 6.0, 6.0));
  EXPECT_THROW(bodies_.update_links(), ContractError);  // cells have not changed hands yet
  bodies_.settle();
  EXPECT_THROW(sweep(), ContractError);  // links are those without the sphere
  EXPECT_THROW(bodies_.apply_links_on_copies(), ContractError);
  bodies_.refill();
  bodies_.update_links();
  fluid_.exchange_halo();
  EXPECT_NO_THROW(sweep());

  bodies_.begin_step();
  bodies_.remap(bodies_.slot_of(7), Vec3(11.0, 6.0, 6.0));
  EXPECT_THROW(sweep(), ContractError);
}

TEST_F(BodyContracts, SolidsAreNoSpheres) {
  const BodySlot solid = slot_of_solid(0), sphere = bodies_.add(7, 2.5, -1, Vec3(10.0, 6.0, 6.0));
  EXPECT_EQ(index_of(sphere), 1u);
  EXPECT_THROW(bodies_.remove(solid), ContractError);
  EXPECT_THROW(bodies_.remap(solid, Vec3(6.0, 6.0, 6.0)), ContractError);
  EXPECT_THROW(bodies_.move_solid(0, {}), ContractError);  // it stands still
  EXPECT_THROW(bodies_.move_solid(1, {}), ContractError);
  bodies_.remove(sphere);
  EXPECT_THROW(bodies_.remove(sphere), ContractError);
  EXPECT_THROW(bodies_.move(BodySlot::none, {}), ContractError);
}

TEST_F(BodyContracts, AnIdHasOneBody) {
  bodies_.add(7, 2.5, -1, Vec3(10.0, 6.0, 6.0));
  EXPECT_THROW(bodies_.add(7, 2.5, -1, Vec3(4.0, 6.0, 6.0)), ContractError);
}

TEST_F(BodyContracts, MomentumByHeightIsAskedForBeforeTheStep) {
  bodies_.begin_step();
  EXPECT_THROW(bodies_.momentum_by_height(), ContractError);
  bodies_.begin_step({.momentum_by_height = true});
  EXPECT_EQ(bodies_.momentum_by_height().on_grains.size(), 25u);
}

// Tiles in order, because each uses the densities that the one below it has measured.
TEST_F(BodyContracts, TilesComeInOrder) {
  LinkTable links(fluid_.tiles().count());
  const PeriodicBox box = decomposition_.cell_box();
  const LinkOptions options;
  std::vector<LinkBody> none;
  InterpolatedBounceBack<double> pass(fluid_, links, box, options, none);
  pass.apply_tile(0);
  EXPECT_THROW(pass.apply_tile(2), ContractError);
  LinkTable other(fluid_.tiles().count() + 1);
  EXPECT_THROW(InterpolatedBounceBack<double>(fluid_, other, box, options, none), ContractError);
}

TEST_F(BodyContracts, TheFluidWaitsForItsHalo) {
  fluid_.start_halo_exchange();
  EXPECT_THROW(fluid_.apply_walls(), ContractError);
  EXPECT_THROW(fluid_.stream_and_collide(), ContractError);
  fluid_.finish_halo_exchange();
  EXPECT_THROW(fluid_.finish_halo_exchange(), ContractError);
}

}  // namespace
}  // namespace thalweg::bodies::bodies_test
