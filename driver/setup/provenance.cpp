#include "driver/setup/provenance.hpp"

#include "core/parallel/mpi_session.hpp"
#include "driver/setup/input_files.hpp"
#include "io/files/sha256.hpp"
#include "io/hdf5/hdf5_version.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <compiler.hpp>  // driver/CMakeLists.txt writes it

#include <array>
#include <ctime>
#include <fstream>

namespace thalweg::driver {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return {};
}

// "Open MPI v4.1.4"; the library adds more.
std::string mpi_version() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string whole(text.data(), static_cast<std::size_t>(length));
  return whole.substr(0, whole.find_first_of(",\n"));
}

std::int64_t count_nodes(MPI_Comm communicator) {
  MPI_Comm node = MPI_COMM_NULL;
  MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  const std::int64_t first = rank_of(node) == 0 ? 1 : 0;
  MPI_Comm_free(&node);
  return sum_over_ranks(communicator, first);
}

// Not of other runs: their checkpoints, which may be large, have checksums of their own.
std::vector<InputFile> inputs_of(const Case& c, const std::filesystem::path& folder) {
  std::vector<InputFile> inputs;
  for (const auto& [key, path] : inputs_by_key(c))
    if (!key.starts_with("initial.")) inputs.push_back({key, path_from(folder, path), io::sha256_of(path)});
  return inputs;
}

}  // namespace

Provenance provenance_of(const Case& c, const std::filesystem::path& folder, MPI_Comm communicator) {
  Provenance found;
  found.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  found.host = host_name();
  found.processor = processor_name();
  found.nodes = count_nodes(communicator);
  found.compiler = THALWEG_COMPILER;
  found.flags = THALWEG_FLAGS;
  found.mpi = mpi_version();
  found.hdf5 = io::hdf5_version();
  if (rank_of(communicator) == 0) found.inputs = inputs_of(c, folder);
  return found;
}

io::JsonObject as_json(const Provenance& provenance) {
  io::JsonObject object;
  object.set("started", provenance.started).set("host", provenance.host).set("nodes", provenance.nodes);
  object.set("processor", provenance.processor).set("compiler", provenance.compiler);
  object.set("compiler_flags", provenance.flags).set("mpi", provenance.mpi).set("hdf5", provenance.hdf5);
  std::vector<io::JsonObject> inputs;
  for (const InputFile& input : provenance.inputs)
    inputs.push_back(
        io::JsonObject().set("key", input.key).set("path", input.path).set("sha256", input.sha256.value_or("")));
  return object.set("inputs", inputs);
}

std::vector<std::string> as_text(const Provenance& provenance) {
  std::vector<std::string> lines{fmt::format("started {} on {} ({}, {} node{})", provenance.started, provenance.host,
                                             provenance.processor, provenance.nodes, provenance.nodes == 1 ? "" : "s"),
                                 fmt::format("built with {} ({}); {}, HDF5 {}", provenance.compiler, provenance.flags,
                                             provenance.mpi, provenance.hdf5)};
  for (const InputFile& input : provenance.inputs)
    lines.push_back(fmt::format("{} = {}: SHA-256 {}", input.key, input.path, input.sha256.value_or("unknown")));
  return lines;
}

}  // namespace thalweg::driver
