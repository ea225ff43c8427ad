// Spheres inscribed in a closed triangle surface, one after the other, each the one that wins the most volume.
//
// Candidates are the nodes of a cubic grid inside the surface, each with its exact distance from the surface as radius.
// The next sphere is the one that holds the most nodes that no earlier one holds. What a sphere wins can only become
// less as others are added, so that a heap of earlier figures gives the exact maximum with few evaluations. The chosen
// centre then moves within one spacing of the grid to where the distance is largest. SI units. The same surface gives
// the same bits.
#pragma once

#include "beds/shapes/mesh_distance.hpp"
#include "core/geometry/triangle_mesh.hpp"
#include "dem/clumps/placed_sphere.hpp"

#include <cstdint>
#include <queue>
#include <vector>

namespace thalweg::beds {

class InscribedSpheres {
public:
  static constexpr int resolution = 64;  // spacings of the grid along the longest extent of the surface

  // A surface that is closed and wound outwards. centre: m, a node of the grid. Throws InputError where the surface
  // crosses itself, as far as lines through the nodes show.
  InscribedSpheres(const TriangleMesh& mesh, const MeshDistance& distance, const Vec3& centre);

  // Adds the next sphere to the list. False: no node is left.
  bool add(std::vector<dem::PlacedSphere>& spheres);

private:
  struct Candidate {
    std::int64_t won;   // nodes
    float radius;       // m; among equals the larger sphere first
    std::int64_t node;  // and then the first node
    bool operator<(const Candidate& other) const {
      if (won != other.won) return won < other.won;
      if (radius != other.radius) return radius < other.radius;
      return node > other.node;
    }
  };

  void find_inside(const TriangleMesh& mesh, std::vector<char>& inside) const;
  Vec3 place(std::int64_t node) const;
  template <typename Visit>
  void for_each_row(const dem::PlacedSphere& sphere, Visit visit) const;
  std::int64_t won_by(const dem::PlacedSphere& sphere) const;
  void cover(const dem::PlacedSphere& sphere);
  dem::PlacedSphere grown(dem::PlacedSphere sphere) const;

  const MeshDistance& distance_;
  double spacing_ = 0.0;
  Vec3 origin_ = Vec3::Zero();
  Index3 nodes_{1, 1, 1};
  std::vector<std::int32_t> left_;  // nodes of a row, below each place, that no sphere holds: nodes + 1 numbers a row
  std::priority_queue<Candidate> candidates_;
};

}  // namespace thalweg::beds
