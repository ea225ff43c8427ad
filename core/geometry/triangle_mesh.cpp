#include "core/geometry/triangle_mesh.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace thalweg {

std::string what_is_open(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "it has no triangles";
  std::map<std::pair<int, int>, int> uses;  // of each edge, by direction
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  int alone = 0, repeated = 0;
  for (const auto& [edge, count] : uses) {
    if (count > 1) ++repeated;
    if (uses.find({edge.second, edge.first}) == uses.end()) ++alone;
  }
  if (repeated > 0) return fmt::format("{} edges belong to triangles that disagree on which side is out", repeated);
  if (alone > 0) return fmt::format("{} edges belong to one triangle only", alone);
  return "";
}

double signed_volume(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (const auto& t : mesh.triangles) six_volumes += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]]));
  return six_volumes / 6.0;
}

void turn_inside_out(TriangleMesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace thalweg
