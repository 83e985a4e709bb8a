#include "sync/text/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace tactus::sync {
namespace {

// CLI::Range, whose sentence differs between versions of CLI11.
template <class Number>
CLI::Validator in_range(Number min, Number max) {
  CLI::Validator range = CLI::Range(min, max);
  const auto check = [range, min, max](std::string& value) {
    std::ostringstream refusal;
    if (!range(value).empty()) refusal << "Value " << value << " not in range " << min << " to " << max;
    return refusal.str();
  };
  return {check, range.get_description()};
}

// CLI11 2.4 leaves the default when a variable of the environment is not valid, and says nothing. Throws CLI::ParseError.
void refuse_variables(CLI::App& app) {
  for (CLI::Option* option : app.get_options([](CLI::Option* o) { return o->count() == 0 && !o->get_envname().empty(); })) {
    const char* value = std::getenv(option->get_envname().c_str());
    if (!value || !*value) continue;
    option->add_result(value);
    option->run_callback();
  }
  for (CLI::App* command : app.get_subcommands()) refuse_variables(*command);
}

}  // namespace

Argument Argument::required() const { return Argument(option_->required()); }
Argument Argument::range(int min, int max) const { return Argument(option_->check(in_range(min, max))); }
Argument Argument::range(double min, double max) const { return Argument(option_->check(in_range(min, max))); }
Argument Argument::positive() const { return Argument(option_->check(CLI::PositiveNumber)); }
Argument Argument::one_of(const std::vector<std::string>& words) const { return Argument(option_->check(CLI::IsMember(words))); }
Argument Argument::existing_file() const { return Argument(option_->check(CLI::ExistingFile)); }
Argument Argument::existing_folder() const { return Argument(option_->check(CLI::ExistingDirectory)); }
Argument Argument::existing_path() const { return Argument(option_->check(CLI::ExistingPath)); }
Argument Argument::expected(int count) const { return Argument(option_->expected(count)); }
Argument Argument::expected(int min, int max) const { return Argument(option_->expected(min, max)); }
Argument Argument::one_value_per_use() const { return Argument(option_->allow_extra_args(false)); }
Argument Argument::delimiter(char character) const { return Argument(option_->delimiter(character)); }
Argument Argument::environment(const std::string& variable) const { return Argument(option_->envname(variable)); }
Argument Argument::show_default() const { return Argument(option_->capture_default_str()); }
Argument Argument::hidden() const { return Argument(option_->group("")); }
Argument Argument::needs(const std::string& other) const { return Argument(option_->needs(other)); }
Argument Argument::excludes(const std::string& other) const { return Argument(option_->excludes(other)); }

Arguments::Arguments(const std::string& about) : app_(std::make_shared<CLI::App>(about)) {}

Arguments::Arguments(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}

void Arguments::description(const std::string& about) { app_->description(about); }

template <class Value>
Argument Arguments::add_option(const std::string& name, Value& value, const std::string& meaning) {
  return Argument(app_->add_option(name, value, meaning));
}
template Argument Arguments::add_option(const std::string&, int&, const std::string&);
template Argument Arguments::add_option(const std::string&, unsigned&, const std::string&);
template Argument Arguments::add_option(const std::string&, double&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::int64_t&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::uint64_t&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::string&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::optional<double>&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::optional<std::int64_t>&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::vector<int>&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::vector<double>&, const std::string&);
template Argument Arguments::add_option(const std::string&, std::vector<std::string>&, const std::string&);

Argument Arguments::add_flag(const std::string& name, bool& value, const std::string& meaning) {
  return Argument(app_->add_flag(name, value, meaning));
}

Argument Arguments::option(const std::string& name) const { return Argument(app_->get_option(name)); }

Arguments Arguments::add_command(const std::string& name, const std::string& meaning) {
  app_->require_subcommand(1);
  app_->fallthrough();
  return Arguments(std::shared_ptr<CLI::App>(app_, app_->add_subcommand(name, meaning)));
}

std::string Arguments::command() const { return app_->get_subcommands().front()->get_name(); }

std::optional<std::string> Arguments::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    refuse_variables(*app_);
  } catch (const CLI::CallForHelp& e) {
    std::ostringstream help;
    app_->exit(e, help);
    return help.str();
  } catch (const CLI::ParseError& e) {
    throw ArgumentError(e.what());
  }
  return std::nullopt;
}

}  // namespace tactus::sync
