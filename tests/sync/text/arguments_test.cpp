// Tests of command lines: the types of values, refusals, defaults, the help, and commands.
#include "sync/text/arguments.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

using namespace tactus::sync;
using Catch::Contains;
using Texts = std::vector<std::string>;

namespace {

std::optional<std::string> parse(Arguments& app, const Texts& words) {
  std::vector<const char*> argv{"program"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  return app.parse(static_cast<int>(argv.size()), argv.data());
}

// The sentence of the refusal; empty: accepted.
std::string refusal(Arguments& app, const Texts& words) try {
  parse(app, words);
  return "";
} catch (const ArgumentError& e) {
  return e.what();
}

// A program with one option of an initial value.
template <class Value>
struct Program {
  explicit Program(Value initial = {}) : value(std::move(initial)), option(app.add_option("--value", value, "meaning")) {}
  std::string refused(const std::string& text) { return refusal(app, {"--value", text}); }
  std::string help() { return parse(app, {"--help"}).value(); }

  Value value;
  Arguments app;
  Argument option;
};

template <class Value>
Value parsed(const std::string& text) {
  Program<Value> program;
  parse(program.app, {"--value", text});
  return program.value;
}

}  // namespace

TEST_CASE("An option has the type of its variable") {
  CHECK(parsed<int>("-7") == -7);
  CHECK(parsed<double>("1.5e-3") == 1.5e-3);
  CHECK(parsed<std::int64_t>("9000000000") == 9'000'000'000);
  CHECK(parsed<std::uint64_t>("18446744073709551615") == UINT64_MAX);
  CHECK(parsed<std::string>("a b") == "a b");
  CHECK(parsed<std::optional<double>>("2.5") == 2.5);
  CHECK(parsed<std::optional<std::int64_t>>("3") == 3);
  CHECK(parsed<std::optional<std::string>>("text") == "text");
  CHECK(parsed<std::vector<double>>("4") == std::vector<double>{4});
  CHECK(parsed<Texts>("one") == Texts{"one"});
}

TEST_CASE("A value of another type is refused in a sentence") {
  CHECK(Program<int>().refused("1.5") == "Could not convert: --value = 1.5");
  CHECK(Program<double>().refused("much") == "Could not convert: --value = much");
}

TEST_CASE("A variable keeps its value without its option") {
  Program<int> program(5);
  Program<std::optional<double>> optional;
  parse(program.app, {});
  parse(optional.app, {});
  CHECK(program.value == 5);
  CHECK_FALSE(optional.value);
}

TEST_CASE("An unknown option and a missing argument are refused") {
  Program<int> program;
  std::string file;
  CHECK(refusal(program.app, {"--nonsense"}) == "The following argument was not expected: --nonsense");
  program.app.add_option("FILE", file, "a file").required();
  CHECK(refusal(program.app, {}) == "FILE is required");
  CHECK(refusal(program.app, {"a.csv"}) == "");
  CHECK(file == "a.csv");
}

TEST_CASE("A number outside its range is refused") {
  Program<int> count;
  count.option.range(1, 9);
  CHECK(count.refused("9") == "");
  CHECK(count.refused("10") == "--value: Value 10 not in range 1 to 9");
  Program<double> share;
  share.option.range(0.0, 0.5);
  CHECK(share.refused("0.5") == "");
  CHECK_THAT(share.refused("0.6"), Contains("--value: Value 0.6 not in range"));
  Program<double> length;
  length.option.positive();
  CHECK(length.refused("0.1") == "");
  CHECK_FALSE(length.refused("0").empty());
}

TEST_CASE("A word outside its list is refused") {
  Program<std::string> program;
  program.option.one_of({"require", "try", "off"});
  CHECK(program.refused("try") == "");
  CHECK(program.refused("maybe") == "--value: maybe not in {require,try,off}");
}

TEST_CASE("A path that does not exist or is of the wrong kind is refused") {
  const std::string file = std::filesystem::canonical("/proc/self/exe").string();
  const std::string folder = std::filesystem::path(file).parent_path().string();
  Program<std::string> files, folders, paths;
  files.option.existing_file();
  folders.option.existing_folder();
  paths.option.existing_path();
  CHECK(files.refused(file) == "");
  CHECK_FALSE(files.refused(folder).empty());
  CHECK(folders.refused(folder) == "");
  CHECK_FALSE(folders.refused(file).empty());
  CHECK(paths.refused(file) == "");
  CHECK(paths.refused(folder) == "");
  CHECK(paths.refused("/nonexistent") == "--value: Path does not exist: /nonexistent");
}

TEST_CASE("A list takes several values, up to a number, or one for each use") {
  Texts all, split, one;
  std::vector<double> three;
  bool flag = false;
  Arguments app;
  app.add_option("--all", all);
  app.add_option("--split", split).delimiter(',');
  app.add_option("--one", one).one_value_per_use();
  app.add_option("--three", three).expected(3);
  app.add_flag("--flag", flag, "a flag");
  CHECK(refusal(app, {"--all", "a", "b", "--split", "c,d", "--one", "e", "--one", "f", "--three", "1", "2", "3", "--flag"}) == "");
  CHECK(all == Texts{"a", "b"});
  CHECK(split == Texts{"c", "d"});
  CHECK(one == Texts{"e", "f"});
  CHECK(three == std::vector<double>{1, 2, 3});
  CHECK(flag);
  CHECK(refusal(app, {"--one", "e", "f"}) == "The following argument was not expected: f");
  CHECK_THAT(refusal(app, {"--three", "1", "2"}), Contains("--three"));
  app.option("--three").expected(1, 2);
  CHECK(refusal(app, {"--three", "1", "2"}) == "");
}

TEST_CASE("A variable of the environment replaces the default and is checked like an option") {
  Program<int> program(1);
  program.option.environment("TACTUS_ARGUMENTS_TEST").range(1, 9);
  setenv("TACTUS_ARGUMENTS_TEST", "4", 1);
  parse(program.app, {});
  CHECK(program.value == 4);
  parse(program.app, {"--value", "5"});
  CHECK(program.value == 5);
  setenv("TACTUS_ARGUMENTS_TEST", "10", 1);
  CHECK_THAT(refusal(program.app, {}), Contains("not in range 1 to 9"));
  unsetenv("TACTUS_ARGUMENTS_TEST");
}

TEST_CASE("An option may need another one or exclude it") {
  std::string log, wav, device;
  Arguments app;
  app.add_option("--log", log);
  app.add_option("--wav", wav).needs("--log");
  app.add_option("--device", device);
  app.option("--log").excludes("--device");
  CHECK(refusal(app, {"--wav", "a"}) == "--wav requires --log");
  CHECK(refusal(app, {"--wav", "a", "--log", "b"}) == "");
  CHECK(refusal(app, {"--device", "a", "--log", "b"}) == "--log excludes --device");
}

TEST_CASE("The help lists options with type, range, default and environment, and no hidden option") {
  Program<int> program(1234);
  double load = 0;
  program.app.description("Does it.");
  program.option.range(1, 9000).environment("TACTUS_ARGUMENTS_TEST").show_default();
  program.app.add_option("--load", load).hidden();
  const std::string help = program.help();
  CHECK_THAT(help, Contains("Does it.") && Contains("Usage: program [OPTIONS]") && Contains("meaning"));
  CHECK_THAT(help, Contains("--value INT:INT in [1 - 9000]") && Contains("1234") && Contains("(Env:TACTUS_ARGUMENTS_TEST)"));
  CHECK_THAT(help, !Contains("--load"));
}

TEST_CASE("A program with commands takes exactly one, with its own arguments") {
  int port = 0, steps = 1;
  Arguments app("about");
  app.add_option("--port", port);
  app.add_command("pause", "pauses the world");
  app.add_command("step", "steps the world").add_option("N", steps).range(1, 1000).show_default();
  CHECK(refusal(app, {"step", "7", "--port", "8"}) == "");  // an option of the program after the command
  CHECK(app.command() == "step");
  CHECK(steps == 7);
  CHECK(port == 8);
  CHECK(refusal(app, {"pause"}) == "");
  CHECK(app.command() == "pause");
  CHECK(refusal(app, {}) == "A subcommand is required");
  CHECK_FALSE(refusal(app, {"pause", "step"}).empty());
  CHECK_FALSE(refusal(app, {"step", "0"}).empty());
  CHECK_THAT(parse(app, {"step", "--help"}).value(), Contains("N INT:INT in [1 - 1000]"));
}
