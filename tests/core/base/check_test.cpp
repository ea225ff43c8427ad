#include "core/base/check.hpp"

#include "core/base/error.hpp"

#include <gtest/gtest.h>

namespace thalweg::check_test {
namespace {

TEST(Check, LetsPassWhatHolds) {
  int calls = 0;
  CHECK(++calls == 1);
  EXPECT_EQ(calls, 1);  // evaluated once
}

TEST(Check, SaysWhichContractIsBrokenAndWhere) {
  const int slots = 3;
  const int line = __LINE__ + 2;
  try {
    CHECK(slots == 4);
    FAIL() << "nothing thrown";
  } catch (const ContractError& error) {
    EXPECT_EQ(std::string(error.what()),
              "The program contradicts itself: \"slots == 4\" does not hold at check_test.cpp:" + std::to_string(line) +
                  ". Please report this with the case file.");
  }
}

// The user cannot mend it: it is neither InputError (exit code 2) nor a failure of a healthy program.
TEST(Check, ThrowsAnErrorOfTheProgram) {
  EXPECT_THROW(CHECK(false), std::logic_error);
  try {
    CHECK(false);
  } catch (const InputError&) {
    FAIL() << "an error of the user";
  } catch (const std::exception&) {
  }
}

}  // namespace
}  // namespace thalweg::check_test
