#include "driver/cli/command_line.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "driver/cli/python_command.hpp"
#include "driver/setup/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace thalweg::driver {

std::vector<std::string> Command::all_settings() const {
  std::vector<std::string> all = settings;
  if (until) all.push_back(fmt::format("run.until={}", *until));
  return all;
}

namespace {

struct Example {
  const char *command, *meaning;  // after "thalweg" or "mpirun ... thalweg"
};
constexpr Example examples[] = {
    {"thalweg new bed.yaml --diameter 0.005 --shields 0.05 --depth 0.03", "a case for an experiment"},
    {"thalweg check cases/quickstart/case.yaml", "what the case means and what it costs"},
    {"thalweg run cases/quickstart/case.yaml --out run/a", "run it on one core"},
    {"thalweg run case.yaml --out run/a --resume", "begin, or continue after any interruption"},
    {"thalweg check case.yaml --ranks 1,16,64,256", "how long it takes on so many ranks (docs/scaling.md)"},
    {"mpirun -n 8 thalweg run case.yaml --walltime 23:50:00 --set fluid.time_step=1e-5", ""},
    {"mpirun -n 4 thalweg run case.yaml --out run/a --restart run/a --until 60", ""},
    {"thalweg info run/a", "how far it has come"},
    {"thalweg info --csv run/* > runs.csv", "the figures of many runs, one row each"},
    {"thalweg stop run/a", "save and end; --resume continues"},
    {"thalweg analyze run/a --from 4", "transport, surface and profiles from its stored output"},
    {"thalweg plot all run/a", "side view, transport rate and profiles (plot --help: more kinds)"},
    {"thalweg report run/a", "all about a run on one page"},
    {"thalweg clump pebble.stl --spheres 20 --scale 0.001", "a clump of spheres for a scanned grain"},
    {"thalweg sweep slopes.yaml", "many runs of one case, into one table (docs/sweep.md)"},
    {"thalweg defaults > all_keys.yaml", "the keys of a case, with default and meaning"},
    {"thalweg defaults coupling.lubrication", "one section of it"}};

constexpr const char* exit_codes =
    "\nExit codes: 0 done; 1 the run failed; 2 the input cannot be run (nothing was written); 3 stopped cleanly by a "
    "signal or\n--walltime (summary.json says which); 4 stopped cleanly by thalweg stop. After 3 and 4, --resume "
    "continues the run.";

// Examples of one command, or of all of them.
std::string footer_of(const std::string& command) {
  std::string text = "Examples:\n";
  for (const Example& example : examples)
    if (command.empty() || std::string(example.command).find("thalweg " + command + " ") != std::string::npos)
      text += *example.meaning ? fmt::format("  {:<50}  {}\n", example.command, example.meaning)
                               : fmt::format("  {}\n", example.command);
  return command.empty() || command == "run" ? text + exit_codes : text.substr(0, text.size() - 1);
}

// CLI11's own validator says "not in range 0.000000 to 179769313486231570...".
CLI::Validator positive_number() {
  return {[](const std::string& text) {
            double value = 0.0;
            return CLI::detail::lexical_cast(text, value) && value > 0.0
                       ? std::string()
                       : fmt::format("{} is not a positive number", text);
          },
          ""};
}

constexpr const char* set_help =
    "Replace one value of the case, e.g. fluid.time_step=1e-5; null removes a key (repeatable)";

struct Texts {
  std::string walltime, layout, sieve;
};

void add_run(CLI::App& app, Command& command, Texts& texts) {
  CLI::App* run = app.add_subcommand("run", "Run a case");
  run->add_option("CASE.yaml", command.path, "The case")->required();
  run->add_option("--out", command.out, "Run folder to write (default: the folder run beside the case file)");
  run->add_option("--set", command.settings, set_help)->allow_extra_args(false)->type_name("KEY.SUB=VALUE");
  run->add_option(
      "--restart", command.restart,
      "Resume from this checkpoint file, or from the latest of this run folder (--resume: the latest of --out)");
  run->add_option("--until", command.until, "Simulated time to stop at in s, instead of the case's run.until");
  run->add_option("--walltime", texts.walltime, "Save the state and stop before this much wall time has passed")
      ->type_name("HH:MM:SS");
  run->add_option("--layout", texts.layout, "Ranks along x, y and z (default: automatic)")->type_name("PX,PY,PZ");
  run->add_flag("--overwrite", command.overwrite, "Replace an existing run folder");
  run->add_flag("--resume", command.resume,
                "Resume from the latest checkpoint of --out, or start if there is none; leave a finished run as it is "
                "(for job scripts)")
      ->excludes("--restart")
      ->excludes("--overwrite");
  run->final_callback([&] { command.kind = Command::Kind::run; });
}

void add_others(CLI::App& app, Command& command) {
  CLI::App* check = app.add_subcommand("check", "Report what a case implies and what it costs, without running it");
  check->add_option("CASE.yaml", command.path, "The case")->required();
  check->add_option("--set", command.settings, set_help)->allow_extra_args(false)->type_name("KEY.SUB=VALUE");
  check
      ->add_option("--ranks", command.ranks,
                   "Predict the cost on these numbers of ranks, one row each (docs/scaling.md)")
      ->delimiter(',')
      ->check(positive_number())
      ->type_name("N,N,...");
  check->add_option("--until", command.until, "Simulated time at which the run is to end, in s, instead of run.until");
  check
      ->add_flag("--solve", command.solve,
                 "Print changes of keys that remove every warning except those that need your decision")
      ->excludes("--ranks");
  check->add_flag("--json", command.json, "Print the figures of the report, its lines and its warnings as JSON")
      ->excludes("--solve")
      ->excludes("--ranks");
  check->add_option("--latency", command.network.latency, "Network latency, s")
      ->check(positive_number())
      ->capture_default_str();
  check->add_option("--bandwidth", command.network.bandwidth, "Network bandwidth per rank, bytes/s")
      ->check(positive_number())
      ->capture_default_str();
  check->final_callback([&] { command.kind = Command::Kind::check; });
  CLI::App* defaults = app.add_subcommand("defaults", "Print the keys of a system with default, unit and meaning");
  defaults->add_option("SYSTEM.SECTION", command.system,
                       "resolved (default), fluid, grains, model_fluid or continuum; a section, e.g. contact; or both, "
                       "e.g. grains.contact; or a preset, zhang2022");
  defaults->add_flag("--schema", command.schema, "Print the JSON schema of a case instead, for editors");
  defaults->final_callback([&] { command.kind = Command::Kind::defaults; });
  CLI::App* info = app.add_subcommand("info", "Show the contents of a run folder or a checkpoint");
  info->add_option("PATH", command.runs, "Run folder or checkpoint file; with --csv any number of run folders")
      ->required();
  info->add_flag("--csv", command.csv,
                 "Print a table with one row per run: every number of the summaries, with its unit");
  info->add_flag("--json", command.json, "Print the same information as JSON")->excludes("--csv");
  info->final_callback([&] { command.kind = Command::Kind::info; });
  CLI::App* stop = app.add_subcommand("stop", "Ask a run to save its state and end");
  stop->add_option("RUN_FOLDER", command.path, "The run folder")->required();
  stop->final_callback([&] { command.kind = Command::Kind::stop; });
  // These are only listed in the help; python_command.hpp runs them.
  for (const PythonCommand& other : python_commands) app.add_subcommand(other.name, other.summary);
}

void add_new(CLI::App& app, Command& command, Texts& texts) {
  Experiment& e = command.experiment;
  CLI::App* add = app.add_subcommand("new", "Write a case from what is known of an experiment");
  add->add_option("CASE.yaml", command.path, "The file to write")->required();
  const auto number = [&](const char* name, auto& value, const char* meaning) {
    add->add_option(name, value, meaning)->check(positive_number());
  };
  number("--diameter", e.diameter, "Diameter of the grains, m; or --sieve");
  add->add_option("--sieve", texts.sieve, "Grading curve: sieves in m and the share of the mass that passes each")
      ->type_name("D:P,D:P,...");
  number("--shields", e.shields_number, "Shields number; two of --shields, --slope and --depth");
  number("--slope", e.slope, "Tangent of the bed's angle");
  number("--depth", e.depth, "Depth of the water above the bed, m");
  number("--width", e.width, "Width between side walls, m (default: periodic across the stream)");
  number("--periodic-width", e.periodic_width, "Width of a box without side walls, m (default: set by the accuracy)");
  number("--length", e.length, "Length of the box, periodic along the stream, m (default: set by the accuracy)");
  number("--layers", e.layers, "Thickness of the bed in diameters (default: 5)");
  number("--density", e.density, "Density of the grains, kg/m^3 (default: 2650)");
  number("--fluid-density", e.given_fluid_density, "Density of the fluid, kg/m^3 (default: 1000, water)");
  number("--viscosity", e.viscosity, "Kinematic viscosity, m^2/s (default: 1e-6, water)");
  add->add_option("--accuracy", e.accuracy,
                  "look (the default): 6 cells across the smallest grain, measure: 10, publish: 15")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Accuracy>{
          {"look", Accuracy::look}, {"measure", Accuracy::measure}, {"publish", Accuracy::publish}}))
      ->type_name("look|measure|publish");
  number("--cores", e.cores, "Cores available (default: 1)");
  number("--hours", e.hours,
         "Hours available; sides of the box that are not given are shortened to fit (default: any)");
  add->final_callback([&] { command.kind = Command::Kind::create; });
}

void add_clump(CLI::App& app, ClumpOrder& order) {
  CLI::App* clump = app.add_subcommand("clump", "Fit a clump of spheres to the surface in an STL file");
  clump->add_option("MESH.stl", order.surface, "The surface of one grain")->required();
  clump->add_option("--spheres", order.spheres, "At most this number of spheres")->check(positive_number());
  clump
      ->add_option("--tolerance", order.tolerance,
                   "Add spheres until the mean distance of the surface from them is no larger than this, in diameters "
                   "of the sphere of equal volume")
      ->check(positive_number());
  clump->add_option("--scale", order.scale, "Length of one unit of the file, m (default: 1)")->check(positive_number());
  clump->add_option("--density", order.density, "Density of the grain, kg/m^3 (default: 2650)")
      ->check(positive_number());
  clump->add_option("--out", order.out, "Write OUT.yaml and OUT.png (default: MESH_clump in the current folder)");
}

// Refuses option values that CLI11 accepts but that have no meaning.
void refuse_nonsense(const CLI::App& app, const Command& command) {
  if (command.until && !(*command.until > 0.0 && std::isfinite(*command.until)))
    throw InputError(fmt::format("--until {:g}: give a simulated time in s, above 0.", *command.until));
  if (command.kind == Command::Kind::run && command.out.empty() && app.get_subcommand("run")->count("--out") > 0)
    throw InputError("--out is empty: give a folder, or omit it for the folder run beside the case file.");
}

void take_info_paths(Command& command) {
  command.path = command.runs.front();
  if (command.runs.size() > 1 && !command.csv)
    throw InputError(
        fmt::format("info describes one run, not {}: give one path, or --csv for a table with one row per run.",
                    command.runs.size()));
}

// CLI11 would only say that a subcommand is missing.
void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), argv[1]) != known.end()) return;
  const std::string last = known.back();
  known.pop_back();
  throw InputError(
      fmt::format("{} is not a command: there are {} and {} (thalweg --help).", argv[1], fmt::join(known, ", "), last));
}

// CLI11's messages are fragments; users get a whole sentence that says where to look.
std::string as_sentence(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
  return message + " (thalweg --help shows what is possible).";
}

}  // namespace

double parse_walltime(const std::string& text) {
  int days = 0, hours = 0, minutes = 0, seconds = 0, end = 0;
  const auto matches = [&](const char* format, auto*... fields) {
    end = 0;
    return std::sscanf(text.c_str(), format, fields..., &end) == sizeof...(fields) &&
           end == static_cast<int>(text.size());
  };
  const bool understood = !text.starts_with('-') && (matches("%d-%d:%2d:%2d%n", &days, &hours, &minutes, &seconds) ||
                                                     (days = 0, matches("%d:%2d:%2d%n", &hours, &minutes, &seconds)) ||
                                                     (hours = 0, matches("%d:%2d%n", &minutes, &seconds)));
  const double total = 86400.0 * days + 3600.0 * hours + 60.0 * minutes + seconds;
  if (!understood || days < 0 || hours < 0 || minutes < 0 || seconds < 0 || seconds > 59 || total <= 0.0)
    throw InputError(fmt::format("--walltime {} is not a time: write HH:MM:SS, e.g. 23:50:00.", text));
  return total;
}

Index3 parse_layout(const std::string& text) {
  Index3 layout{0, 0, 0};
  int end = 0;
  if (std::sscanf(text.c_str(), "%d,%d,%d%n", &layout[0], &layout[1], &layout[2], &end) != 3 ||
      end != static_cast<int>(text.size()) || layout[0] < 1 || layout[1] < 1 || layout[2] < 1)
    throw InputError(
        fmt::format("--layout {} is not a layout: write the numbers of ranks along x, y and z, e.g. 4,2,1.", text));
  return layout;
}

CommandLine parse_command_line(int argc, const char* const* argv) {
  CLI::App app{"Thalweg: particle-resolved flow over a bed of grains", "thalweg"};
  Command command;
  Texts texts;
  app.set_version_flag("--version", "thalweg " + version_text());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  add_run(app, command, texts);
  add_new(app, command, texts);
  add_clump(app, command.clump_order);
  app.get_subcommand("clump")->final_callback([&] { command.kind = Command::Kind::clump; });
  add_others(app, command);
  app.footer(footer_of(""));
  for (CLI::App* sub : app.get_subcommands({})) sub->footer(footer_of(sub->get_name()));
  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    refuse_nonsense(app, command);
    if (!texts.walltime.empty()) command.walltime = parse_walltime(texts.walltime);
    if (!texts.sieve.empty()) command.experiment.sieve = parse_sieve(texts.sieve);
    if (command.kind == Command::Kind::info) take_info_paths(command);
    if (!texts.layout.empty()) command.layout = parse_layout(texts.layout);
  } catch (const CLI::Success& asked) {
    std::ostringstream text;
    app.exit(asked, text, text);
    std::string shown = text.str();
    if (shown.empty() || shown.back() != '\n') shown += '\n';
    return {std::nullopt, shown, 0};
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, as_sentence(error.what()), 2};
  } catch (const InputError& error) {
    return {std::nullopt, error.what(), 2};
  }
  for (int a = 0; a < argc; ++a) command.line += (a == 0 ? "" : " ") + shell_word(argv[a]);
  return {command, "", 0};
}

}  // namespace thalweg::driver
