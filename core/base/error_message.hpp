// The sentence that tells a user of an exception.
#pragma once

#include <exception>
#include <string>

namespace thalweg {

// That of an InputError or a RunError, or what stands for any other exception.
std::string error_message(const std::exception& error);

// A sentence that goes on in another one.
std::string without_full_stop(std::string sentence);

}  // namespace thalweg
