// Turbulent flow between two plates, driven by a uniform force: mean velocity and stresses across the channel.
//
//   bin/turbulent_channel --height 120 --length 256 --width 144 --reynolds 180 --friction-velocity 0.008 ...
//
// Lattice units. x along the flow, y across, z normal to the plates; h half the height. The force F = u_tau^2/h sets
// the friction velocity u_tau by the balance of forces. Starts from Reichardt's mean profile with large vortices, or
// goes on from its own checkpoint. Prints a line now and then; leaves the profile in wall units in a CSV file.
#include "benchmarks/validation/turbulent_channel/plane_statistics.hpp"
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "lbm/fluid/fluid_survey.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>

namespace thalweg::benchmark {
namespace {

struct Options {
  Index3 cells{128, 64, 60};
  double reynolds = 180.0;           // u_tau h/nu
  double friction_velocity = 0.008;  // cells a step
  double smagorinsky = 0.0;
  bool qr = false;
  double bulk_relaxation_time = 0.0;
  double magic = 3.0 / 16.0;
  lbm::CollisionModel collision = lbm::CollisionModel::bgk;
  lbm::FaceType wall = lbm::FaceType::no_slip;
  double slip_coefficient = lbm::derived_slip_coefficient;
  bool slip_of_first_cell = false;
  double until = 20.0;         // end, in h/u_tau
  double average_from = 10.0;  // h/u_tau
  int samples = 50;            // per h/u_tau
  bool in_double = false;
  std::string checkpoint, output = "profile.csv";
};

// Divergence-free vortices that vanish at the plates: the curl of a vector potential across the normal, in 20 modes.
class Vortices {
public:
  Vortices(const Index3& cells, double amplitude) : cells_(cells) {
    std::mt19937 bits(7);
    for (int m = 0; m < 4; ++m)
      for (int n = 0; n < 5; ++n) {
        if (m == 0 && n == 0) continue;
        const auto phase = [&] { return 2.0 * std::numbers::pi * static_cast<double>(bits()) / 0x1p32; };
        const double kx = 2.0 * std::numbers::pi * m / cells[0], ky = 2.0 * std::numbers::pi * n / cells[1];
        modes_.push_back({kx, ky, phase(), phase(), amplitude * cells[2] / (8.0 * std::sqrt(1.0 + m * m + n * n))});
      }
  }

  Vec3 at(const Vec3& p) const {
    const double h = 0.5 * cells_[2], eta = p.z() / h - 1.0, g = (1 - eta * eta) * (1 - eta * eta);
    const double slope = -4.0 * eta * (1 - eta * eta) / h;
    Vec3 u = Vec3::Zero();
    for (const Mode& k : modes_) {
      const double a = k.kx * p.x() + k.ky * p.y() + k.first, b = k.kx * p.x() + k.ky * p.y() + k.second;
      u += k.amplitude * Vec3(-slope * std::sin(b), slope * std::sin(a), g * (k.kx * std::cos(b) - k.ky * std::cos(a)));
    }
    return u;
  }

private:
  struct Mode {
    double kx, ky, first, second, amplitude;
  };
  Index3 cells_;
  std::vector<Mode> modes_;
};

// Reichardt's mean profile (1951) from the plate outwards, in wall units.
double reichardt(double y) {
  return std::log(1.0 + 0.4 * y) / 0.4 + 7.8 * (1.0 - std::exp(-y / 11.0) - y / 11.0 * std::exp(-y / 3.0));
}

template <typename Real>
class Run {
public:
  explicit Run(const Options& options)
      : o_(options),
        h_(0.5 * o_.cells[2]),
        nu_(o_.friction_velocity * h_ / o_.reynolds),
        decomposition_(o_.cells, 1.0, {true, true, false},
                       Decomposition::best_layout(o_.cells, size_of(MPI_COMM_WORLD))),
        fluid_(decomposition_, MPI_COMM_WORLD, parameters(), faces()),
        statistics_(o_.cells[2]),
        since_print_(o_.cells[2]) {}

  void run() {
    start();
    const double turnover = h_ / o_.friction_velocity;
    const auto end = static_cast<std::int64_t>(o_.until * turnover);
    const int every = std::max(1, static_cast<int>(turnover / o_.samples));
    for (; step_ < end; ++step_) {
      fluid_.advance();
      if ((step_ + 1) % every != 0) continue;
      const PlaneSums sums = plane_sums(fluid_, MPI_COMM_WORLD, decomposition_);
      since_print_.add(sums);
      if (static_cast<double>(step_) >= o_.average_from * turnover) statistics_.add(sums);
      if ((step_ + 1) / every % o_.samples == 0) print(static_cast<double>(step_ + 1) / turnover);
      if ((step_ + 1) / every % (5 * o_.samples) == 0) keep(step_ + 1);
    }
    keep(step_);
  }

private:
  lbm::CollisionParameters parameters() const {
    lbm::CollisionParameters p;
    p.model = o_.collision;
    p.magic_parameter = o_.magic;
    p.bulk_relaxation_time = o_.bulk_relaxation_time;
    p.relaxation_time = 0.5 + 3.0 * nu_;
    p.subgrid = o_.qr ? lbm::Subgrid::qr() : lbm::Subgrid::smagorinsky(o_.smagorinsky);
    p.force[0] = o_.friction_velocity * o_.friction_velocity / h_;
    return p;
  }

  lbm::FaceConditions faces() const {
    lbm::FaceConditions faces;
    for (const int face : {4, 5}) {
      faces[face].type = o_.wall;
      faces[face].slip_coefficient = o_.slip_coefficient;
      faces[face].slip_of_first_cell = o_.slip_of_first_cell;
    }
    return faces;
  }

  void start() {
    if (!o_.checkpoint.empty() && std::filesystem::exists(o_.checkpoint)) {
      io::Hdf5Reader archive(MPI_COMM_WORLD, o_.checkpoint);
      fluid_.load(archive);
      step_ = archive.integer_attribute("run/step");
      statistics_.load(archive);
      return;
    }
    const Vortices vortices(o_.cells, 1.5 * o_.friction_velocity);
    fluid_.initialise([&](const Vec3& p) {
      const double from_plate = (h_ - std::abs(p.z() - h_)) * o_.reynolds / h_;
      return lbm::FluidState{0.0, Vec3(o_.friction_velocity * reichardt(from_plate), 0, 0) + vortices.at(p)};
    });
  }

  void print(double time) {
    const PlaneMeans m = since_print_.means();
    since_print_.clear();
    double bulk = 0.0, energy = 0.0;
    for (int z = 0; z < o_.cells[2]; ++z) {
      bulk += m.velocity[z] / o_.cells[2];
      energy += 0.5 * (m.uu[z] + m.vv[z] + m.ww[z]) / o_.cells[2];
    }
    const double u = o_.friction_velocity;
    // The shear follows from the first two cells and the plate at rest, to second order; not where the plate slips.
    const double shear =
        0.5 * (9 * m.velocity[0] - m.velocity[1] + 9 * m.velocity[o_.cells[2] - 1] - m.velocity[o_.cells[2] - 2]) / 3.0;
    const double largest = lbm::survey_of(fluid_).fastest.value;
    if (!(largest < 0.5)) throw RunError(fmt::format("The flow became unstable: a cell moves at {}.", largest));
    if (rank_of(MPI_COMM_WORLD) == 0) {
      fmt::print(
          "t {:6.2f} h/u_tau  U_b+ {:7.3f}  U_c+ {:7.3f}  k+ {:6.3f}  u_tau of the slope {:6.4f}  fastest {:.3f}\n",
          time, bulk / u, m.velocity[o_.cells[2] / 2] / u, energy / (u * u), std::sqrt(nu_ * shear) / u, largest);
      std::fflush(stdout);
    }
  }

  // next: the step to go on with.
  void keep(std::int64_t next) {
    if (!o_.checkpoint.empty()) {
      io::Hdf5Writer archive(MPI_COMM_WORLD, o_.checkpoint);
      fluid_.save(archive);
      archive.attribute("run/step", next);
      statistics_.save(archive, MPI_COMM_WORLD);
      archive.close();
    }
    if (rank_of(MPI_COMM_WORLD) == 0 && statistics_.samples() > 0)
      write_profile(o_.output, statistics_.means(), nu_, o_.friction_velocity);
  }

  Options o_;
  double h_, nu_;
  Decomposition decomposition_;
  lbm::Fluid<Real> fluid_;
  PlaneStatistics statistics_, since_print_;
  std::int64_t step_ = 0;
};

void add_options(CLI::App& app, Options& o) {
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  std::map<std::string, lbm::CollisionModel> collisions;
  for (const auto& choice : lbm::choices_of(lbm::CollisionModel())) collisions.emplace(choice.name, choice.value);
  const std::map<std::string, lbm::FaceType> walls{{"no_slip", lbm::FaceType::no_slip},
                                                   {"law_of_the_wall", lbm::FaceType::law_of_the_wall},
                                                   {"slip_law_of_the_wall", lbm::FaceType::slip_law_of_the_wall}};
  app.add_option("--length", o.cells[0], "cells along the flow");
  app.add_option("--width", o.cells[1], "cells across the flow");
  app.add_option("--height", o.cells[2], "cells from plate to plate");
  app.add_option("--reynolds", o.reynolds, "friction velocity times half the height over the viscosity");
  app.add_option("--friction-velocity", o.friction_velocity, "cells a step");
  auto* smagorinsky = app.add_option("--smagorinsky", o.smagorinsky, "Smagorinsky's constant");
  app.add_flag("--qr", o.qr, "Verstappen's QR model instead")->excludes(smagorinsky);
  app.add_option("--bulk-relaxation-time", o.bulk_relaxation_time, "steps; 0: as the shear's");
  app.add_option("--magic", o.magic, "magic parameter of trt");
  app.add_option("--collision", o.collision)->transform(CLI::CheckedTransformer(collisions));
  app.add_option("--wall", o.wall)->transform(CLI::CheckedTransformer(walls));
  app.add_flag("--slip-of-first-cell", o.slip_of_first_cell,
               "of the slip law: A from the first cell's distance from the wall");
  app.add_option("--slip-coefficient", o.slip_coefficient, "A of the slip law of the wall");
  app.add_option("--until", o.until, "end, in h/u_tau");
  app.add_option("--average-from", o.average_from, "start of the averages, in h/u_tau");
  app.add_option("--samples", o.samples, "samples in a time h/u_tau");
  app.add_flag("--double", o.in_double, "populations in double instead of single");
  app.add_option("--checkpoint", o.checkpoint, "file to go on from, and to keep");
  app.add_option("--output", o.output, "profile, CSV");
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  CLI::App app("Turbulent flow between two plates");
  thalweg::benchmark::Options options;
  try {
    thalweg::benchmark::add_options(app, options);
    app.parse(argc, argv);
    if (options.in_double)
      thalweg::benchmark::Run<double>(options).run();
    else
      thalweg::benchmark::Run<float>(options).run();
  } catch (const CLI::Error& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
