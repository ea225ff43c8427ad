// Surface of the bed, and the stress that follows from it.
//
//   bed height        half of the bulk solid fraction (bed_height.hpp), and the mean of the surface of static pixels
//                     (static_pixels.hpp)
//   flow depth        H   = height of the box - bed height, that of the solid fraction
//   hydraulic radius  R_h = H W / (W + n H)                n: side walls that hold the flow back, 0 to 2
//   bed stress        tau_b = f R_h                        Pa, of a flow that is steady (Zhang et al. 2022)
//                     f     = rho_f g_x                    N/m^3, g_x: g times the sine of the slope
//   Shields number    tau*  = tau_b / ((rho_s - rho_f) g d)
//
// With a controlled mean velocity, f is the body force of the moment. A top of the box that drives or drags the flow
// adds its measured stress tau_top (Pa, on the fluid, along x). Solids and other obstacles take the measured force F_o
// from the flow above the bed, and fill the volume V_o there; what they take below, as a solid floor does, is the
// bed's:
//
//   tau_b = [f (H - V_o/A) + tau_top - F_o/A] W / (W + n H)                       A: plan of the box
#pragma once

#include "analysis/bed/bed_layers.hpp"
#include "analysis/bed/static_pixels.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "analysis/observer/saved_settings.hpp"

#include <mpi.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::analysis {

struct BedSurfaceKeys {
  static constexpr const char* section = "bed_surface";
  static constexpr const char* meaning =
      "height of the bed by solid fraction and by static pixels; depth, bed stress and Shields number of the flow "
      "above "
      "it";
  static constexpr Needs needs = Needs::grains;
  double from = 0.0;                 // s: the means begin here
  double every = 0.01;               // s: between measurements and looks at the pixels
  std::optional<double> layer = {};  // m: over which the solid fraction is averaged; d where not given
  std::optional<double> pixel = {};  // m; d/25 where not given
  double static_time = 0.5;          // s: a pixel covered by one grain for so long is static
  bool operator==(const BedSurfaceKeys&) const = default;
};
void describe(SectionVisitor& visit, BedSurfaceKeys& keys);
void check(const BedSurfaceKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const BedSurfaceKeys& keys, const RunContext& run, const RunningSystem& system);
ObserverMemory memory_of(const BedSurfaceKeys& keys, const RunContext& run, const RunSize& size);

// The flow over the bed; none for dry grains.
struct BedFlow {
  int side_walls = 0;           // those that hold the flow back
  double driving_stress = 0.0;  // Pa/m: rho_f g_x
  double shields_stress = 0.0;  // Pa: (rho_s - rho_f) g d; 0: nothing drives the flow, or it is not known what side
                                // walls take of it; no stress is shown
  bool measured = false;        // the forces are those of the moment (FluidSource::drive())
  bool has_obstacles = false;   // solids or spheres, whose force by height is needed (Snapshot::momentum)
  double ramp = 0.0;            // s in which gravity rises, from the start of the run
};

class BedSurface : public Observer {
public:
  // diameter: m, that stands for all grains. disk_thickness: m, 0: spheres. obstacles: as BedLayers has them. The box
  // must end in walls along z.
  BedSurface(MPI_Comm communicator, const PeriodicBox& box, const BedSurfaceKeys& keys, double diameter,
             const std::optional<BedFlow>& flow, double disk_thickness, const BedObstacles& obstacles = {});

  std::string name() const override { return "bed_surface"; }
  double every() const override { return keys_.every; }
  bool needs_momentum() const override { return flow_ && flow_->shields_stress > 0.0 && flow_->has_obstacles; }
  // A step seen before does not count again. One without the momentum it needs is no measurement of the stress.
  void observe(const Snapshot& snapshot) override;

  // bed_height (m), static_bed_height (m, mean of the columns that have a static pixel; not a number before the first
  // static_time is over); over a bed in a fluid flow_depth (m), hydraulic_radius (m), and where a slope, a steering
  // force or a moving top drives the flow bed_stress (Pa), shields_number (1).
  std::vector<Diagnostic> diagnostics() const override;

  // The means of all of these (with _mean), bulk_solid_fraction_mean, static_share_mean (1: columns with a static
  // pixel), mean_from (s), measurements, static_pictures.
  std::vector<Diagnostic> results() const override;

  // x (m, middle of the column), static_surface (m: mean over the pictures in which the column has a static pixel),
  // latest_static_surface (m; 0 where no pixel is static).
  std::vector<Profile> profiles() const override;

  void save(ArchiveWriter& archive) const override;
  // Takes the sums over only if they were begun at the same `from`, with the same settings.
  bool load(ArchiveReader& archive) override;

private:
  void measure(const Snapshot& snapshot);
  bool lacks_momentum(const Snapshot& snapshot) const;
  double taken_by_obstacles(const Snapshot& snapshot,
                            const FluidSource::Drive& drive) const;  // N, along x, above the bed
  double above_bed(const std::vector<Vec3>& by_height) const;        // N
  double flow_depth() const;                                         // m
  double hydraulic_radius() const;                                   // m
  SavedSettings settings() const;

  MPI_Comm communicator_;
  PeriodicBox box_;
  BedSurfaceKeys keys_;
  std::optional<BedFlow> flow_;
  double diameter_;  // m
  BedLayers layers_;
  double bed_height_ = 0.0, bulk_ = 0.0;                          // m, 1: latest
  double bed_stress_ = std::numeric_limits<double>::quiet_NaN();  // Pa: latest
  StaticPixels pixels_;
  std::int64_t seen_step_ = -1, measurements_ = 0, pictures_ = 0;
  std::int64_t stresses_ = 0;         // measurements of the stress
  std::vector<double> sums_;          // sums of the diagnostics but static_bed_height, and of the bulk's solid fraction
  std::vector<double> surface_sums_;  // m, of each column
  std::vector<double> surface_counts_;  // number of pictures in which each column has a static pixel
};

}  // namespace thalweg::analysis
