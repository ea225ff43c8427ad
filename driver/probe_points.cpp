#include "driver/probe_points.hpp"

#include <fmt/format.h>

namespace thalweg {

void describe(SectionVisitor& visit, ProbeLineCase& line) {
  visit.vec3("from", line.from, {.unit = "m"});
  visit.vec3("to", line.to, {.unit = "m"});
  visit.integer("points", line.points, {.meaning = "at equal distances, both ends included", .at_least = 2});
}

void describe(SectionVisitor& visit, ProbesCase& probes) {
  visit.vec3_list("points", probes.points, {.unit = "m", .meaning = "each stands for the cell that it lies in"});
  visit.list("lines", probes.lines, {.meaning = "rows of points"});
  visit.real("every", probes.every, {.unit = "s", .meaning = "between measurements", .above = 0.0});
}

namespace {

void check_point(const Case& c, const io::YamlDocument& document, const std::string& place, const Vec3& point) {
  if ((point.array() >= 0.0).all() && (point.array() <= c.domain.size.array()).all()) return;
  throw document.error(place, fmt::format("the box goes from 0 to ({:g}, {:g}, {:g}) m; give a point in it",
                                          c.domain.size.x(), c.domain.size.y(), c.domain.size.z()));
}

}  // namespace

void check_probes(const Case& c, const io::YamlDocument& document) {
  if (!c.analysis.probes) return;
  const ProbesCase& probes = *c.analysis.probes;
  if (probes.points.empty() && probes.lines.empty())
    throw document.error("analysis.probes", "there is no point; give points, lines or both");
  for (std::size_t n = 0; n < probes.points.size(); ++n)
    check_point(c, document, fmt::format("analysis.probes.points.{}", n), probes.points[n]);
  for (std::size_t n = 0; n < probes.lines.size(); ++n) {
    check_point(c, document, fmt::format("analysis.probes.lines.{}.from", n), probes.lines[n].from);
    check_point(c, document, fmt::format("analysis.probes.lines.{}.to", n), probes.lines[n].to);
  }
}

std::vector<Vec3> probe_points(const ProbesCase& probes) {
  std::vector<Vec3> points = probes.points;
  for (const ProbeLineCase& line : probes.lines)
    for (std::int64_t n = 0; n < line.points; ++n)
      points.push_back(line.from +
                       (line.to - line.from) * (static_cast<double>(n) / static_cast<double>(line.points - 1)));
  return points;
}

}  // namespace thalweg
