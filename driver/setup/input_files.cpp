#include "driver/setup/input_files.hpp"

#include "core/base/error.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/folder/run_folder.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <optional>

namespace thalweg::driver {
namespace {

namespace fs = std::filesystem;

// Calls `visit` with the key and the path of each file.
template <typename AnyCase, typename Visit>
void for_each_input(AnyCase& c, const Visit& visit) {
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (auto& file = c.grains[n].placement.file) visit(fmt::format("grains.{}.placement.file", n), *file);
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (auto& shape = c.grains[n].shape; shape && !shape->made_from.empty())
      visit(fmt::format("grains.{}.shape.stl", n), shape->made_from);
  for (std::size_t n = 0; n < c.solids.size(); ++n)
    if (!c.solids[n].stl.empty()) visit(fmt::format("solids.{}.stl", n), c.solids[n].stl);
  const auto initial = [&](const char* key, auto& path) {
    if (path && !path->empty()) visit(std::string(key), *path);
  };
  initial("initial.from", c.initial.from.run);
  initial("initial.from.grains", c.initial.from.grains);
  initial("initial.from.fluid", c.initial.from.fluid);
}

fs::path first_folder(const fs::path& path) {
  const fs::path below = path.relative_path();
  return below.empty() ? below : *below.begin();
}

std::array<std::optional<std::string>*, 3> sources_of(Case& c) {
  return {&c.initial.from.run, &c.initial.from.grains, &c.initial.from.fluid};
}

std::string checkpoint_or(const std::string& path) {
  try {
    return io::checkpoint_at(path).string();
  } catch (const InputError&) {  // whoever reads it says so
    return path;
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> inputs_by_key(const Case& c) {
  std::vector<std::pair<std::string, std::string>> inputs;
  for_each_input(c, [&](const std::string& key, const std::string& path) { inputs.emplace_back(key, path); });
  return inputs;
}

std::string path_from(const fs::path& folder, const std::string& path) {
  std::error_code unknown;
  const fs::path real = fs::weakly_canonical(folder, unknown), file(path);
  const fs::path base = unknown ? fs::absolute(folder).lexically_normal() : real;
  if (!file.is_absolute() || first_folder(file) != first_folder(base)) return path;
  return file.lexically_relative(base).string();
}

Case with_paths_from(const fs::path& folder, Case c) {
  for_each_input(c, [&](const std::string&, std::string& path) { path = path_from(folder, path); });
  return c;
}

Case with_checkpoints_found(Case c, MPI_Comm communicator) {
  for (std::optional<std::string>* source : sources_of(c))
    if (*source && !(*source)->empty())
      *source = told_by_first_rank(communicator, [&] { return checkpoint_or(**source); });
  return c;
}

Case with_sources_of(const fs::path& folder, const std::string& yaml, Case c) {
  YAML::Node from;
  try {
    from = YAML::Load(yaml)["initial"]["from"];
  } catch (const YAML::Exception&) {  // a case that somebody has changed by hand
  }
  const auto path_at = [&](const YAML::Node& node) -> std::optional<std::string> {
    if (!node.IsDefined() || !node.IsScalar() || node.Scalar().empty()) return {};
    return (folder / node.Scalar()).lexically_normal().string();
  };
  c.initial.from = {};
  if (!from.IsMap())
    c.initial.from.run = path_at(from);
  else
    c.initial.from = {path_at(from["run"]), path_at(from["grains"]), path_at(from["fluid"])};
  return c;
}

}  // namespace thalweg::driver
