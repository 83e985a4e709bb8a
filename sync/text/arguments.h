// The command line of a program: options, flags, positional arguments and commands, bound to variables. CLI11 parses it;
// arguments.cpp alone includes CLI11, because its templates compile for several seconds.
//
//   double period_s = 1;
//   sync::Arguments app("Shows the state of every node.");
//   app.add_option("--period", period_s, "seconds between two tables").range(0.05, 3600.0).show_default();
//   sync::parse_or_exit(app, "watch", argc, argv);
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tactus::sync {

// A wrong command line, in one sentence.
struct ArgumentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// An option, a flag or a positional argument of a program. Copies refer to the same one.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  // The user must give it.
  Argument required() const;
  // Each value is a number in [min, max].
  Argument range(int min, int max) const;
  Argument range(double min, double max) const;
  // Each value is a number above 0.
  Argument positive() const;
  // Each value is one of these words.
  Argument one_of(const std::vector<std::string>& words) const;
  // Each value is the path of an existing file, of an existing folder, or of either.
  Argument existing_file() const;
  Argument existing_folder() const;
  Argument existing_path() const;
  // The number of values.
  Argument expected(int count) const;
  Argument expected(int min, int max) const;
  // One value for each use: `--to A --to B`, not `--to A B`.
  Argument one_value_per_use() const;
  // Also splits a value at this character.
  Argument delimiter(char character) const;
  // This variable of the environment is the default.
  Argument environment(const std::string& variable) const;
  // The help shows the value that the variable has now.
  Argument show_default() const;
  // The help does not list it.
  Argument hidden() const;
  // It is valid only with, or only without, another option, which is added before.
  Argument needs(const std::string& other) const;
  Argument excludes(const std::string& other) const;

 private:
  CLI::Option* option_;
};

// The command line of a program or of one of its commands. Copies refer to the same one. The variables outlive parse().
class Arguments {
 public:
  // about: the first line of the help.
  explicit Arguments(const std::string& about = "");
  void description(const std::string& about);

  // name: "--name", or "NAME" of a positional argument. Value: int, unsigned, double, std::int64_t, std::uint64_t, std::string,
  // an optional double, std::int64_t or std::string, or a vector of int, double or std::string.
  template <class Value>
  Argument add_option(const std::string& name, Value& value, const std::string& meaning = "");
  Argument add_flag(const std::string& name, bool& value, const std::string& meaning);
  // An option or flag that was added before.
  Argument option(const std::string& name) const;

  // Adds a command with arguments of its own. The user gives exactly one command; options of the program may follow it.
  Arguments add_command(const std::string& name, const std::string& meaning);
  // The name of the given command, after parse().
  std::string command() const;

  // Fills the variables. Returns the help when the user asks for it. Throws ArgumentError.
  std::optional<std::string> parse(int argc, const char* const* argv);

 private:
  explicit Arguments(std::shared_ptr<CLI::App> app);

  std::shared_ptr<CLI::App> app_;
};

}  // namespace tactus::sync
