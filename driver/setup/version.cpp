#include "driver/setup/version.hpp"

#include <commit.hpp>  // cmake/commit.cmake writes it

namespace thalweg::driver {

std::string version_text() {
  const std::string commit = THALWEG_COMMIT;
  return version_number() + (commit.empty() ? "" : " (" + commit + ")");
}

std::string version_number() { return THALWEG_VERSION; }

}  // namespace thalweg::driver
