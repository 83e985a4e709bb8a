// What a page may choose from: every number of every message, and all tagged variables that are known. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lcmtypes/fields.h"

namespace tactus::live {

// [{"name": "TOOL_STATE:force_N.z", "unit": "N", "about": ...}, ...] of all channels that run often. Of a list its first
// element; any other can be asked for by hand.
nlohmann::json field_catalog();

}  // namespace tactus::live
