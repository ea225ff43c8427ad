// The sentence that tells a user of an exception.
#pragma once

#include <exception>
#include <string>

namespace thalweg {

// That of an InputError or a RunError, or what stands for any other exception.
std::string error_message(const std::exception& error);

}  // namespace thalweg
