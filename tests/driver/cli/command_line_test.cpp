#include "driver/cli/command_line.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace thalweg::driver::command_line_test {
namespace {

CommandLine parse(std::vector<const char*> words) {
  words.insert(words.begin(), "thalweg");
  return parse_command_line(static_cast<int>(words.size()), words.data());
}

TEST(CommandLine, RunTakesEveryOptionInAnyOrder) {
  const CommandLine line =
      parse({"run", "--set", "fluid.time_step=1e-5", "a/case.yaml", "--set", "name=x y", "--out", "b", "--restart", "c",
             "--until", "2.5", "--walltime", "01:02:03", "--layout", "4,2,1", "--overwrite"});
  ASSERT_TRUE(line.command) << line.text;
  const Command& command = *line.command;
  EXPECT_EQ(command.kind, Command::Kind::run);
  EXPECT_EQ(command.path, "a/case.yaml");
  EXPECT_EQ(command.settings, (std::vector<std::string>{"fluid.time_step=1e-5", "name=x y"}));
  EXPECT_EQ(command.out, "b");
  EXPECT_EQ(command.restart, "c");
  EXPECT_EQ(command.until, 2.5);
  EXPECT_EQ(command.walltime, 3723.0);
  EXPECT_EQ(command.layout, (Index3{4, 2, 1}));
  EXPECT_TRUE(command.overwrite);
}

TEST(CommandLine, RefusesWhatOptionsCannotMean) {
  for (const char* until : {"-1", "0", "nan"}) {
    const CommandLine line = parse({"run", "case.yaml", "--until", until});
    EXPECT_EQ(line.exit_code, 2);
    EXPECT_NE(line.text.find("--until"), std::string::npos) << line.text;
  }
  const CommandLine line = parse({"run", "case.yaml", "--out", ""});
  EXPECT_EQ(line.exit_code, 2);
  EXPECT_NE(line.text.find("--out is empty"), std::string::npos) << line.text;
}

// The line that a run is known by can be given to a shell again.
TEST(CommandLine, QuotesWordsAsAShellDoes) {
  EXPECT_EQ(shell_word("run/a-1.yaml"), "run/a-1.yaml");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("mein lauf"), "'mein lauf'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("caf\xC3\xA9"), "'caf\xC3\xA9'");
  // In one line, and without what case.yaml, which has the line as a comment, could not hold.
  EXPECT_EQ(shell_word("it's\n\\2\x1B"), "$'it\\047s\\012\\1342\\033'");
  EXPECT_EQ(shell_word("d\xC2\x80"), "$'d\\302\\200'");
  EXPECT_EQ(parse({"run", "my case.yaml", "--set", "a={b: 1}"}).command->line,
            "thalweg run 'my case.yaml' --set 'a={b: 1}'");
}

TEST(CommandLine, KnowsItsFourCommands) {
  EXPECT_EQ(parse({"check", "case.yaml"}).command->kind, Command::Kind::check);
  EXPECT_EQ(parse({"defaults"}).command->kind, Command::Kind::defaults);
  EXPECT_EQ(parse({"defaults", "grains"}).command->system, "grains");
  EXPECT_EQ(parse({"info", "run"}).command->path, "run");
  EXPECT_EQ(parse({"info", "--csv", "a", "b"}).command->runs, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(parse({"info", "a", "b"}).exit_code, 2);
}

TEST(CommandLine, HelpAndVersionEndWithZero) {
  const CommandLine help = parse({"--help"}), version = parse({"--version"});
  EXPECT_FALSE(help.command);
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.text.find("mpirun -n 8 thalweg run"), std::string::npos);
  EXPECT_EQ(parse({"run", "--help"}).exit_code, 0);
  for (const char* command : {"run", "new", "check", "defaults", "info", "stop"}) {  // each ends with its own examples
    const std::string text = parse({command, "--help"}).text, own = std::string("thalweg ") + command + " ";
    std::istringstream examples(text.substr(text.find("\nExamples:\n") + 11));
    int count = 0;
    for (std::string line; std::getline(examples, line) && line.starts_with("  "); ++count)
      EXPECT_NE(line.find(own), std::string::npos) << line;
    EXPECT_GT(count, 0) << text;
    EXPECT_EQ(text.find("Exit codes:") != std::string::npos, own == "thalweg run ");
  }
  EXPECT_FALSE(version.command);
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.text.rfind("thalweg ", 0), 0u);
}

TEST(CommandLine, AnythingElseIsOneSentenceAndExitCodeTwo) {
  const std::vector<std::vector<const char*>> wrong{{},
                                                    {"fly"},
                                                    {"run"},
                                                    {"run", "a.yaml", "--no-such-option"},
                                                    {"run", "a.yaml", "--until", "soon"},
                                                    {"run", "a.yaml", "--walltime", "12"},
                                                    {"run", "a.yaml", "--walltime", "00:00:00"},
                                                    {"run", "a.yaml", "--walltime=-00:00:01"},
                                                    {"run", "a.yaml", "--layout", "2,2"},
                                                    {"run", "a.yaml", "--layout", "0,1,1"},
                                                    {"check"},
                                                    {"info"}};
  for (const auto& words : wrong) {
    const CommandLine line = parse(words);
    EXPECT_FALSE(line.command);
    EXPECT_EQ(line.exit_code, 2);
    EXPECT_EQ(line.text.find('\n'), std::string::npos) << line.text;
    EXPECT_TRUE(line.text.size() > 10 && line.text.back() == '.') << line.text;
  }
}

TEST(CommandLine, WallTimesAsBatchSystemsWriteThem) {
  EXPECT_EQ(parse_walltime("23:50:00"), 85800.0);
  EXPECT_EQ(parse_walltime("48:00:00"), 172800.0);
  EXPECT_EQ(parse_walltime("1-02:00:05"), 93605.0);
  EXPECT_EQ(parse_walltime("2:30"), 150.0);
  EXPECT_THROW(parse_walltime("1:2:3:4"), InputError);
  EXPECT_THROW(parse_walltime("-1:00:00"), InputError);
}

}  // namespace
}  // namespace thalweg::driver::command_line_test
