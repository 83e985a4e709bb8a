// The sentence of an exception for the user. Thread-safe: yes.
#pragma once

#include <exception>
#include <string>

namespace tactus::sync {

// what() of an exception of this system. An exception of a library names a function of it instead: of an error of the file system, the path,
// the reason and the remedy; of the system, of memory and of nlohmann::json, the reason and the remedy.
std::string error_text(const std::exception& e);

}  // namespace tactus::sync
