#include "bodies/mass_return.hpp"

#include "bodies/map/lattice_vectors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace thalweg::bodies::mass_return_test {
namespace {

using lbm::D3Q19;

struct Given {
  double mass = 0.0;
  Vec3 momentum = Vec3::Zero();  // along c_i, into the body
};

Given given_by(const MassReturn& r, const std::vector<int>& links) {
  Given given;
  for (const int i : links) {
    const double population = D3Q19::weight(i) * (r.density + r.slope.dot(velocity_of(i)));
    given.mass += population;
    given.momentum += population * velocity_of(i);
  }
  return given;
}

LinkSums sums_of(const std::vector<int>& links) {
  std::array<int, lbm::D3Q19::directions> by_direction{};
  for (const int i : links) ++by_direction[static_cast<std::size_t>(i)];
  return LinkSums::of(by_direction);
}

TEST(MassReturn, GivesTheMassAndNoMomentumWhateverIsHidden) {
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> direction(1, 18);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    std::vector<int> links;  // more on one side than on the other
    while (links.size() < 120)
      if (const int i = direction(generator); D3Q19::c[i][2] <= 0 || uniform(generator) < 0.4) links.push_back(i);
    const double mass = 0.02 * (uniform(generator) - 0.5);
    const MassReturn r = unit_mass_return(sums_of(links)).scaled(mass);
    const Given given = given_by(r, links);
    EXPECT_NEAR(given.mass, mass, 1e-15);
    EXPECT_NEAR(r.mass(sums_of(links)), mass, 1e-15);
    EXPECT_LT(given.momentum.norm(), 1e-15);
  }
}

// A body in a crevice, with a few links on one side: the mass comes back slowly, and never as a jet.
TEST(MassReturn, IsBoundedWhereThereAreHardlyAnyLinks) {
  for (const std::vector<int>& links : {std::vector<int>{5}, {5, 11, 14}, {1, 7, 9, 11, 13}}) {
    const MassReturn r = unit_mass_return(sums_of(links)).scaled(0.5);
    for (const int i : links) EXPECT_LE(std::abs(r.density + r.slope.dot(velocity_of(i))), 0.1);
    EXPECT_GT(given_by(r, links).mass, 0.0);
    EXPECT_LE(given_by(r, links).mass, 0.5);
  }
  EXPECT_EQ(unit_mass_return({}).scaled(0.5).density, 0.0);
}

// A body whose links lose a little in every step, and once a lot: the debt is settled, and the steady loss comes back
// in the step in which it occurs.
TEST(MassDebt, IsSettledWhateverTheLoss) {
  std::vector<int> links;
  for (int n = 0; n < 40; ++n)
    for (int i = 1; i < D3Q19::directions; ++i) links.push_back(i);
  const LinkSums sums = sums_of(links);
  MassDebt debt;
  MassReturn returned;
  double given_in_all = 0.0;
  for (int step = 0; step < 400; ++step) {
    const double came_back = returned.mass(sums), lost = 1e-3 + (step == 100 ? 0.05 : 0.0);
    given_in_all += came_back - lost;
    returned = debt.settle(came_back - lost, came_back, sums);
    EXPECT_NEAR(debt.owed, -given_in_all, 1e-14) << step;  // nothing is forgotten
  }
  EXPECT_NEAR(returned.mass(sums), 1e-3, 1e-9);
  EXPECT_NEAR(debt.owed, 0.0, 1e-9);
}

}  // namespace
}  // namespace thalweg::bodies::mass_return_test
