// Turbulence left to itself in a periodic cube; compare.py makes its start and reads its end.
//
//   bin/decaying_turbulence --cells N --excess E [--smagorinsky C | --qr] --collision NAME --start FILE --steps N1 N2
//   ...
//
// FILE: float32, N^3 values (x fastest) each of rho - 1, u, v, w in lattice units. Writes u, v, w in the same way to
// FILE.N1, FILE.N2, ... after so many steps. E is tau - 1/2. One rank.
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fstream>
#include <map>

namespace thalweg::benchmark {
namespace {

struct Options {
  int cells = 64;
  double excess = 1e-3;
  double smagorinsky = 0.0;
  bool qr = false;
  lbm::CollisionModel collision = lbm::CollisionModel::bgk;
  std::string start;
  std::vector<int> steps;
};

std::vector<float> read_start(const Options& o) {
  std::vector<float> values(4 * static_cast<std::size_t>(o.cells) * o.cells * o.cells);
  std::ifstream file(o.start, std::ios::binary);
  const auto bytes = static_cast<std::streamsize>(values.size() * sizeof(float));
  if (!file.read(reinterpret_cast<char*>(values.data()), bytes))
    throw InputError(fmt::format("The file '{}' does not hold four fields of {}^3 float32.", o.start, o.cells));
  return values;
}

void write_velocity(const lbm::Fluid<float>& fluid, int n, const std::string& name) {
  std::vector<float> values;
  values.reserve(3 * static_cast<std::size_t>(n) * n * n);
  for (int a = 0; a < 3; ++a)
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          values.push_back(static_cast<float>(fluid.state_at(fluid.indexing().index(x, y, z)).velocity[a]));
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  if (!file) throw RunError(fmt::format("Cannot write the file '{}'.", name));
}

void run(const Options& o) {
  const std::vector<float> start = read_start(o);
  const Decomposition decomposition({o.cells, o.cells, o.cells}, 1.0, {true, true, true}, {1, 1, 1});
  lbm::CollisionParameters parameters;
  parameters.model = o.collision;
  parameters.subgrid = o.qr ? lbm::Subgrid::qr() : lbm::Subgrid::smagorinsky(o.smagorinsky);
  parameters.relaxation_time = 0.5 + o.excess;
  lbm::Fluid<float> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  const std::size_t count = start.size() / 4, n = static_cast<std::size_t>(o.cells);
  fluid.initialise([&](const Vec3& p) {
    const auto at = [](double c) { return static_cast<std::size_t>(c); };  // the cell of a centre
    const std::size_t cell = (at(p.z()) * n + at(p.y())) * n + at(p.x());
    return lbm::FluidState{start[cell], Vec3(start[count + cell], start[2 * count + cell], start[3 * count + cell])};
  });
  int step = 0;
  for (const int end : o.steps) {
    for (; step < end; ++step) fluid.advance();
    write_velocity(fluid, o.cells, fmt::format("{}.{}", o.start, end));
  }
}

void add_options(CLI::App& app, Options& o) {
  std::map<std::string, lbm::CollisionModel> collisions;
  for (const auto& choice : lbm::choices_of(lbm::CollisionModel())) collisions.emplace(choice.name, choice.value);
  app.add_option("--cells", o.cells, "cells along a side");
  app.add_option("--excess", o.excess, "relaxation time less 1/2");
  auto* smagorinsky = app.add_option("--smagorinsky", o.smagorinsky, "Smagorinsky's constant");
  app.add_flag("--qr", o.qr, "Verstappen's QR model instead")->excludes(smagorinsky);
  app.add_option("--collision", o.collision)->transform(CLI::CheckedTransformer(collisions));
  app.add_option("--start", o.start, "file of the initial fields")->required();
  app.add_option("--steps", o.steps, "steps after which to write the velocity, ascending")->required();
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  CLI::App app("Turbulence left to itself in a periodic cube");
  thalweg::benchmark::Options options;
  try {
    thalweg::benchmark::add_options(app, options);
    app.parse(argc, argv);
    thalweg::benchmark::run(options);
  } catch (const CLI::Error& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
