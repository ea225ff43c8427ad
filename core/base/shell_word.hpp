// Advice that can be pasted.
#pragma once

#include <string>

namespace thalweg {

// An argument as a shell takes it, in single quotes where it needs them; in one line and without control characters:
// bash's $'re\033d' where it has some.
std::string shell_word(const std::string& text);

}  // namespace thalweg
