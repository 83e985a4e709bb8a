// The sentence of an exception for the user. Thread-safe: yes.
#pragma once

#include <exception>
#include <string>

namespace tactus::sync {

// what(); of an error of the file system: the path, the reason and the remedy, in place of the name of the library function.
std::string error_text(const std::exception& e);

}  // namespace tactus::sync
