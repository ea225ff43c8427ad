#include "beds/sizes/size_classes.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::beds {

namespace {

constexpr std::size_t most_single_sizes = 10;
constexpr int fewest_classes = 4, most_classes = 12;
constexpr double millimetre = 1e-3;
constexpr double same_sieve = 1e-9;  // of a diameter: sieves as wide to rounding are one

std::vector<double> around_each(std::span<const SizeCount> sizes) {
  const double half_phi = std::sqrt(2.0);
  if (sizes.size() == 1)
    return {sizes.front().diameter / std::sqrt(half_phi), sizes.front().diameter * std::sqrt(half_phi)};
  std::vector<double> edges{0.0};
  for (std::size_t n = 1; n < sizes.size(); ++n) edges.push_back(std::sqrt(sizes[n - 1].diameter * sizes[n].diameter));
  edges.front() = sizes.front().diameter * sizes.front().diameter / edges[1];
  edges.push_back(sizes.back().diameter * sizes.back().diameter / edges.back());
  return edges;
}

// Edges at 2^(n phi) mm that cover the sizes from the smallest to the largest (m).
std::vector<double> by_phi(double phi, double smallest, double largest) {
  const int first = static_cast<int>(std::floor(std::log2(smallest / millimetre) / phi));
  std::vector<double> edges;
  for (int n = first; edges.size() < 2 || edges.back() < largest; ++n) edges.push_back(millimetre * std::exp2(n * phi));
  return edges;
}

std::vector<double> by_suitable_phi(double smallest, double largest) {
  const auto classes = [](const std::vector<double>& edges) { return static_cast<int>(edges.size()) - 1; };
  if (const auto half = by_phi(0.5, smallest, largest); classes(half) > most_classes)
    return by_phi(1.0, smallest, largest);
  for (const double phi : {0.5, 0.25})
    if (const auto edges = by_phi(phi, smallest, largest); classes(edges) >= fewest_classes) return edges;
  return by_phi(0.125, smallest, largest);
}

}  // namespace

std::vector<double> size_class_edges(std::span<const SizeCount> sizes, std::vector<double> sieves) {
  const double smallest = sizes.front().diameter, largest = sizes.back().diameter;
  std::sort(sieves.begin(), sieves.end());
  sieves.erase(
      std::unique(sieves.begin(), sieves.end(), [](double a, double b) { return b <= (1.0 + same_sieve) * a; }),
      sieves.end());
  if (sieves.size() >= 2 && sieves.front() <= smallest && sieves.back() >= largest) return sieves;
  if (sizes.size() <= most_single_sizes) return around_each(sizes);
  return by_suitable_phi(smallest, largest);
}

}  // namespace thalweg::beds
