#include "core/base/error_message.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <new>

namespace thalweg {

std::string error_message(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return "The memory of this machine is not enough for the case.";
  const bool is_a_sentence =
      dynamic_cast<const RunError*>(&error) != nullptr || dynamic_cast<const InputError*>(&error) != nullptr;
  return is_a_sentence ? error.what() : fmt::format("Unexpected error: {}.", error.what());
}

std::string without_full_stop(std::string sentence) {
  if (sentence.ends_with('.')) sentence.pop_back();
  return sentence;
}

}  // namespace thalweg
