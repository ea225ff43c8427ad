// The stress on a bed in resolved flows: with obstacles in the bed, and as two analyses have it.
#include "analysis/observers/bed_surface.hpp"
#include "analysis/tools/sphere_in_layer.hpp"
#include "tests/analysis/balanced_box.hpp"
#include "tests/analysis/made_up_grains.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg::analysis::bed_stress_test {
namespace {

// A slow flow of a viscous fluid over a sheet of held spheres of six cells.
struct Bed {
  WaterBox box;
  double d;  // m, of a sphere
  BedObstacles obstacles = {};

  explicit Bed(const Index3& cells, double diameter = 3e-3) : d(diameter) {
    box.cells = cells;
    box.periodic = {true, true, false};
    box.spacing = d / 6.0;
    box.viscosity = 1.0 / 3.0 * box.spacing * box.spacing / box.time_step;  // tau = 1.5
    box.smagorinsky_constant = 0.0;
    box.collision = lbm::CollisionModel::trt;
    box.links.rule = bodies::LinkRule::cli;
  }

  // Room for a sphere is left free.
  void add_sheet(const Vec3& centre = Vec3::Zero(), double radius = 0.0) {
    for (int x = 0; x < box.cells[0] / 6; ++x)
      for (int y = 0; y < box.cells[1] / 6; ++y) {
        const Vec3 place((x + 0.5) * d, (y + 0.5) * d, 0.5 * d);
        if ((place - centre).norm() > 1.01 * (radius + 0.5 * d)) add_sphere(place, 0.5 * d);
      }
  }

  void add_sphere(const Vec3& centre, double radius) {
    box.seeds.push_back(glass_sphere(static_cast<GlobalId>(box.seeds.size()), centre, Vec3::Zero(), radius));
    box.seeds.back().motion = dem::Motion::fixed;
  }

  GlobalId count() const { return static_cast<GlobalId>(box.seeds.size()); }
  double plan() const { return box.cells[0] * box.cells[1] * box.spacing * box.spacing; }

  BedSurface surface(MPI_Comm communicator) const {
    const PeriodicBox periodic{Vec3(box.cells[0], box.cells[1], box.cells[2]) * box.spacing, box.periodic};
    return BedSurface(communicator, periodic, {0.0, 1e-4, d, d / 25.0, 0.5}, d, BedFlow{0, 0.0, 1.0, true, true}, 0.0,
                      obstacles);
  }
};

void advance(LatticeSystem<double>& system, int steps) {
  for (int step = 0; step < steps; ++step) system.advance();
}

void record(LatticeSystem<double>& system) {
  system.record_momentum();
  system.measure_grain_stress();
  system.advance();
}

// A boulder 2.5 times as large as the spheres of the bed, as a solid or as a held sphere.
struct BoulderBed : Bed {
  BoulderBed(double height, bool is_solid) : Bed({30, 30, 24}) {
    const double radius = 1.25 * d;
    const Vec3 centre(2.5 * d, 2.5 * d, height);
    box.gravity = Vec3(0.05, 0.0, -9.8);
    add_sheet(centre, radius);
    if (is_solid) {
      box.solids = {bodies::SolidSphere{centre, radius}};
      obstacles.solids_below = [top = 4.0 * d, lowest = height - radius, radius](int layers) {
        std::vector<double> below;
        for (int k = 0; k <= layers; ++k)
          below.push_back(sphere_volume_below(radius, top * k / layers - lowest) -
                          sphere_volume_below(radius, -lowest));
        return below;
      };
    } else {
      box.obstacles = obstacles.spheres = {count()};
      add_sphere(centre, radius);
    }
  }
};

struct BedValues {
  double height, stress;  // m, Pa
};

BedValues measured(const BoulderBed& bed, MPI_Comm communicator) {
  const auto system =
      make_system<double>(bed.box, communicator, Decomposition::best_layout(bed.box.cells, size_of(communicator)));
  BedSurface surface = bed.surface(communicator);
  advance(*system, 700);  // T of the decay to the steady flow
  record(*system);
  surface.observe(system->snapshot());
  return {value_of(surface.diagnostics(), "bed_height"), value_of(surface.diagnostics(), "bed_stress")};
}

// The same cells and links at the same places, so that the flows differ by the mass alone that a held sphere returns to
// its links and a solid at rest does not: by less than 1e-4 of its density. The two volumes above the bed differ by no
// more than the cross-sections of spheres in the middle of thin layers do, 1e-3. By its middle, all or nothing, the
// boulder was off by what it takes on one side of the surface, tens of per cent.
TEST(BedStress, OfAnObstacleIsThatOfTheSameSolid) {
  for (const double height : {2.2e-3, 3.2e-3}) {
    const BedValues solid = measured(BoulderBed(height, true), MPI_COMM_WORLD);
    const BedValues sphere = measured(BoulderBed(height, false), MPI_COMM_WORLD);
    EXPECT_NEAR(sphere.height, solid.height, 1e-3 * solid.height);
    EXPECT_EQ(height > sphere.height, height == 3.2e-3);
    EXPECT_NEAR(sphere.stress / solid.stress, 1.0, 2e-3) << height;
    const double depth = 12e-3 - sphere.height;
    EXPECT_LT(sphere.stress, 0.9 * 1000.0 * 0.05 * depth);  // the boulder takes a good part
  }
}

TEST(BedStress, OfAnObstacleHasTheSameBitsOnAnyRanks) {
  const BoulderBed bed(2.2e-3, false);
  const BedValues dealt = measured(bed, MPI_COMM_WORLD), alone = measured(bed, MPI_COMM_SELF);
  EXPECT_EQ(dealt.height, alone.height);
  EXPECT_EQ(dealt.stress, alone.stress);
}

// m^3, of what grains of the bed cover above a height (m).
double covered_above(double height, const WaterBox& box, const MomentumBudget& budget) {
  const auto cells = static_cast<std::int64_t>(box.cells[0]) * box.cells[1];
  std::int64_t covered = 0;
  for (auto z = static_cast<std::size_t>(std::lround(height / box.spacing)); z < budget.planes.size(); ++z)
    covered += cells - budget.planes[z].cells;
  return static_cast<double>(covered) * std::pow(box.spacing, 3);
}

// N, along x, on obstacles above one height (m) and not above the other, negative if that is the lower one.
double taken_between(double one, double other, const WaterBox& box, const MomentumBudget& budget) {
  double taken = 0.0;
  for (std::size_t h = 0; h < budget.on_obstacles.size(); ++h) {
    const double height = 0.5 * static_cast<double>(h) * box.spacing - 1e-9 * box.spacing;
    taken += (static_cast<double>(height > one) - static_cast<double>(height > other)) * budget.on_obstacles[h].x();
  }
  return taken;
}

// Under a lid that slides and down a slope. The stress balance sums what drives the fluid over its cells above the top
// of a layer, the bed surface over the whole depth above its own height: they differ by the force on what the spheres
// cover above, and by that on the height between and what obstacles take there. The rest of a start at rest, after ten
// times H^2/(pi^2 nu) = 222 steps, is 5e-5. largest: difference in all, a share.
void expect_one_stress(const Bed& bed, double largest) {
  const auto system = system_of(bed.box);
  advance(*system, 2200);
  BedSurface surface = bed.surface(MPI_COMM_WORLD);
  const BalanceScales scales{1000.0, 1000.0 * bed.box.viscosity, bed.d,
                             [](double, double) { return Vec3(Vec3::Zero()); }, 1.0};
  StressBalance balance(MPI_COMM_WORLD, *system->snapshot().decomposition, 0.25 * bed.d, {0.0, 1e-4}, scales,
                        {{0, bed.count()}}, bed.obstacles.spheres);
  record(*system);
  const Snapshot snapshot = system->snapshot();
  surface.observe(snapshot);
  balance.observe(snapshot);
  const double of_surface = value_of(surface.diagnostics(), "bed_stress");
  const double height = value_of(surface.diagnostics(), "bed_height");
  const double of_balance = value_of(balance.results(), "bed_stress");
  const double top = value_of(balance.results(), "bed_height");
  EXPECT_NEAR(top, height, 0.3 * bed.d);
  const double room = bed.plan() * (top - height) + covered_above(top, bed.box, *snapshot.momentum);
  const double force = 1000.0 * bed.box.gravity.x();
  const double taken = taken_between(height, top, bed.box, *snapshot.momentum);
  const double expected = of_surface + (taken - force * room) / bed.plan();
  EXPECT_NEAR(of_balance, expected, 1e-4 * of_surface);
  EXPECT_NEAR(of_balance, of_surface, largest * of_surface);
}

Bed driven_bed(double pull) {
  Bed bed({18, 18, 27});
  bed.box.gravity = Vec3(pull, 0.0, -9.8);
  bed.box.plate_velocity = 0.01;
  bed.box.bottom_at_rest = true;
  return bed;
}

TEST(BedStress, OfStressBalanceAndBedSurfaceIsOne) {
  for (const double pull : {0.0, 0.05}) {
    Bed bed = driven_bed(pull);
    bed.add_sheet();
    expect_one_stress(bed, pull == 0.0 ? 1e-4 : 0.01);
  }
}

// The same under the lid alone with one half as large again, which is an obstacle: half a plane of cells of what the
// lid gives to it lies between the two heights.
TEST(BedStress, OfStressBalanceAndBedSurfaceIsOneBesideAnObstacle) {
  Bed bed = driven_bed(0.0);
  const double radius = 0.75 * bed.d;
  const Vec3 centre(1.5 * bed.d, 1.5 * bed.d, 1.1 * bed.d);
  bed.add_sheet(centre, radius);
  bed.box.obstacles = bed.obstacles.spheres = {bed.count()};
  bed.add_sphere(centre, radius);
  expect_one_stress(bed, 0.05);
}

}  // namespace
}  // namespace thalweg::analysis::bed_stress_test
