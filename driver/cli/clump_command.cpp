#include "driver/cli/clump_command.hpp"

#include "beds/shapes/mesh_clump.hpp"
#include "beds/shapes/shape_figures.hpp"
#include "core/base/error.hpp"
#include "core/geometry/symmetric_pairs.hpp"
#include "dem/clumps/clump_of_body.hpp"
#include "driver/cli/python_command.hpp"
#include "io/files/atomic_file.hpp"
#include "io/text/section_writer.hpp"
#include "io/text/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace thalweg::driver {
namespace {

std::string line(const char* what, const std::string& figures) { return fmt::format("  {:<24}{}", what, figures); }

std::string file_without_ending(const ClumpOrder& order) {
  return order.out.empty() ? std::filesystem::path(order.surface).stem().string() + "_clump" : order.out;
}

constexpr const char* head_of_shape = "shape:\n";

// A shape of before is replaced; a case or anything else is its owner's.
void refuse_other_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !io::read_text(path).starts_with(head_of_shape))
    throw InputError(fmt::format("{} exists and is not the shape of a grain: give another name with --out.", path));
}

std::string vector_text(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

// The keys of a shape that needs no STL file any more, as a case keeps them.
std::string shape_yaml(const beds::MeshClump& clump) {
  std::string text = std::string(head_of_shape) + "  clump:\n";
  for (const dem::PlacedSphere& sphere : clump.spheres)
    text += fmt::format("    - {{position: {}, diameter: {}}}\n", vector_text(sphere.position), 2.0 * sphere.radius);
  std::string inertia;
  for (const auto& [row, column] : symmetric_pairs)
    inertia += fmt::format("{}{}", inertia.empty() ? "" : ", ", clump.body.inertia(row, column));
  return text + fmt::format("  body:\n    volume: {}\n    centre: {}\n    inertia: [{}]\n", clump.body.volume,
                            vector_text(clump.body.centre), inertia);
}

std::vector<std::string> lines_of_surface(const ClumpOrder& order, const TriangleMesh& mesh,
                                          const beds::MeshClump& clump) {
  const beds::ShapeFigures shape = beds::shape_figures(mesh);
  const Vec3 moments = order.density * clump_shape(clump.spheres, clump.body).moments;
  return {fmt::format("{}: {} triangles", order.surface, mesh.triangles.size()),
          line("volume",
               fmt::format("{:.5g} m^3, that of a sphere of {:.4g} m", clump.body.volume, clump.equivalent_diameter)),
          line("axes", fmt::format("{:.4g}, {:.4g}, {:.4g} m, of the ellipsoid with its moments of inertia",
                                   shape.axes[0], shape.axes[1], shape.axes[2])),
          line("sphericity", fmt::format("{:.3f}", shape.sphericity)),
          line("Corey shape factor", fmt::format("{:.3f}", shape.corey)),
          line("mass", fmt::format("{:.5g} kg at {:g} kg/m^3", order.density * clump.body.volume, order.density)),
          line("moments of inertia", fmt::format("{:.4g}, {:.4g}, {:.4g} kg m^2", moments[0], moments[1], moments[2]))};
}

std::vector<std::string> lines_of_clump(const TriangleMesh& mesh, const beds::MeshClump& clump) {
  const beds::FitFigures fit = beds::fit_figures(mesh, clump);
  const auto [smallest, largest] = std::minmax_element(
      clump.spheres.begin(), clump.spheres.end(), [](const auto& a, const auto& b) { return a.radius < b.radius; });
  const auto percent = [](double share) { return 100.0 * share; };
  const Vec3 moments = percent(1.0) * fit.moment_errors;
  return {fmt::format("clump of {} spheres, {:.4g} to {:.4g} m wide", clump.spheres.size(), 2.0 * smallest->radius,
                      2.0 * largest->radius),
          line("volume", fmt::format("{:.2f} % in the inscribed spheres; all of it with radii {:.3g} m larger",
                                     percent(fit.inscribed_volume), clump.growth)),
          line("moments of inertia", fmt::format("{:+.2f}, {:+.2f}, {:+.2f} % in the union of spheres; the grain moves "
                                                 "with those of the surface",
                                                 moments[0], moments[1], moments[2])),
          line("surface to clump", fmt::format("{:.2f} % of the equivalent diameter on average, {:.2f} % at most",
                                               percent(fit.mean_to_clump), percent(fit.largest_to_clump))),
          line("clump to surface", fmt::format("{:.2f} % on average, {:.2f} % at most", percent(fit.mean_to_surface),
                                               percent(fit.largest_to_surface))),
          line("curvature", fmt::format("{:.2f} of the surface on average, {:.2f} of the spheres (1: of the sphere of "
                                        "its volume)",
                                        beds::shape_figures(mesh).curvature, fit.curvature))};
}

}  // namespace

std::vector<std::string> clump_report(const ClumpOrder& order) {
  const std::string out = file_without_ending(order);
  refuse_other_file(out + ".yaml");
  TriangleMesh mesh = io::read_stl(order.surface);
  for (Vec3& point : mesh.points) point *= order.scale;
  beds::MeshClump clump;
  try {
    clump = beds::clump_of(mesh, {order.spheres, order.tolerance});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", order.surface, error.what()));
  }
  std::vector<std::string> lines = lines_of_surface(order, mesh, clump);
  const std::vector<std::string> of_clump = lines_of_clump(mesh, clump);
  lines.insert(lines.end(), of_clump.begin(), of_clump.end());
  std::error_code ignored;  // writing says what is wrong
  if (const auto folder = std::filesystem::path(out).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, ignored);
  io::write_text_atomically(out + ".yaml", shape_yaml(clump));
  std::string keys = fmt::format("stl: {}", io::yaml_text(order.surface));
  if (order.spheres) keys += fmt::format(", spheres: {}", *order.spheres);
  if (order.tolerance) keys += fmt::format(", tolerance: {}", io::shortest(*order.tolerance));
  if (order.scale != 1.0) keys += fmt::format(", scale: {}", io::shortest(order.scale));
  lines.insert(lines.end(), {"in a case", "  grains:", fmt::format("    - shape: {{{}}}", keys),
                             fmt::format("      density: {}", io::shortest(order.density)), "      count: 100",
                             fmt::format("or, without the STL file, the keys in {}.yaml", out)});
  return lines;
}

void draw_clump(const ClumpOrder& order) {
  const std::string out = file_without_ending(order);
  std::vector<std::string> words{"thalweg",
                                 "clump-picture",
                                 order.surface,
                                 out + ".yaml",
                                 out + ".png",
                                 "--scale",
                                 fmt::format("{}", order.scale)};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  run_python_command(static_cast<int>(argv.size()), argv.data());
  throw InputError(fmt::format("{}.png was not drawn; {}.yaml is complete.", out, out));
}

}  // namespace thalweg::driver
