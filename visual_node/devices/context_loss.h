// Whether the device still knows what it was given. A driver that was reset, updated or taken away forgets it all.
#pragma once

#include <string>

namespace tactus::visual {

// Of the context that is current: why it is no more, as a clause; empty: it is there, as far as the driver tells.
std::string why_context_is_lost();

}  // namespace tactus::visual
