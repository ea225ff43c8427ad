// Gradings of grains by size classes, between edges in the manner of sieves: a class has the sizes from its lower edge
// to just below its upper one.
//
// Each class is divided into narrow bins, all alike in ln d, so that a median is that of the grains and not of a line
// drawn between the edges: the mean size of the bin in which a share of one half is reached. Its error is below a bin,
// two per cent of a class's width; with a few single sizes there is none.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace thalweg::analysis {

class SizeClasses {
public:
  static constexpr int bins_a_class = 50;

  explicit SizeClasses(std::vector<double> edges) : edges_(std::move(edges)) {}  // m, rising, at least two

  std::size_t count() const { return edges_.size() - 1; }
  const std::vector<double>& edges() const { return edges_; }  // m
  double middle(std::size_t size_class) const;                 // m, geometric mean of its edges
  int bins() const { return static_cast<int>(count()) * bins_a_class; }
  // The bin of a diameter (m). What is finer than the first edge belongs to the first class, and what is coarser than
  // the last to the last.
  int bin_of(double diameter) const;

  // Sums over the bins of each class.
  std::vector<double> by_class(std::span<const double> of_bins) const;

private:
  std::vector<double> edges_;
};

// The diameter at which half of all is reached, by shares and diameters (m) of bins, finest first. Shares need not add
// up to 1. Not a number where their sum is not positive.
double median_diameter(std::span<const double> shares, std::span<const double> diameters);

}  // namespace thalweg::analysis
