#include "loop/location_text.hpp"

#include "core/parallel/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace thalweg::loop {

namespace {

constexpr double near_in_cells = 2.0;
constexpr std::size_t most_named = 4;

// Ids, ascending, of all grains with a surface near a position (m).
std::vector<GlobalId> grains_near(MPI_Comm communicator, const Vec3& position, const Snapshot& snapshot) {
  const PeriodicBox& box = snapshot.decomposition->box();
  const double reach = near_in_cells * snapshot.decomposition->spacing();
  std::vector<GlobalId> mine;
  for (std::size_t g = 0; g < snapshot.grains.id.size(); ++g)
    if (box.difference(snapshot.grains.position[g], position).norm() < snapshot.grains.radius[g] + reach)
      mine.push_back(snapshot.grains.id[g]);
  std::vector<GlobalId> all = Ranks(communicator).gathered(std::move(mine));
  std::sort(all.begin(), all.end());
  return all;
}

// "3", "3 and 7", "3, 7 and 12"
std::string listed(const std::vector<GlobalId>& ids) {
  std::string text;
  const std::size_t named = std::min(ids.size(), most_named);
  for (std::size_t n = 0; n < named; ++n)
    text += fmt::format("{}{}", n == 0 ? "" : n + 1 == named ? " and " : ", ", ids[n]);
  return text;
}

}  // namespace

std::string location_text(MPI_Comm communicator, const Location& location, const Snapshot& snapshot) {
  const std::string point =
      fmt::format("at ({:.6g}, {:.6g}, {:.6g}) m", location.position.x(), location.position.y(), location.position.z());
  if (!location.grains.empty())
    return fmt::format("grain{} {} {}", location.grains.size() > 1 ? "s" : "", listed(location.grains), point);
  std::string text = "in the cell " + point;
  if (snapshot.grains.global_count == 0) return text;
  const std::vector<GlobalId> near = grains_near(communicator, location.position, snapshot);
  if (near.empty()) return text + ", in open water";
  return text + (near.size() == 1 ? ", beside grain " : ", in the pore between grains ") + listed(near);
}

}  // namespace thalweg::loop
