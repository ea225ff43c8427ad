// JSON as the standard wants it (RFC 8259), in the order it was given.
#include "io/files/json_object.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace thalweg::io::json_object_test {
namespace {

JsonObject example() {
  JsonObject phases;
  phases.set("fluid", 1.5).set("grains", 0.25);
  JsonObject object;
  object.set("state", "finished");
  object.set("steps", std::int64_t{1500000});
  object.set("nan", std::numeric_limits<double>::quiet_NaN());
  object.set("good", true);
  object.set("text", "a \"quote\", a \\ and a\nline");
  object.set("wall_seconds", phases);
  object.set("list", std::vector<double>{0.1, -2e-30});
  object.set("none", JsonObject());
  object.set("steps", 7);
  return object;
}

TEST(JsonObject, OnOneLine) {
  EXPECT_EQ(example().line(),
            "{\"state\": \"finished\", \"steps\": 7, \"nan\": null, \"good\": true, "
            "\"text\": \"a \\\"quote\\\", a \\\\ and a\\u000aline\", "
            "\"wall_seconds\": {\"fluid\": 1.5, \"grains\": 0.25}, \"list\": [0.1, -2e-30], \"none\": {}}");
}

TEST(JsonObject, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(JsonObject().set("r\xFCn", "caf\xE9").line(), "{\"r\xEF\xBF\xBDn\": \"caf\xEF\xBF\xBD\"}");
}

TEST(JsonObject, Indented) {
  JsonObject outer;
  JsonObject middle;
  middle.set("inner", JsonObject().set("x", 1));
  outer.set("a", 0.5).set("middle", middle);
  EXPECT_EQ(outer.text(), "{\n  \"a\": 0.5,\n  \"middle\": {\n    \"inner\": {\n      \"x\": 1\n    }\n  }\n}");
}

}  // namespace
}  // namespace thalweg::io::json_object_test
