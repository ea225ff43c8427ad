#include "driver/plan/check_report.hpp"

#include "beds/population/population_clumps.hpp"
#include "beds/population_rows.hpp"
#include "beds/supplies.hpp"
#include "core/base/error.hpp"
#include "dem/laws/contact_film.hpp"
#include "dem/laws/contact_laws.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/grain_seed.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/solid_cells.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/cost/disk_space.hpp"
#include "driver/cost/memory.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/contact_stiffness.hpp"
#include "driver/estimate/drag_accuracy.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/plan/flow_report.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/initial_state.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "io/files/json_object.hpp"
#include "loop/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

namespace thalweg::driver {

namespace {

using Lines = std::vector<std::string>;

void append(const Lines& more, Lines& lines) { lines.insert(lines.end(), more.begin(), more.end()); }

void add_domain(const Case& c, Lines& lines) {
  const Index3 n = cells_of(c.domain);
  lines.push_back(fmt::format("domain     {:g} x {:g} x {:g} m: {} x {} x {} cells of {:g} m", c.domain.size.x(),
                              c.domain.size.y(), c.domain.size.z(), n[0], n[1], n[2], c.domain.spacing));
}

// Damping in contacts of the lightest two grains of each population.
std::string damping_text(const Case& c) {
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  std::string text;
  for (std::size_t p = 0; p < c.grains.size(); ++p) {
    if (p > 0 && !c.grains[p].contact && c.grains[p].lightest_mass() == c.grains[0].lightest_mass()) continue;
    const dem::ContactParameters& material = materials[static_cast<std::size_t>(beds::material_of(c.grains, p))];
    const double damping = dem::Damping(material).coefficient(0.5 * c.grains[p].lightest_mass());
    text += fmt::format("{}{:.3g}", p > 0 ? ", " : "", damping);
  }
  return dem::with_spring_law(c.contact.law,
                              [&](auto spring) { return text + " " + decltype(spring)::type::damping_unit; });
}

std::string range_text(double least, double most) {
  const std::string low = fmt::format("{:.3g}", least), high = fmt::format("{:.3g}", most);
  return low == high ? low : low + " to " + high;
}

// Film between the lightest two free grains.
std::string film_text(const Case& c) {
  if (!(film_viscosity(c) > 0.0)) return {};
  double fastest = 0.0;
  for (const std::size_t p : free_populations(c))
    fastest = std::max(fastest, dem::film_speed(film_viscosity(c), 0.5 * c.grains[p].lightest_mass(),
                                                0.25 * c.grains[p].smallest_diameter()));
  return fmt::format(", and critical below {:.1g} m/s by the film", fastest);
}

// Restitution that follows from the damping.
std::string restitution_text(const Case& c) {
  const std::optional<DryRestitution> dry = dry_restitution(c);
  if (!dry) return {};
  return fmt::format(", dry restitution {} of two grains and {} of grain and wall", range_text(dry->least, dry->most),
                     range_text(dry->least_at_wall, dry->most_at_wall));
}

// Contact duration, and the stiffness derived from it if the case omits it.
std::string duration_text(const Case& c) {
  const double shortest = shortest_contact(c);
  if (!has_fluid(c) && !c.contact.given.duration) return fmt::format("lasts {:.3g} s", shortest);
  const bool by_duration = goes_by_duration(c);
  const double lasts = by_duration ? contact_duration(c) : shortest;
  std::string text = fmt::format("lasts {:.3g} s", lasts);
  if (has_fluid(c)) text += fmt::format(", {:.3g} fluid steps", lasts / fluid_time_step(c));
  if (by_duration)
    text += fmt::format(", by normal and tangential stiffnesses of {:.4g} and {:.4g} N/m", c.contact.normal_stiffness,
                        c.contact.tangential_stiffness);
  constexpr double rounding = 1e-9;
  if (const double steps = has_default_duration(c) ? default_contact_steps(c) : 0.0;
      steps > 0.0 && steps * fluid_time_step(c) > lasts * (1.0 + rounding))
    text += fmt::format(" (with {:.3g} steps overlaps would be too large)", steps);
  return text;
}

std::string contact_text(const Case& c) {
  const double step = grain_time_step(c);
  return fmt::format("{}: {:.3g} sub-steps of {:.3g} s (at least {:g}); damping {}{}{}", duration_text(c),
                     shortest_contact(c) / step, step, dem::fewest_steps_per_contact, damping_text(c), film_text(c),
                     restitution_text(c));
}

void add_overlaps(const Case& c, Lines& lines) {
  const Overlaps overlaps = expected_overlaps(c);
  if (c.system == SystemKind::model_fluid) return;  // its speeds are not those of a fall
  const std::string weight =
      overlaps.under_weight > 0.0
          ? fmt::format("{:.2g} % of a diameter under the weight of the bed, ", 100.0 * overlaps.under_weight)
          : std::string();
  lines.push_back(fmt::format("overlap    about {}{:.2g} % {}in an impact at {:.2g} m/s", weight,
                              100.0 * overlaps.in_impact, weight.empty() ? "of a diameter " : "", overlaps.speed));
}

std::string from_to(double smallest, double largest) {
  return smallest == largest ? fmt::format("{:g} m", smallest) : fmt::format("{:g} to {:g} m", smallest, largest);
}

std::string median_text(const beds::Population& population, bool mixed) {
  return mixed ? fmt::format(", median by mass {:g} m", population.diameter) : std::string();
}

// Clumps by the diameter of the sphere (disk) of their volume, spheres by their own.
std::string sizes_text(const beds::Population& population) {
  const double smallest = population.smallest_diameter(), largest = population.largest_diameter();
  if (!population.shape) {
    const std::string clumps =
        population.clumps.count > 0 ? fmt::format("({} of them clumps), ", population.clumps.count) : std::string();
    return clumps + "of " + from_to(smallest, largest) + median_text(population, smallest != largest);
  }
  const double finest = population.finest(), coarsest = population.coarsest();
  return fmt::format(
      "clumps of {} spheres of {}, by volume as large as {} of {}{}, up to {:.4g} m long{}",
      population.shape->clump.size(), from_to(smallest, largest), population.thickness > 0.0 ? "disks" : "spheres",
      from_to(finest, coarsest), median_text(population, finest != coarsest), population.clumps.largest_extent,
      population.thickness > 0.0
          ? std::string()
          : fmt::format("; intermediate axis {:.3g} of the size",
                        beds::clump_axes(*beds::clump_shape_of(population))[1] / population.shape_diameter));
}

void add_grains(const Case& c, Lines& lines) {
  for (const beds::Population& population : c.grains)
    lines.push_back(
        fmt::format("grains     {} {}, {:g} kg/m^3", population.count, sizes_text(population), population.density) +
        (has_fluid(c) ? fmt::format(": {:.3g} cells across {}", population.narrowest() / c.domain.spacing,
                                    population.clumps.count > 0 ? "the shortest axis" : "a diameter")
                      : ""));
  if (c.grains.empty()) return;
  lines.push_back("contact    " + contact_text(c));
  add_overlaps(c, lines);
  if (!has_fluid(c)) return;
  lines.push_back(
      fmt::format("flight     a grain moves a fiftieth of a cell a step at {:.3g} m/s; faster grains are less accurate",
                  0.02 * units_of(c).velocity()));
}

void add_solids(const Case& c, Lines& lines) {
  const std::vector<bodies::SolidShape> shapes = solid_shapes(c);
  for (std::size_t n = 0; n < shapes.size(); ++n) {
    const bodies::Extent extent = extent_of(shapes[n]);
    const Vec3 cells = extent.upper - extent.lower, low = extent.lower * c.domain.spacing,
               high = extent.upper * c.domain.spacing;
    const auto* mesh = std::get_if<TriangleMesh>(&shapes[n]);
    lines.push_back(
        fmt::format("solid {:<4} {} from [{:.4g}, {:.4g}, {:.4g}] to [{:.4g}, {:.4g}, {:.4g}] m: {:.3g} x "
                    "{:.3g} x {:.3g} cells",
                    n, mesh ? fmt::format("{} triangles", mesh->triangles.size()) : "sphere", low[0], low[1], low[2],
                    high[0], high[1], high[2], cells[0], cells[1], cells[2]));
  }
}

// What each supply brings, and sinks that the settled bed reaches into.
void add_turnover(const Case& c, Lines& lines) {
  for (std::size_t n = 0; n < c.supplies.size(); ++n) {
    const beds::SupplyKeys& supply = c.supplies[n];
    const double rate = grains_per_second(c, supply), until = std::min(c.run.until, supply.until.value_or(c.run.until));
    const beds::Population& population = c.grains[static_cast<std::size_t>(supply.population)];
    const double mass = beds::mean_mass(population), unit = unit_rate(c) * population.density;
    lines.push_back(fmt::format(
        "supply {:<3} {:.4g} grains/s like those of grains.{}, {:.3g} kg/s{}: {:.4g} from {:g} "
        "to {:g} s{}",
        n, rate, supply.population, rate * mass, unit > 0.0 ? fmt::format(", q* {:.3g}", rate * mass / unit) : "",
        std::floor(rate * std::max(0.0, until - supply.from)), supply.from, until,
        supply.above_bed
            ? fmt::format(", {:g} to {:g} m above the bed", supply.above_bed->lower, supply.above_bed->upper)
            : ""));
  }
  if (c.sinks.empty() || c.grains.empty() || periodic_axes(c.domain)[2]) return;
  const double surface = settled_height(c);
  const SolidCells solids(c);
  for (std::size_t n = 0; n < c.sinks.size(); ++n) {
    const auto& [lower, upper] = c.sinks[n].region;
    const double low = solids.lowest_opening(lower, upper);
    if (low < surface)
      lines.push_back(
          fmt::format("sink {:<5} reaches {:.3g} m below the surface of the settled bed, about {:.3g} m high, "
                      "and drains it",
                      n, surface - low, surface));
  }
}

void add_model_fluid(const Case& c, Lines& lines) {
  if (c.system != SystemKind::model_fluid) return;
  const model_fluid::ModelFluidParameters fluid = model_fluid_of(c);
  const model_fluid::ModelFluidNumbers& n = fluid.numbers;
  const model_fluid::GrainScales& s = fluid.scales;
  const model_fluid::ModelFluidCoefficients k = coefficients_of(n, s);
  lines.push_back(
      fmt::format("model      Shields number {:.4g}; Re_* {:.4g} as printed, u_* D/nu {:.4g}; Re_p {:.4g}; "
                  "lift over drag {:g}",
                  n.shields, n.reynolds, n.reynolds * model_fluid::printed_to_physical_reynolds, particle_reynolds(k),
                  n.lift_ratio));
  lines.push_back(fmt::format("           fluid at {:.4g} m/s at the top of the bed; B_1 {:.4g} kg/s, B_2 {:.4g} kg/m",
                              k.velocity, k.viscous, k.inertial));
  lines.push_back(fmt::format("           mean grain {:.4g} m, {:.4g} kg; reduced gravity {:.4g} m/s^2; time {:.4g} s",
                              s.diameter, s.mass, s.gravity, std::sqrt(s.diameter / s.gravity)));
  if (const auto units = units_text(c.model_fluid)) lines.push_back("           " + *units);
}

// Cells to a diameter of a column: 10 took 40 steps for 5 s, 16 took 574 and 20 took 6350.
constexpr double most_cheap_cells = 14.0;

// Report of a column. The wall time was measured for the columns of cases/continuum.
Lines column_report(const Case& c) {
  const continuum::SystemParameters parameters = column_of(c);
  if (parameters.creep) continuum::creep_below(parameters);  // refuses what the run would
  const continuum::ColumnParameters& column = parameters.column;
  const continuum::Mixture& mixture = column.mixture;
  const double d = mixture.diameter, gravity = gravity_vector(c.gravity).norm();
  const double stress = mixture.fluid_density * column.gravity_x * parameters.depth;
  return {
      fmt::format("{} (system: {})", c.name, name_of(c.system)),
      fmt::format("column     {} cells of {:.4g} m: a bed of {:.4g} m under {:.4g} m of water ({:.3g} diameters)",
                  column.cells, column.spacing, parameters.bed_cells * column.spacing, parameters.depth,
                  parameters.depth / d),
      fmt::format("Shields    {:.4g}: {:.4g} Pa on the bed, friction velocity {:.3g} m/s",
                  stress / (mixture.excess_density() * gravity * d), stress, std::sqrt(stress / mixture.fluid_density)),
      fmt::format(
          "work       {:.0f} intervals of {:g} s to {:g} s{}; {} on one core, and every rank does the same",
          std::ceil(c.run.until / *c.run.time_step * (1.0 - 1e-12)), *c.run.time_step, c.run.until,
          c.run.until_steady ? ", fewer if it is steady before" : "",
          d > most_cheap_cells * column.spacing
              ? fmt::format("minutes to hours (its steps shorten fast beyond {:g} cells a diameter)", most_cheap_cells)
              : "seconds to a minute")};
}

// Bytes.
double free_in_this_folder() {
  std::error_code unknown;
  const std::filesystem::space_info space = std::filesystem::space(std::filesystem::current_path(), unknown);
  return unknown ? std::numeric_limits<double>::infinity() : static_cast<double>(space.available);
}

// True if this machine has enough memory to place the grains. A run on more nodes may have it even so.
bool can_be_placed_here(const Case& c) {
  return c.grains.empty() || memory_on_one_rank(c) <= usable_memory_of_this_node();
}

void add_cost(const Case& c, double bandwidth, Lines& lines) {
  const Cost cost = cost_of(c, bandwidth);
  std::string work = fmt::format("work       {:.0f} steps to {:g} s", cost.steps, c.run.until);
  if (cost.cell_updates > 0.0) work += fmt::format(": {:.3g} cell updates", cost.cell_updates);
  if (cost.grain_steps > 0.0) work += fmt::format(", {:.3g} grain-steps", cost.grain_steps);
  lines.push_back(work);
  lines.push_back(memory_line(memory_on_one_rank(c), memory_of_this_node()));
  if (!can_be_placed_here(c))
    lines.push_back("           too many grains to be placed on this machine; the run checks whether they fit");
  lines.push_back(disk_line(disk_space(c), free_in_this_folder()));
  lines.push_back(fmt::format(
      "time       about {} on one core like this one{}, within a third; --ranks N,N,... measures it and predicts it on "
      "more cores",
      loop::clock_text(cost.core_seconds), bandwidth > 0.0 ? fmt::format(" ({:.3g} GB/s)", bandwidth * 1e-9) : ""));
}

std::string verdict_text(const Case& c, std::size_t warnings) {
  if (warnings > 0)
    return fmt::format("{} warning{}: correct the case before you rely on its results (check --solve)", warnings,
                       warnings == 1 ? "" : "s, the gravest first");
  const std::string drag = drag_text(c);
  return "no warning" +
         (drag.empty() ? std::string() : "; error at this cell size: drag " + drag + " (docs/accuracy.md)");
}

using LightestGrains = std::vector<dem::LightestGrain>;  // by material

// Lightest grains that the case places. Throws InputError if they do not fit.
LightestGrains check_placed_grains(const Case& c, const PeriodicBox& box, const dem::GrainParameters& parameters) {
  LightestGrains lightest(1 + parameters.other_materials.size());
  dem::GrainSeeds start = grain_seeds(c);
  dem::check(start.clumps, box);
  const std::vector<dem::GrainSeed> seeds = dem::with_members(std::move(start.grains), start.clumps, box);
  for (const dem::GrainSeed& seed : seeds)
    if (!dem::holds_translation(seed.motion))
      lightest[static_cast<std::size_t>(seed.material)].include(seed.contact_mass(), seed.radius);
  dem::check(seeds, box, parameters.walls, parameters.initial_overlap);
  dem::check(seeds, parameters.solids, box, parameters.initial_overlap);
  return lightest;
}

// Lightest grains taken from another run.
LightestGrains lightest_taken_grains(const Case& c, const dem::GrainParameters& parameters) {
  LightestGrains lightest(1 + parameters.other_materials.size());
  for (std::size_t population = 0; population < c.grains.size(); ++population)
    for (const beds::PopulationRow& row :
         beds::rows_of(c.grains, population, beds::share_of_rows(c.grains[population])))
      if (!dem::holds_translation(row.motion))
        lightest[static_cast<std::size_t>(row.material)].include(row.contact_mass, row.radius);
  return lightest;
}

}  // namespace

void refuse_impossible_grains(const Case& c) {
  if (c.grains.empty()) return;
  const PeriodicBox box{c.domain.size, periodic_axes(c.domain)};
  const dem::GrainParameters parameters = grain_parameters(c, box);
  dem::check(parameters.contact);
  if (!can_be_placed_here(c)) return;  // the report says so
  const LightestGrains lightest = c.initial.takes(InitialField::grains) ? lightest_taken_grains(c, parameters)
                                                                        : check_placed_grains(c, box, parameters);
  dem::check_time_step(parameters, lightest, grain_count(c));
  dem::check_lubrication(parameters, lightest, 0.5 * largest_diameter(c), box);
}

namespace {

// Report of a system of grains, fluid or both.
Lines resolved_report(const Case& c, double bandwidth) {
  check_initial_sources(c);  // a restart may do without them, so reading a case does not ask
  refuse_impossible_grains(c);
  Lines lines{fmt::format("{} (system: {})", c.name, name_of(c.system))};
  if (!c.filled_in.preset.empty()) lines.push_back("preset     " + c.filled_in.preset);
  if (!c.filled_in.flow.text.empty()) lines.push_back("follows    " + c.filled_in.flow.text);
  add_domain(c, lines);
  append(fluid_lines(c), lines);
  add_grains(c, lines);
  add_turnover(c, lines);
  add_solids(c, lines);
  append(bed_lines(c), lines);
  add_model_fluid(c, lines);
  add_cost(c, bandwidth, lines);
  return lines;
}

// The report of a case with these warnings.
Lines report_with(const Case& c, const Lines& found, double bandwidth) {
  Lines lines = c.system == SystemKind::continuum ? column_report(c) : resolved_report(c, bandwidth);
  for (const std::string& warning : found) lines.push_back("warning    " + warning);
  lines.push_back("verdict    " + verdict_text(c, found.size()));
  return lines;
}

}  // namespace

std::vector<std::string> check_report(const Case& c, double bandwidth) {
  return report_with(c, warnings(c), bandwidth);
}

std::string check_json(const Case& c, double bandwidth) {
  const Lines found = warnings(c), lines = report_with(c, found, bandwidth);
  io::JsonObject figures, units, all;
  const auto add = [&](const char* name, const char* unit, double value) {
    figures.set(name, value);
    units.set(name, unit);
  };
  if (c.system != SystemKind::continuum) {
    const Cost cost = cost_of(c, bandwidth);
    add("cells", "1", cost.cells);
    add("grains", "1", static_cast<double>(grain_count(c)));
    add("steps", "1", cost.steps);
    add("core_seconds", "s", cost.core_seconds);
    add("memory", "B", memory_on_one_rank(c));
    add("disk", "B", disk_space(c).total());
  }
  if (has_fluid(c)) {
    const FlowEstimate flow = flow_estimate(c);
    const FlowNumbers numbers = flow_numbers(c);
    add("time_step", "s", fluid_time_step(c));
    add("relaxation_time", "1", relaxation_time(c));
    add("largest_velocity", "m/s", flow.speed);
    add("largest_lattice_velocity", "1", flow.speed / units_of(c).velocity());
    add("friction_velocity", "m/s", flow.friction_velocity);
    add("development_time", "s", flow.spin_up);
    add("bed_height", "m", numbers.bed_height);
    add("depth", "m", numbers.depth);
    add("slope", "1", numbers.slope);
    add("shields_number", "1", expected_shields_number(c));
    add("galileo_number", "1", numbers.galileo);
  }
  all.set("name", c.name).set("system", name_of(c.system)).set("figures", figures).set("units", units);
  return all.set("report", lines).set("warnings", found).text() + "\n";
}

}  // namespace thalweg::driver
