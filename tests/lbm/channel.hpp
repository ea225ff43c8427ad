// Flow between two walls, uniform along them, run for so many steps: what the tests of walls look at.
#pragma once

#include "lbm/fluid/fluid.hpp"

#include <vector>

namespace thalweg::lbm {

struct Channel {
  int height = 0;                 // cells
  CollisionParameters collision;  // force[0]: along the flow, whatever its axis
  FaceCondition low, high;        // velocity[0]: along the flow, whatever its axis
  int normal = 1;                 // axis across the channel; the flow is along x (along y where x is the normal)
};

// Velocity along the flow in every cell across the channel.
inline std::vector<double> velocity_across(const Channel& channel, int steps, double initial_velocity = 0.0) {
  Index3 cells{4, 4, 4};
  cells[channel.normal] = channel.height;
  std::array<bool, 3> periodic{true, true, true};
  periodic[channel.normal] = false;
  const Decomposition decomposition(cells, 1.0, periodic, {1, 1, 1});
  const int along = channel.normal == 0 ? 1 : 0;
  CollisionParameters parameters = channel.collision;
  std::swap(parameters.force[0], parameters.force[along]);
  FaceConditions faces;
  faces[face_of(channel.normal, false)] = channel.low;
  faces[face_of(channel.normal, true)] = channel.high;
  for (FaceCondition& face : faces) std::swap(face.velocity[0], face.velocity[along]);
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  FluidState start;
  start.velocity[along] = initial_velocity;
  fluid.initialise([&](const Vec3&) { return start; });
  for (int step = 0; step < steps; ++step) fluid.advance();
  std::vector<double> velocity;
  for (int k = 0; k < channel.height; ++k) {
    Index3 at{1, 2, 1};
    at[channel.normal] = k;
    velocity.push_back(fluid.state_at(fluid.indexing().index(at[0], at[1], at[2])).velocity[along]);
  }
  return velocity;
}

}  // namespace thalweg::lbm
