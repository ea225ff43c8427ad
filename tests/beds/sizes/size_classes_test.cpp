#include "beds/sizes/size_classes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::beds::size_classes_test {
namespace {

// Sizes from the smallest to the largest, evenly in ln d.
std::vector<SizeCount> graded(double smallest, double largest, int count) {
  std::vector<SizeCount> sizes;
  for (int n = 0; n < count; ++n) sizes.push_back({smallest * std::pow(largest / smallest, n / (count - 1.0)), 1});
  return sizes;
}

void expect_edges(const std::vector<double>& edges, const std::vector<double>& wanted) {
  ASSERT_EQ(edges.size(), wanted.size());
  for (std::size_t n = 0; n < edges.size(); ++n) EXPECT_NEAR(edges[n], wanted[n], 1e-12 * wanted[n]) << n;
}

// Sieves of two populations are joined, and one that both have counts once.
TEST(SizeClassEdges, AreTheSievesWhereTheseCoverTheGrains) {
  const std::vector<SizeCount> sizes = graded(2.1e-3, 15e-3, 100);
  expect_edges(size_class_edges(sizes, {4e-3, 8e-3, 16e-3, 2e-3, 4e-3, 6e-3}), {2e-3, 4e-3, 6e-3, 8e-3, 16e-3});
  // The finest grain falls through: half phi, from sqrt(2)^2 mm to sqrt(2)^8 mm.
  expect_edges(size_class_edges(sizes, {4e-3, 16e-3}),
               {2e-3, 2e-3 * std::sqrt(2.0), 4e-3, 4e-3 * std::sqrt(2.0), 8e-3, 8e-3 * std::sqrt(2.0), 16e-3});
}

TEST(SizeClassEdges, LieHalfWayBetweenAFewSizes) {
  expect_edges(size_class_edges(std::vector<SizeCount>{{1e-3, 5}, {4e-3, 2}, {16e-3, 1}}, {}),
               {0.5e-3, 2e-3, 8e-3, 32e-3});
  expect_edges(size_class_edges(std::vector<SizeCount>{{4e-3, 5}}, {}),
               {4e-3 * std::pow(2.0, -0.25), 4e-3 * std::pow(2.0, 0.25)});
}

// From 4.1 to 5.9 mm: four classes of an eighth phi where a quarter makes three; from 0.1 to 9 mm: one phi, where half
// a phi makes fourteen.
TEST(SizeClassEdges, AreAsWideAsTheRangeAsks) {
  const std::vector<double> narrow = size_class_edges(graded(4.1e-3, 5.9e-3, 50), {});
  expect_edges(narrow, {4e-3, 4e-3 * std::exp2(0.125), 4e-3 * std::exp2(0.25), 4e-3 * std::exp2(0.375),
                        4e-3 * std::exp2(0.5), 4e-3 * std::exp2(0.625)});
  const std::vector<double> wide = size_class_edges(graded(0.1e-3, 9e-3, 50), {});
  expect_edges(wide, {62.5e-6, 125e-6, 250e-6, 0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3, 16e-3});
}

}  // namespace
}  // namespace thalweg::beds::size_classes_test
