// Text that came over the bus or out of a file, made fit for a terminal. Pure.
#pragma once

#include <string>
#include <string_view>

namespace tactus::sync {

// Control characters, which would be orders to the terminal, and bytes that are no UTF-8 become \xNN; all else stays. A text is
// one line: a line break is escaped too.
std::string printable(std::string_view text);

}  // namespace tactus::sync
