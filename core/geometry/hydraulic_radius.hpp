// Hydraulic radius of a rectangular channel: cross-section over the perimeter that exerts drag, R = H W/(W + n H).
#pragma once

namespace thalweg {

// m. depth, width: m; side_walls: number of side walls that exert drag, 0 to 2; the bed always does.
inline double hydraulic_radius(double depth, double width, int side_walls) {
  return depth * width / (width + side_walls * depth);
}

}  // namespace thalweg
