// Layers of whole planes of cells, as equal as possible: the lattice has no finer plane on which its momentum balances.
#pragma once

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

class CellLayers {
public:
  // planes: of cells, bottom to top; spacing: m; thickness: m, wanted. Layers are of at least one plane, and differ by
  // one plane at most.
  CellLayers(int planes, double spacing, double thickness)
      : planes_(planes),
        spacing_(spacing),
        count_(std::clamp(static_cast<int>(std::lround(planes * spacing / thickness)), 1, planes)) {}

  int count() const { return count_; }
  int planes() const { return planes_; }
  int first_plane(int layer) const {  // for layer count() one past the last
    return static_cast<int>((2L * layer * planes_ + count_) / (2L * count_));
  }
  double bottom(int layer) const { return first_plane(layer) * spacing_; }  // m
  double height(int layer) const { return (first_plane(layer + 1) - first_plane(layer)) * spacing_; }
  double middle(int layer) const { return bottom(layer) + 0.5 * height(layer); }

  // The layer a height (m) lies in; the lowest and the highest have no outer end.
  int at(double z) const {
    int layer = std::clamp(static_cast<int>(z / (planes_ * spacing_) * count_), 0, count_ - 1);
    while (layer > 0 && z < bottom(layer)) --layer;
    while (layer + 1 < count_ && z >= bottom(layer + 1)) ++layer;
    return layer;
  }

private:
  int planes_;
  double spacing_;
  int count_;
};

}  // namespace thalweg::analysis
