#include "core/base/shell_word.hpp"

#include "core/base/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string_view>

namespace thalweg {
namespace {

bool has_control_characters(std::string_view text) {
  for (; !text.empty(); text.remove_prefix(1))
    if (control_character(text)) return true;
  return false;
}

// As $'...', with octal numbers for all but printable ASCII.
std::string in_octal(const std::string& text) {
  std::string quoted = "$'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    quoted += byte < 0x20 || byte > 0x7E || c == '\'' || c == '\\' ? fmt::format("\\{:03o}", byte) : std::string(1, c);
  }
  return quoted + "'";
}

}  // namespace

std::string shell_word(const std::string& text) {
  if (has_control_characters(text)) return in_octal(text);
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("_./:=+,@%-", c) != nullptr; };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace thalweg
