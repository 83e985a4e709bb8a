// Escapes text from the bus or from files for a terminal. Pure.
#pragma once

#include <string>
#include <string_view>

namespace tactus::sync {

// Control characters, which a terminal would execute, and invalid UTF-8 become \xNN; all else stays. The result is one line:
// line breaks are escaped, too.
std::string printable(std::string_view text);

}  // namespace tactus::sync
