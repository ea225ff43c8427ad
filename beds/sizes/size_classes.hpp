// Size classes of grains, between edges in the manner of sieves: grains of a class pass its upper edge but not its
// lower one.
#pragma once

#include "beds/sizes/size_distribution.hpp"

#include <span>
#include <vector>

namespace thalweg::beds {

// Edges (m, rising) of the classes that suit grains of these sizes (rising, at least one), all of which they cover:
//
//   - sieves (m, in any order), where there are some and they do;
//   - around each size, with edges half-way in ln d, where there are no more than ten sizes;
//   - otherwise the widest of 1/2, 1/4 and 1/8 phi that makes four classes, or 1 phi where 1/2 makes more than twelve,
//     with edges at 2^(n phi) mm.
std::vector<double> size_class_edges(std::span<const SizeCount> sizes, std::vector<double> sieves);

}  // namespace thalweg::beds
