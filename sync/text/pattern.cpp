#include "sync/text/pattern.h"

#include <regex>
#include <stdexcept>

namespace tactus::sync {

struct Pattern::Compiled {
  std::regex expression;
};

Pattern::Pattern(const std::string& expression) try
    : compiled_(std::make_shared<Compiled>(Compiled{std::regex(expression, std::regex::extended | std::regex::optimize)})) {
} catch (const std::regex_error&) {
  throw std::invalid_argument(expression + ": is not a regular expression");
}

bool Pattern::matches(const std::string& text) const { return std::regex_match(text, compiled_->expression); }

}  // namespace tactus::sync
