// Text according to RFC 3629, and the treatment of other bytes.
#include "core/base/utf8.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace thalweg::utf8_test {
namespace {

const std::string replaced = "\xEF\xBF\xBD";

TEST(Utf8, TextOfAllLengthsIsLeftAlone) {
  // U+007F, U+0080, U+07FF, U+0800, U+D7FF, U+E000, U+FFFF, U+10000, U+10FFFF: the ends of the ranges of section 3.
  for (const char* good : {"", "bed 1", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                           "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF", "a\xC3\xA9z"}) {
    EXPECT_TRUE(is_utf8(good)) << good;
    EXPECT_EQ(as_utf8(good), good);
  }
}

TEST(Utf8, OtherBytesAreReplaced) {
  // A byte of Latin-1, a character cut off, a lone continuation, "/" in two bytes, a surrogate, beyond U+10FFFF.
  EXPECT_EQ(as_utf8("r\xFCn"), "r" + replaced + "n");
  EXPECT_EQ(as_utf8("r\xC3"), "r" + replaced);
  EXPECT_EQ(as_utf8("\x80"), replaced);
  EXPECT_EQ(as_utf8("\xC0\xAF"), replaced + replaced);
  EXPECT_EQ(as_utf8("\xED\xA0\x80"), replaced + replaced + replaced);
  EXPECT_EQ(as_utf8("\xF4\x90\x80\x80z"), replaced + replaced + replaced + replaced + "z");
  EXPECT_EQ(first_not_utf8("ab\xFF"), 2U);
}

TEST(Utf8, FindsControlCharacters) {
  for (const char* good :
       {" a", "~", "\xC2\xA0", "\xC3\x80", "\xEF\xBF\xBD", "\xEF\xBE\xBE", "\xF0\x9F\x8C\x8A", "\xC2"})
    EXPECT_FALSE(control_character(good)) << good;
  EXPECT_EQ(control_character("\tb"), 0x09U);
  EXPECT_EQ(control_character(std::string_view("\0", 1)), 0x00U);
  EXPECT_EQ(control_character("\x7F"), 0x7FU);
  EXPECT_EQ(control_character("\xC2\x80"), 0x80U);
  EXPECT_EQ(control_character("\xC2\x9F"), 0x9FU);
  EXPECT_EQ(control_character("\xEF\xBF\xBE"), 0xFFFEU);
  EXPECT_EQ(control_character("\xEF\xBF\xBF"), 0xFFFFU);
}

}  // namespace
}  // namespace thalweg::utf8_test
