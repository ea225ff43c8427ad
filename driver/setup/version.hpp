// Version of the program.
#pragma once

#include <string>

namespace thalweg::driver {

// e.g. "0.1.0 (a647374)" or "0.1.0 (a647374, modified)": version of the project and the commit it was built from, as
// far as git knew.
std::string version_text();

// "0.1.0" alone.
std::string version_number();

}  // namespace thalweg::driver
