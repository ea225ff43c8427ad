// Grains layer by layer, gathered while the run goes on: how much there is of them, how they move, and the stresses
// they carry.
//
//   solid fraction   phi   = sum V_il / (A b)                  V_il: volume of grain i within layer l, exact
//   velocity         U     = sum m_il v_i / sum m_il           m_il = m_i V_il / V_i
//   flux             phi v = sum V_il v_i / (A b)              m/s, volume over area and time
//   temperature      T     = (sum m_il |v_i|^2 / sum m_il - |U|^2) / 3
//   contact stress   s_ab  = sum (V_il / V_i) sum_c F_a r_b / (A b)
//   kinetic stress   k_ab  = -(sum m_il v_ia v_ib - sum m_il U_a U_b) / (A b)
//
// A b is the volume of a layer; sums run over grains and, for contacts, over those of each grain, with F the force on
// it and r the arm from its centre (Love 1927; Weber 1966; Christoffersen, Mehrabadi & Nemat-Nasser, J. Appl. Mech. 48
// (1981) 339). Stresses are positive in tension: a bed under its weight has s_zz = -(weight above)/A, and
// rho dU/dt = div(s + k) + rho g. The mean over measurements is that of the sums, so U, T and k include what varies
// from one time to another. Held and free grains count alike.
// A clump's volume, mass and contacts (with arms from its centre) are spread over its members as their volumes are to
// each other, and it moves as its centre does.
//
// The sums of a measurement have the same bits on any number of ranks (core/sums/reproducible_sum.hpp), and so have the
// means, also after a restart.
#pragma once

#include "analysis/observer/mean_observer.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg::analysis {

struct GrainProfilesKeys {
  static constexpr const char* section = "grain_profiles";
  static constexpr const char* meaning =
      "mean solid fraction, velocity, flux, granular temperature and stresses of the grains over z, and the "
      "orientation "
      "of clumps, in profiles.h5";
  static constexpr Needs needs = Needs::grains;
  double from = 0.0;                 // s: the means begin here
  double every = 0.01;               // s: between measurements
  std::optional<double> layer = {};  // m, wanted; half of the largest diameter where not given
  bool operator==(const GrainProfilesKeys&) const = default;
};
void describe(SectionVisitor& visit, GrainProfilesKeys& keys);
void check(const GrainProfilesKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const GrainProfilesKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
// It keeps sums by layer, nothing of a grain.
inline ObserverMemory memory_of(const GrainProfilesKeys&, const RunContext&, const RunSize&) { return {}; }

struct WeightedBody;

class GrainProfiles : public MeanObserver {
public:
  // layer: m, where the keys have none; changed so that a whole number of layers fills the box. disk_thickness: m, the
  // width of the layers in place of the box's; 0: spheres. clumps: there are some, or may be.
  GrainProfiles(MPI_Comm communicator, const Decomposition& decomposition, double layer, const GrainProfilesKeys& keys,
                double disk_thickness = 0.0, bool clumps = false);

  std::vector<Diagnostic> results() const override;  // mean_from (s), measurements (1)

  // Over z (m, middle of the layer): solid_fraction (1), velocity (m/s: x, y, z), flux (m/s: x, y, z),
  // granular_temperature (m^2/s^2), contact_stress (Pa: xx, xy, xz, yx, ... zz, the force's component first),
  // kinetic_stress (Pa: xx, yy, zz, xy, xz, yz). Velocity and temperature are zero where there was no grain. With
  // clumps also clump_fraction (1, of the layer's volume), long_axis_alignment and short_axis_alignment (1: xx, yy, zz,
  // xy, xz, yz): the mean of p_a p_b by volume, p the axis of the least and of the largest moment of inertia; 1/3 of
  // the unit tensor where all directions are alike, zero where there was no clump.
  std::vector<Profile> profiles() const override;

private:
  // Columns of a layer.
  enum Quantity { volume, mass = 1, momentum = 2, product = 5, flux = 11, contact = 14, quantities = 23 };
  // Columns of the clumps in a layer: their volume, and times p_a p_b of their axes.
  enum AxesQuantity { clump_volume, long_axis = 1, short_axis = 7, axes_quantities = 13 };

  void add(const Snapshot& snapshot) override;
  void save_sums(ArchiveWriter& archive, const std::string& group) const override;
  bool load_sums(ArchiveReader& archive, const std::string& group) override;
  std::vector<std::uint64_t> shape() const { return {static_cast<std::uint64_t>(layers_), quantities}; }
  std::vector<std::uint64_t> axes_shape() const { return {static_cast<std::uint64_t>(layers_), axes_quantities}; }
  void give_parts(const GrainView& grains, std::size_t i, const WeightedBody& body, const TermTaker& take) const;
  void give_axes(const GrainView& grains, std::size_t i, const WeightedBody& body, const TermTaker& take) const;
  // Calls visit(layer, part) for every layer with a part (m^3) of sphere i.
  template <typename Visit>
  void for_each_layer(const GrainView& grains, std::size_t i, const Visit& visit) const;
  std::vector<Profile> axes_profiles() const;

  PeriodicBox box_;
  double width_;  // m, of a layer across
  int layers_;
  double thickness_;          // m, of a layer
  std::vector<double> sums_;  // quantities of each layer; over all ranks, on every rank
  std::vector<double> axes_;  // axes_quantities of each layer, likewise; empty: no clumps
};

}  // namespace thalweg::analysis
