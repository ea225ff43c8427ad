// A shape of the tests alone goes through map, links, refill and the whole step.
#include "tests/coupling/spheroid.hpp"
#include "tests/coupling/water_box.hpp"

#include "core/mpi_session.hpp"
#include "coupling/resolved_loads.ipp"
#include "coupling/resolved_sample.ipp"
#include "coupling/resolved_system.ipp"
#include "lbm/link_pass.ipp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::coupling::shape_test {
namespace {

// Cells are those inside by the equation of the surface, and links meet it where it is zero, to the round-off of a few
// operations on numbers below 30. The mean number of cells over m^3 places is, times m^3, the number of points of a
// lattice m times as fine: wrong by no more than what lies within half a diagonal of such a cell of the surface.
TEST(AnyShape, CoversItsVolumeAndIsCutWhereItsSurfaceIs) {
  const Index3 cells{26, 20, 20};
  const Decomposition decomposition(cells, 1.0, {true, true, true}, {1, 1, 1});
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, {}, {});
  GrainMap<Spheroid> map(decomposition, fluid.block(), fluid.cells());
  lbm::LinkTable table(fluid.tiles().count());
  LinkBuilder builder(decomposition, fluid.block(), fluid.cells(), fluid.tiles());
  const PeriodicBox box{Vec3(cells[0], cells[1], cells[2]), {true, true, true}};
  const Spheroid shape = Spheroid::of_grain(4.3);
  const auto height = [&](const Vec3& p) {
    return p.x() * p.x() / (shape.a * shape.a) + (p.y() * p.y() + p.z() * p.z()) / (shape.b * shape.b) - 1.0;
  };
  constexpr int m = 5;
  std::int64_t covered = 0;
  map.begin_update();
  const int slot = map.add(0, shape);
  for (int place = 0; place < m * m * m; ++place) {
    // Through the periodic ends, a fraction of a cell at a time, and far at every m-th place.
    const Vec3 centre =
        Vec3(0.07, 10.03, 19.91) + Vec3(place % m, place / m % m, place / (m * m)) / static_cast<double>(m);
    map.begin_update();
    map.place(slot, box.wrapped(centre));
    map.settle();
    builder.update(map, table);
    std::size_t cut = 0;
    for (int z = 0; z < cells[2]; ++z)
      for (int y = 0; y < cells[1]; ++y)
        for (int x = 0; x < cells[0]; ++x) {
          const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
          const Vec3 offset = box.difference(Vec3(x + 0.5, y + 0.5, z + 0.5), map.grains()[0].centre);
          ASSERT_EQ(fluid.cells().body(cell) == slot, height(offset) < 0.0);
          covered += fluid.cells().body(cell) == slot;
          for (int i = 1; fluid.cells().is_fluid(cell) && i < 19; ++i)
            cut += !fluid.cells().is_fluid(cell + fluid.indexing().offset(i));
        }
    ASSERT_EQ(table.count(), cut);
    const lbm::BlockPlace block(box, fluid.block().lower);
    for (int tile = 0; tile < fluid.tiles().count(); ++tile)
      for (const lbm::LinkTable::Run& run : table.runs_in_order(tile)) {
        const auto n = static_cast<std::size_t>(lbm::padded(static_cast<int>(run.count)));
        std::vector<double> distance(n), x(n), y(n), z(n);
        const lbm::LinkStream& links = table.tiles()[tile].links;
        lbm::find_crossings(shape, map.grains()[0].centre, block, fluid.tiles().plane_of(tile),
                            links.place.data() + run.first, links.tag.data() + run.first, static_cast<int>(n),
                            distance.data(), x.data(), y.data(), z.data());
        for (std::uint32_t k = 0; k < run.count; ++k) {
          ASSERT_NEAR(height(Vec3(x[k], y[k], z[k])), 0.0, 1e-13);
          ASSERT_GE(distance[k], 0.0);
          ASSERT_LE(distance[k], 1.0);
        }
      }
  }
  const double thickness = 0.5 * std::sqrt(3.0) / m;
  const Spheroid larger{shape.a + thickness, shape.b + thickness}, smaller{shape.a - thickness, shape.b - thickness};
  EXPECT_GT(static_cast<double>(covered) / (m * m * m), smaller.volume());
  EXPECT_LT(static_cast<double>(covered) / (m * m * m), larger.volume());
}

// Two spheroids that keep their speed cross some cells of a fluid at another: with the classical exchange the fluid
// loses what links and covered cells say and gains what refilled ones bring, whatever the shape. Left over is
// round-off: 2^-45 a link of fewer than 2000, and of the sum over all cells 2^-37 each.
TEST(AnyShape, TakesFromTheFluidTheMomentumThatItsLinksSay) {
  WaterBox box;
  box.cells = {32, 20, 20};
  box.viscosity = 3e-4;
  box.smagorinsky_constant = 0.0;
  box.fluid_velocity = Vec3(0.1, -0.05, 0.0);
  box.links.momentum_exchange = lbm::MomentumExchange::classical;
  box.refill = RefillRule::grad;
  box.seeds = {glass_sphere(0, Vec3(1.3e-3, 7.9e-3, 8.2e-3), Vec3(0.4, 0.15, -0.1)),
               glass_sphere(1, Vec3(13.1e-3, 8.8e-3, 1.2e-3), Vec3(-0.3, 0.2, 0.1))};
  for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
  const auto system = make_system<double, Spheroid>(box, MPI_COMM_WORLD,
                                                    Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  const Vec3 before = system->fluid().totals().momentum;
  constexpr int steps = 60;
  Vec3 expected = before;
  std::int64_t changed = 0;
  double turned_over = 0.0;
  for (int step = 0; step < steps; ++step) {
    system->advance();
    const ExchangeTotals& t = system->step_totals();
    for (int a = 0; a < 3; ++a) {
      expected[a] += sum_over_ranks(MPI_COMM_WORLD, t.refilled[a] - t.covered[a] - t.link_momentum[a]);
      turned_over += sum_over_ranks(MPI_COMM_WORLD, std::abs(t.link_momentum[a]));
    }
    changed += t.refilled_mass != 0;
  }
  const double cells = 32.0 * 20.0 * 20.0, round_off = steps * 2000 * 0x1p-45 + 2.0 * cells * 0x1p-37;
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(system->fluid().totals().momentum[a], expected[a], round_off);
  EXPECT_GT(turned_over, 1e6 * round_off);
  EXPECT_GT(sum_over_ranks(MPI_COMM_WORLD, changed), steps / 2);
}

// Two equal spheroids touch at a place off their axes, in a fluid at rest of uniform excess density. The links alone
// turn each about that place; with the patches that they hide from each other nothing is left of the force but the
// round-off of fewer than 2000 links, and of the torque what comes of the patch's middle, which the lattice knows to
// half the diagonal of a cell, against the lever of the normal there.
TEST(AnyShape, UniformPressureNeitherMovesNorTurnsATouchingPair) {
  constexpr double density = 0.01;
  const Index3 cells{60, 28, 40};
  const Decomposition decomposition(cells, 1.0, {true, true, true}, {1, 1, 1});
  const PeriodicBox box{Vec3(cells[0], cells[1], cells[2]), {true, true, true}};
  const Spheroid shape = Spheroid::of_grain(8.0);
  const Vec3 contact = std::sqrt(0.5) * Vec3(shape.a, 0.0, shape.b);  // from the first centre
  const double lever = contact.cross(shape.outward(contact).normalized()).norm();
  for (int place = 0; place < 8; ++place) {
    lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, {}, {});
    fluid.initialise([](const Vec3&) { return lbm::FluidState{density, Vec3::Zero()}; });
    fluid.exchange_halo();
    GrainMap<Spheroid> map(decomposition, fluid.block(), fluid.cells());
    lbm::LinkTable table(fluid.tiles().count());
    LinkBuilder builder(decomposition, fluid.block(), fluid.cells(), fluid.tiles());
    std::vector<lbm::LinkBody> bodies(2);
    map.begin_update();
    for (std::size_t body = 0; body < 2; ++body) {
      bodies[body].centre =
          Vec3(18.1, 14.2, 14.3) + 0.13 * place * Vec3(1.0, 0.7, -0.9) + 2.0 * static_cast<double>(body) * contact;
      map.place(map.add(static_cast<GlobalId>(body), shape), bodies[body].centre);
    }
    map.settle();
    builder.update(map, table);
    const lbm::LinkOptions options;
    lbm::LinkPass pass(fluid, table, box, options, bodies, map.shapes());
    for (int tile = 0; tile < fluid.tiles().count(); ++tile) pass.apply_tile(tile);
    const double by_links[2] = {bodies[0].torque.to_vec3().norm(), bodies[1].torque.to_vec3().norm()};
    map.hidden_patches().apply(map.grains(), map.shapes(), {density, density}, 0.0, bodies, nullptr);
    for (std::size_t body = 0; body < 2; ++body) {
      EXPECT_LT(bodies[body].force.to_vec3().norm(), 2000 * 0x1p-45);
      EXPECT_LT(bodies[body].torque.to_vec3().norm(), 0.5 * std::sqrt(3.0) / lever * by_links[body]);
      EXPECT_GT(by_links[body], 2.0 * density * lever);  // a sixth of six hidden cells or more
    }
  }
}

// R_h of F = 6 pi mu R_h U of a prolate spheroid alone in Stokes flow (Oberbeck 1876; Happel and Brenner 1983, eq.
// 5-11.18 and table 5-11.1).
double stokes_radius(const Spheroid& s, bool along) {
  const double e = std::sqrt(1.0 - s.b * s.b / (s.a * s.a)), log = std::log((1.0 + e) / (1.0 - e));
  return s.a * (along ? 8.0 / 3.0 * e * e * e / ((1.0 + e * e) * log - 2.0 * e)
                      : 16.0 / 3.0 * e * e * e / ((3.0 * e * e - 1.0) * log + 2.0 * e));
}

// Drag over that of Stokes, on a cubic array of spheroids of 7 by 14 cells in a periodic box.
double drag_factor(bool along) {
  constexpr double diameter = 9.0, tau = 0.9;  // of the sphere of the same volume
  WaterBox box;
  box.cells = {48, 48, 48};
  const double side = box.cells[0], volume = side * side * side;
  const Units units{box.spacing, box.time_step, 1000.0};
  const double nu = (tau - 0.5) / 3.0, force = 1e-6;
  box.viscosity = nu * box.spacing * box.spacing / box.time_step;
  box.smagorinsky_constant = 0.0;
  box.collision = lbm::CollisionModel::trt;
  const Spheroid shape = Spheroid::of_grain(0.5 * diameter);
  const double radius = stokes_radius(shape, along), fraction = shape.volume() / volume;
  // Hasimoto (1959): exact to the order of R_h/L; the next, the solid fraction, is that of a sphere.
  const double expected = 1.0 / (1.0 - 2.8373 * radius / side + fraction);
  const int axis = along ? 0 : 1;
  // The mean flow would take 7000 steps to settle, the flow around the body 400: begin with what is expected.
  box.gravity[axis] = force * units.acceleration();
  const double superficial = force * volume / (6.0 * std::numbers::pi * nu * radius * expected);
  box.fluid_velocity[axis] = superficial * units.velocity();
  box.seeds = {glass_sphere(0, Vec3(24.21, 23.66, 24.08) * box.spacing, Vec3::Zero(), 0.5 * diameter * box.spacing)};
  box.seeds[0].motion = dem::Motion::fixed;
  const auto system = make_system<double, Spheroid>(box, MPI_COMM_WORLD,
                                                    Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int step = 0; step < 2000; ++step) system->advance();
  const lbm::FluidTotals totals = system->fluid().totals();
  const double mean = (totals.momentum[axis] - 0.5 * force * static_cast<double>(totals.cells)) / volume;
  const double drag = sum_over_ranks(MPI_COMM_WORLD, system->step_totals().link_momentum[axis]);
  // The driving force stands for a pressure gradient, which would push on the body's volume too.
  return (drag + force * shape.volume()) / (6.0 * std::numbers::pi * nu * radius * mean) / expected;
}

// Interpolated links give a sphere of 10 cells 1 to 2.5 % too little drag here (static_solids_test.cpp), mostly as if
// it were smaller by a fraction of a cell; the spheroid is 7 cells across. The order of the solid fraction, 0.35 %,
// counts differently along the axes of a spheroid. A sphere of the same volume would have 1.05 times the drag along and
// 0.91 times that across; of the ratio of the two, 1.15 alone in the fluid, most errors drop out.
TEST(AnyShape, ASpheroidHasTheStokesDragOfTheClosedForm) {
  const double along = drag_factor(true), across = drag_factor(false);
  EXPECT_NEAR(along, 1.0, 0.03);
  EXPECT_NEAR(across, 1.0, 0.03);
  EXPECT_NEAR(across / along, 1.0, 0.015);
}

}  // namespace
}  // namespace thalweg::coupling::shape_test
