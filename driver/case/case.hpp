// One run as the user asked for it, in SI units: plain values with their defaults, and the few numbers that follow from
// them by definition. The file format is case_reader's business; meanings and units of all keys: `thalweg defaults`.
#pragma once

#include "analysis/observers/observer_list.hpp"
#include "beds/population/material_keys.hpp"
#include "beds/population/population.hpp"
#include "beds/population/supply_keys.hpp"
#include "beds/population/wall_keys.hpp"
#include "continuum/column_keys.hpp"
#include "core/base/types.hpp"
#include "core/base/units.hpp"
#include "core/geometry/triangle_mesh.hpp"
#include "core/keys/named_choice.hpp"
#include "coupling/keys/coupling_keys.hpp"
#include "coupling/keys/face_keys.hpp"
#include "coupling/keys/fluid_keys.hpp"
#include "coupling/system/initial_fluid.hpp"
#include "io/vtk/output_keys.hpp"
#include "loop/out_of_bounds.hpp"
#include "model_fluid/model_fluid_keys.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

enum class SystemKind { resolved, fluid, grains, model_fluid, continuum };
std::vector<NamedChoice<SystemKind>> choices_of(SystemKind);  // its words in a case file
std::string name_of(SystemKind kind);

// The order of the faces everywhere in the driver.
enum FaceIndex { x_low, x_high, y_low, y_high, bottom, top };

struct DomainCase {
  Vec3 size = Vec3::Zero();  // m
  double spacing = 0.0;      // m
  std::array<coupling::FaceKeys, 6> faces{};
  bool operator==(const DomainCase&) const = default;
};

// reduced: the fluid is driven by rho g_x, _y alone and the grains feel their submerged weight. full: the fluid has its
// weight and its hydrostatic pressure, which carries the grains through the links, and the grains have their whole
// weight. balanced: in a periodic box; the mean pressure gradient carries the submerged weight of all grains, so that
// the momentum of the whole does not change.
enum class GravityMode { reduced, full, balanced };

struct GravityCase {
  std::optional<double> magnitude;  // m/s^2, with slope ...
  std::optional<double> slope;      // 1, tangent of the bed's angle, downhill along x
  std::optional<Vec3> vector;       // ... or the vector itself, m/s^2
  GravityMode mode = GravityMode::reduced;
  bool operator==(const GravityCase&) const = default;
};

// The flow over the bed that the grains make, in place of the slope, of the height of the box, or of both.
struct FlowCase {
  std::optional<double> shields_number;  // of the reference grain; between side walls by the hydraulic radius
  std::optional<double> depth;           // m, of the water above the settled bed
  bool operator==(const FlowCase&) const = default;
};

struct SphereCase {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
  bool operator==(const SphereCase&) const = default;
};

// A body that fluid and grains meet: a sphere, or the surface in an STL file.
struct SolidCase {
  std::optional<SphereCase> sphere;
  std::string stl;                                   // file, absolute once read; empty: none
  double scale = 1.0;                                // m per unit of the file
  Vec3 translate = Vec3::Zero();                     // m, after scaling
  std::optional<double> friction, rolling_friction;  // else contact.wall_friction, contact.wall_rolling_friction
  std::optional<dem::MotionKeys> motion;             // none: it stands still
  TriangleMesh surface = {};                         // of the file, in m, once read; not a key
  bool operator==(const SolidCase&) const = default;
};

enum class InitialField { fluid, grains };

// Run folders or checkpoints of other runs, absolute once read: one for all fields, or one for each.
struct InitialFromCase {
  std::optional<std::string> run, grains, fluid;
  bool operator==(const InitialFromCase&) const = default;

  bool each() const { return grains || fluid; }
  bool none() const { return !each() && (!run || run->empty()); }
};

// Source of an initial field: another run, and the key that names it.
struct InitialSource {
  std::string path;  // empty: from no other run
  std::string key;   // "initial.from"
};

struct InitialCase {
  InitialFromCase from;
  std::vector<InitialField> fields{InitialField::fluid};  // fields taken from `from.run`
  coupling::InitialFluidKeys fluid;
  bool operator==(const InitialCase&) const = default;

  InitialSource source_of(InitialField field) const;
  bool takes(InitialField field) const { return !source_of(field).path.empty(); }
};

// Grains are at rest where both hold for all that are free to move, or this share of them, so that a grain at the top
// of its flight is not.
struct AtRestCase {
  double largest_speed = 1e-4;         // m/s
  double largest_acceleration = 0.01;  // m/s^2, of all forces together
  double quantile = 1.0;               // 1, of the number of grains; a clump is one
  bool operator==(const AtRestCase&) const = default;
};

// A column is steady where its diagnostic `unsteadiness` (continuum/continuum_system.hpp) is below this.
struct SteadyCase {
  double unsteadiness = 1e-4;
  bool operator==(const SteadyCase&) const = default;
};

struct RunCase {
  double until = 0.0;                       // s
  std::optional<AtRestCase> until_at_rest;  // of dry grains: the run ends earlier when this holds
  std::optional<SteadyCase> until_steady;   // of a column: the run ends earlier when this holds
  loop::OutOfBounds watchdog = loop::OutOfBounds::stop;
  double ramp = 0.0;  // s in which gravity rises from zero, with a fluid
  // s, of dry grains, or a column; read as 1/50 of the shortest contact, or 5 s, where it is not given
  std::optional<double> time_step;
  bool operator==(const RunCase&) const = default;
};

// Columns of series.csv that the system itself measures; it has no keys.
struct WallForcesCase {
  bool operator==(const WallForcesCase&) const = default;
};

struct AnalysisCase {
  std::optional<double> reference_diameter;  // m; else that of reference_grain()
  analysis::RequestedObservers observers;
  std::optional<WallForcesCase> wall_forces;
  bool operator==(const AnalysisCase&) const = default;
};

// Dry grains that are disks with their axis along y, all in the middle of the box.
struct DisksCase {
  double thickness = 0.0;  // m
  bool operator==(const DisksCase&) const = default;
};

// What the section flow has set.
struct FlowFilledIn {
  bool height = false, slope = false;  // third number of domain.size, a whole number of cells; gravity.slope
  std::string text;                    // these keys in words; empty: there is no section
  // Given with gravity.slope, from which two the depth of the water follows; none: the depth does not depend on them.
  std::optional<double> shields_number = std::nullopt;
};

// Keys that the case omits and that are derived from others (estimate/filled_in.hpp), so they must be derived again
// when those change. Two cases that differ only here are the same.
struct FilledIn {
  bool stiffness = false, tangential_stiffness = false;  // of the section contact
  bool grain_steps = false;
  bool time_step = false;  // of the fluid
  struct {
    bool bed_height = false, shear_velocity = false, roughness = false;
  } profile;  // initial.fluid.log_profile
  FlowFilledIn flow;
  std::string preset;  // keys that a preset has set, in words; empty: there is none
  bool operator==(const FilledIn&) const { return true; }
};

struct Case {
  SystemKind system = SystemKind::resolved;
  std::string name;
  DomainCase domain;          // that of a column follows from its sections
  coupling::FluidKeys fluid;  // meaningless for dry grains, as are coupling and initial
  GravityCase gravity;
  std::optional<FlowCase> flow;  // only while the case is read: it becomes gravity.slope and domain.size
  std::optional<DisksCase> disks;
  std::vector<beds::Population> grains;
  std::vector<beds::SupplyKeys> supplies;  // grains that come in during the run
  std::vector<beds::SinkKeys> sinks;       // where they leave
  std::vector<beds::WallKeys> walls;       // of dry grains, besides the faces
  std::vector<SolidCase> solids;
  beds::ContactKeys contact;
  model_fluid::ModelFluidKeys model_fluid;  // of system: model_fluid
  continuum::ContinuumKeys continuum;       // of system: continuum
  coupling::CouplingKeys coupling;
  InitialCase initial;
  RunCase run;
  io::OutputKeys output;
  AnalysisCase analysis;
  FilledIn filled_in;
  bool operator==(const Case&) const = default;
};

// Quantities derived from a case that read_case() has accepted.

bool has_fluid(SystemKind system);
bool has_fluid(const Case& c);                         // system: resolved or fluid
bool has_grains(SystemKind system);                    // true if a case gives its grains one by one
continuum::SystemParameters column_of(const Case& c);  // the column of system: continuum

Index3 cells_of(const DomainCase& domain);  // size over spacing

// The largest spacing (m) of at most `most` of which every side of the domain that is given is a whole number; where
// there is none within a fifth of it, the largest whole fraction of the present spacing.
double spacing_below(const Case& c, double most);
std::array<bool, 3> periodic_axes(const DomainCase& domain);
double fluid_time_step(const Case& c);    // s
std::int64_t grain_steps(const Case& c);  // sub-steps in a step of the fluid; of dry grains in one step_time()
double grain_time_step(const Case& c);    // s: a sub-step, or the step of dry grains
double step_time(const Case& c);          // s: of the fluid, as many steps of dry grains as make one, of a column
Vec3 gravity_vector(const GravityCase& gravity);  // m/s^2: (g sin, 0, -g cos) of atan(slope)
Units units_of(const Case& c);                    // units of a run with a fluid
double relaxation_time(const Case& c);            // BGK, without the subgrid model
double bulk_relaxation_time_for(const Case& c);   // tau_b where the case does not give it; 0: that of the shear
double bulk_viscosity(const Case& c);             // m^2/s: 2/9 (tau_b - 1/2), without the subgrid model

std::int64_t grain_count(const Case& c);              // grains of all populations
std::int64_t grain_rows(const Case& c);               // ids that they take: a clump as many as it has members
double largest_diameter(const Case& c);               // m, of spheres and members of clumps; 0 without grains
double largest_size(const beds::Population& grains);  // m, of spheres, and of clumps the nominal diameter
double largest_size(const Case& c);                   // m, of all populations
double largest_extent(const Case& c);                 // m, the same with clumps as they are long
double smallest_diameter(const Case& c);              // m; 0 without grains
double narrowest_grain(const Case& c);                // m, the same with clumps by their shortest axis
double grain_volume(const Case& c);                   // m^3, of all grains
// m, in which the grains of a population are placed that has no positions: the one given, or the box.
beds::RegionKeys region_of(const Case& c, const beds::Population& grains);
model_fluid::MeanGrain mean_grain(const Case& c);  // mean of all grains
model_fluid::ModelFluidParameters model_fluid_of(const Case& c);
// m/s, of the model fluid around a grain without neighbours, the fastest there is; 0 without a model fluid
double fastest_model_fluid(const Case& c);

bool has_free_grains(const Case& c);  // some that are not held

// Indices of the populations that are free to move; of all where none is.
std::vector<std::size_t> free_populations(const Case& c);

// The shortest contact there can be, between two of the lightest free grains of a population or of one of them with a
// wall: half a period of the undamped spring, pi sqrt(m / 2 / k_n), which a dashpot makes longer up to the critical
// damping and by which it is divided beyond; or Hertz's contact at 1 m/s (dem/laws/material.hpp). Contacts between
// populations are never shorter than the shortest within one. s; infinite without grains.
double shortest_contact(const Case& c);

// The longest step of the grains (s) with which the shortest contact takes dem::fewest_steps_per_contact of them, and
// that which can follow the lubrication force; infinite without grains, the second also without that force.
double longest_contact_step(const Case& c);
double longest_lubrication_step(const Case& c);

// Pa s, of the fluid whose film the contacts have (dem/laws/contact_film.hpp); 0: none. There is one where contacts
// have a restitution, which is that of a dry collision: a damping is the whole dashpot, and lubrication is a film of
// its own.
double film_viscosity(const Case& c);

// Sub-steps of the grains in one step of the fluid that keep both; at least 1.
std::int64_t sub_steps_needed(const Case& c);

}  // namespace thalweg::driver
