// The variables that a page offers: every number of every message, and all known tagged variables. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tactus::live {

// [{"name": "TOOL_STATE:force_N.z", "unit": "N", "about": ...}, ...] of all channels with regular messages. A list is
// represented by its first element; other elements can be requested by name.
nlohmann::json field_catalog();

}  // namespace tactus::live
