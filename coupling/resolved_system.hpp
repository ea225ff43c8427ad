// Grains in a resolved flow: the system the project exists for. One step is one lattice step and its DEM sub-steps.
#pragma once

#include "bodies/bodies.hpp"
#include "core/decomposition.hpp"
#include "core/system.hpp"
#include "coupling/fluid_parameters.hpp"
#include "coupling/grain_exchange.hpp"
#include "coupling/load_rule.hpp"
#include "coupling/mass_account.hpp"
#include "coupling/virtual_mass.hpp"
#include "dem/grain_dynamics.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace thalweg::coupling {

struct ResolvedParameters : FluidParameters {
  double link_tolerance = 1e-3;             // cells a grain may move before the map of its cells follows
  int sub_steps = 50;                       // DEM steps per lattice step
  bool wall_forces = false;                 // whether the figures include the forces on walls
  std::optional<VirtualMass> virtual_mass;  // of light grains; its filter is made for LoadRule::mean
  LoadRule load = LoadRule::extrapolated;
};

template <typename Real>
class ResolvedSystem final : public System, private FluidSource, private ContactSource {
public:
  // The grains (already holding their seeds) must carry attached_width() attached columns and reach ghost_reach()
  // beyond their block. Takes both over. Throws InputError where a block is too long (bodies::LinkBuilder). Collective.
  ResolvedSystem(std::unique_ptr<Decomposition> decomposition, MPI_Comm communicator,
                 const ResolvedParameters& parameters, std::unique_ptr<dem::GrainDynamics> grains);

  // Columns that dem carries for the exchange (grain_exchange.hpp).
  static int attached_width(const ResolvedParameters& parameters) {
    return parameters.bodies.moments ? GrainExchange<double>::width_with_stress : GrainExchange<double>::width;
  }

  // How far beyond a block its grains must be known for the map, as a distance from the grain's centre (m).
  static double ghost_reach(double largest_radius, double spacing) { return largest_radius + 2.5 * spacing; }

  void advance() override;
  void book_momentum() override { booking_ = true; }
  std::int64_t step() const override { return step_; }
  double time_step() const override { return parameters_.units.time_step; }
  Snapshot snapshot() const override;
  // Those of speed_figures(), mean_density_deviation (1), fluid_cells (1), largest_overlap (diameters), if asked for
  // wall_force_bottom_x ... and fluid_wall_force_bottom_x ... (N), those of add_extremes(), largest_grain_speed (m/s),
  // those of MassAccount and of add_momentum() (fluid_figures.hpp). Collective.
  std::vector<Figure> figures() const override;
  std::optional<Place> place_of(const std::string& figure) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;
  void take_fluid(ArchiveReader& archive, double spacing) override;
  void take_grains(ArchiveReader& archive, double spacing) override;
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override;
  std::int64_t grain_steps_per_step() const override;

  const lbm::Fluid<Real>& fluid() const { return fluid_; }
  const dem::GrainDynamics& grains() const { return *grains_; }
  const bodies::LinkTable& links() const { return bodies_.links(); }
  const bodies::ExchangeTotals& step_totals() const { return bodies_.step_totals(); }

private:
  FluidFields sample(const std::vector<FluidField>& wanted, const Block& region) const override;
  void for_each_velocity(const VelocityVisitor& visit) const override;
  std::optional<State> state_in(const Index3& cell) const override;
  Drive drive() const override;
  void for_each_contact(const ContactVisitor& visit) const override { grains_->for_each_contact(visit); }
  void for_each_lubrication(const ContactVisitor& visit) const override { grains_->for_each_lubrication(visit); }
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    grains_->for_each_contact_of(chosen, visit);
  }
  void for_each_wall_force(const ContactEndVisitor& visit) const override { grains_->for_each_wall_force(visit); }

  void add_wall_forces(std::vector<Figure>& figures) const;
  void initialise_map();
  void synchronise_slots();
  void update_map();
  void update_bodies();
  void book_masses();
  void open_account();
  void correct_mass();
  bodies::LinkSums link_sums_of(std::size_t grain) const;
  void settle_masses();
  void settle_mass(std::size_t first, std::size_t count);
  double mass_owed() const;
  void set_gravity_of(std::int64_t step);
  void write_momentum_book();
  void update_links_behind_halo();
  void collect_loads();
  void apply_loads();
  GrainExchange<double> exchange_of(std::size_t grain) { return GrainExchange(grains_->store().attached_of(grain)); }
  GrainExchange<const double> exchange_of(std::size_t grain) const {
    return GrainExchange(std::as_const(*grains_).store().attached_of(grain));
  }
  void set_load(std::size_t grain, const Vec3& force, const Vec3& torque, bool first);
  void apply_stress(std::size_t grain, bool first);
  void show_stresses();
  // Of a grain: force, torque, mass, pressure, LinkSums; where asked for, moments.
  static constexpr int plain_sums = 8 + bodies::LinkSums::size;
  int sums_per_grain() const { return plain_sums + (parameters_.bodies.moments ? 9 : 0); }
  Vec3 lattice_position(const Vec3& position) const { return position / parameters_.units.spacing; }

  std::unique_ptr<Decomposition> decomposition_;
  MPI_Comm communicator_;
  ResolvedParameters parameters_;
  mutable lbm::Fluid<Real> fluid_;  // a sample fills slots that every step fills anew; see sample_fields()
  std::unique_ptr<dem::GrainDynamics> grains_;
  PeriodicBox box_;  // m
  bodies::Hydrostatic rest_;
  bodies::Bodies<Real> bodies_;
  std::vector<int> slot_;                 // of each grain of the store
  std::vector<std::int64_t> exchanged_;   // force and torque sums of each grain of the store, and those of moments
  std::vector<Mat3> fluid_stress_;        // Pa, of owned grains; empty unless asked for
  bool booking_ = false;                  // this step's momentum is to be booked
  std::optional<MomentumBook> momentum_;  // of the last step
  MassAccount mass_;
  bool closed_;  // no face lets fluid in or out
  std::int64_t step_ = 0;
  PhaseTimer timer_;
  struct Phases {
    int map, refill, halo, walls, links, sweep, loads, grains;
  } phases_;
};

}  // namespace thalweg::coupling
