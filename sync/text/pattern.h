// Regular expressions by which a user selects names. pattern.cpp alone includes <regex>, because its templates compile for several seconds.
#pragma once

#include <memory>
#include <string>

namespace tactus::sync {

class Pattern {
 public:
  // expression: POSIX extended. Throws std::invalid_argument if it is none.
  explicit Pattern(const std::string& expression);
  // Whether it matches the whole text. Thread-safe; not real-time safe.
  bool matches(const std::string& text) const;

 private:
  struct Compiled;
  std::shared_ptr<const Compiled> compiled_;
};

}  // namespace tactus::sync
