// A contact law as a contributor would add it: what the compiler checks of it, and the motion that theory gives.
#include "tests/dem/laws/with_adhesion.hpp"

#include "dem/contact/contact_kernel.hpp"
#include "dem/laws/contact_laws.hpp"
#include "dem/motion/grain_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg::dem::with_adhesion_test {
namespace {

using Springs = SpringDashpotFriction<NoFilm>;
using Sticky = WithAdhesion<Springs>;

// It adds to any law, and any law adds to it.
static_assert(IsContactLaw<Sticky> && IsContactLaw<WithAdhesion<HertzMindlinFriction<ContactFilm>>>);
static_assert(IsContactLaw<WithAdhesion<WithLiquidBridge<Springs>>> && IsContactLaw<WithLiquidBridge<Sticky>>);
static_assert(IsContactLaw<AtSurface<WithAdhesion<WithRollingFriction<Springs>>>>);

// A class whose history is longer than the parts that it names is no law.
struct Nameless : Sticky {
  using History = std::array<double, 4>;
};
static_assert(!IsContactLaw<Nameless>);

constexpr double radius = 1e-3, mass = 1e-5, stiffness = 200.0, work = 0.5;  // m, kg, N/m, J/m^2

// Two equal spheres at the overlap at which the law has no force, which part at a speed (m/s). With their effective
// mass m* = m/2 they swing about it at omega = sqrt(k/m*), as long as they touch.
class Pair {
public:
  static inline const double omega = std::sqrt(2.0 * stiffness / mass);
  static inline const double balance = std::numbers::pi * radius * work / stiffness;  // m, 2 pi R w/k with R = radius/2

  explicit Pair(double speed) {
    GrainStore store;
    for (int n = 0; n < 2; ++n) {
      const double sign = n == 0 ? -1.0 : 1.0;
      store.append(n, radius, mass, Motion::free, Vec3(0.01 + sign * (radius - 0.5 * balance), 0.01, 0.01));
      store.velocity.back().x() = 0.5 * sign * speed;
    }
    store.owned = 2;
    grains_.gather_from(store, std::vector<Vec3>(2, Vec3::Zero()));
    evaluate(0.0);
  }

  void advance(double time_step) {
    grains_.half_kick(time_step);
    grains_.drift(time_step);
    evaluate(time_step);
    grains_.half_kick(time_step);
  }

  double overlap() const { return 2.0 * radius - (grains_[1].position[0] - grains_[0].position[0]); }
  double speed() const { return grains_[1].velocity[0] - grains_[0].velocity[0]; }  // at which they part

private:
  static ContactParameters contact() {
    ContactParameters parameters;
    parameters.normal_stiffness = stiffness;
    parameters.restitution = 1.0;
    return parameters;
  }

  void evaluate(double time_step) {
    const std::vector<std::uint8_t> material(2, 0);
    ContactKernel<Sticky> kernel(Sticky(Springs(contact(), time_step), work), grains_,
                                 reinterpret_cast<double*>(row_.data()), box_, table_, material);
    const NearPair pair{0, 1, 0};
    kernel.evaluate({&pair, 1}, {});
  }

  PeriodicBox box_{Vec3(0.02, 0.02, 0.02), {false, false, false}};
  MaterialTable table_{std::vector{contact()}, std::nullopt};
  std::vector<Double4> row_{ContactRows::width_of<Sticky> / 4, Double4{}};
  PackedGrainState grains_;
};

// Energy: below balance omega the pair cannot part; it swings with the amplitude v/omega.
TEST(WithAdhesion, HoldsAPairThatPartsTooSlowly) {
  const double speed = 0.9 * Pair::balance * Pair::omega, step = 2.0 * std::numbers::pi / Pair::omega / 2000.0;
  Pair pair(speed);
  double least = Pair::balance, most = Pair::balance;
  for (int n = 0; n < 3 * 2000; ++n) {
    pair.advance(step);
    least = std::min(least, pair.overlap()), most = std::max(most, pair.overlap());
  }
  EXPECT_NEAR(least / Pair::balance, 0.1, 1e-4);
  EXPECT_NEAR(most / Pair::balance, 1.9, 1e-4);
  EXPECT_NEAR(pair.overlap() / Pair::balance, 1.0, 1e-3);  // after three periods
  EXPECT_NEAR(pair.speed() / speed, 1.0, 1e-3);
}

// v_out^2 = v^2 - (balance omega)^2: at 5/4 of the least speed a pair keeps 3/4 of it. The force ends within a step of
// the surfaces, which is 1e-3 of the energy here.
TEST(WithAdhesion, CostsAPairThatPartsItsWork) {
  const double least = Pair::balance * Pair::omega, step = 2.0 * std::numbers::pi / Pair::omega / 20000.0;
  Pair pair(1.25 * least);
  for (int n = 0; n < 20000 && pair.overlap() > -0.1 * Pair::balance; ++n) pair.advance(step);
  EXPECT_LT(pair.overlap(), 0.0);
  EXPECT_NEAR(pair.speed() / least, 0.75, 1e-3);
}

}  // namespace
}  // namespace thalweg::dem::with_adhesion_test
