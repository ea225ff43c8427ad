// The case file: YAML in, a checked Case out, and back.
#pragma once

#include "core/base/error.hpp"
#include "driver/case/case.hpp"
#include "driver/input/bed_placement.hpp"

#include <mpi.h>

#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::driver {

// Reads and checks a case. overrides: texts of the form "key.sub=VALUE" (items of a list by index: grains.0.count=10)
// that replace or add to what the file says. Throws InputError: one sentence with file and line (or the override), key,
// value, and what would be right. Writes nothing. known: beds that need not be read from their files. communicator: of
// the ranks that read it together: the first reads the case and the surfaces it names for all, each its share of the
// rows of beds, and all throw; null: this process alone, perhaps without MPI. Collective.
Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
               const KnownBeds& known = {}, MPI_Comm communicator = MPI_COMM_NULL);

// The case with every default filled in, as YAML that read_case() reads back as the same case.
std::string resolved_yaml(const Case& c);

// Calls `work`, whose InputError, where it throws one, is preceded by the path of the case.
template <typename Work>
auto about_case(const std::filesystem::path& path, Work&& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

// Every key of a system ("resolved", "fluid", "grains", "model_fluid", "continuum") with its default, unit and meaning:
// a valid case, with plausible values, marked as examples, for the keys that have no default, and the optional ones
// commented out. Or one section of it: "contact" (of the first system that has it), "grains.contact" (that of the
// system grains), "resolved.grains.contact" (that of a population). Or a preset as it is, "zhang2022". Throws
// InputError where there is no such thing.
std::string defaults_yaml(const std::string& what = "resolved");

// JSON schema (draft 7) of a case of any system, for editors.
std::string case_schema();

}  // namespace thalweg::driver
