#include "core/base/utf8.hpp"

#include <array>

namespace thalweg {
namespace {

// The forms of RFC 3629, section 4: the range of the first byte and of the second; all others are 80 to BF.
struct Form {
  unsigned char first, last, second_first, second_last;
  std::size_t length;
};
constexpr std::array<Form, 9> forms{{{0x00, 0x7F, 0, 0, 1},
                                     {0xC2, 0xDF, 0x80, 0xBF, 2},
                                     {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                     {0xE1, 0xEC, 0x80, 0xBF, 3},
                                     {0xED, 0xED, 0x80, 0x9F, 3},
                                     {0xEE, 0xEF, 0x80, 0xBF, 3},
                                     {0xF0, 0xF0, 0x90, 0xBF, 4},
                                     {0xF1, 0xF3, 0x80, 0xBF, 4},
                                     {0xF4, 0xF4, 0x80, 0x8F, 4}}};

// Bytes of the character that a text begins with; 0: it begins with none.
std::size_t length_of_first(std::string_view text) {
  const auto byte = [text](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  for (const Form& form : forms) {
    if (byte(0) < form.first || byte(0) > form.last) continue;
    if (form.length > text.size()) return 0;
    if (form.length > 1 && (byte(1) < form.second_first || byte(1) > form.second_last)) return 0;
    for (std::size_t n = 2; n < form.length; ++n)
      if (byte(n) < 0x80 || byte(n) > 0xBF) return 0;
    return form.length;
  }
  return 0;
}

}  // namespace

std::size_t first_not_utf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = length_of_first(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return at;
}

std::string as_utf8(std::string_view text) {
  constexpr std::string_view replacement = "\xEF\xBF\xBD";
  std::string result;
  while (true) {
    const std::size_t good = first_not_utf8(text);
    result += text.substr(0, good);
    if (good == text.size()) return result;
    result += replacement;
    text.remove_prefix(good + 1);
  }
}

std::optional<unsigned> control_character(std::string_view text) {
  const auto byte = [text](std::size_t n) { return n < text.size() ? static_cast<unsigned char>(text[n]) : 0U; };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return byte(0);
  if (byte(0) == 0xC2 && byte(1) >= 0x80 && byte(1) < 0xA0) return byte(1);
  if (byte(0) == 0xEF && byte(1) == 0xBF && byte(2) >= 0xBE) return 0xFFC0U + (byte(2) & 0x3FU);
  return std::nullopt;
}

}  // namespace thalweg
