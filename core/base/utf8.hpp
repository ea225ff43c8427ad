// Text in UTF-8, which YAML, JSON and HDF5 want; names of files may be any bytes but zero.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace thalweg {

// The first byte that is no part of a character of UTF-8; the size of the text if all are. What RFC 3629 excludes
// (surrogates, longer forms than needed, beyond U+10FFFF) is none.
std::size_t first_not_utf8(std::string_view text);

inline bool is_utf8(std::string_view text) { return first_not_utf8(text) == text.size(); }

// The text with U+FFFD in place of every byte that is no part of a character.
std::string as_utf8(std::string_view text);

// The character that a text begins with where it is a control character (below U+0020, U+007F to U+009F) or none at all
// (U+FFFE, U+FFFF): what YAML does not allow, but for tab and line ends. text: in UTF-8, not empty.
std::optional<unsigned> control_character(std::string_view text);

}  // namespace thalweg
