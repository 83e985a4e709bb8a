// The files and folders that settings name, for --check.
#pragma once

#include "visual_node/settings.gen.h"

namespace tactus::visual {

// Throws std::runtime_error with one sentence about the first file or folder that cannot be used.
void check_named_files(const Settings& settings);

}  // namespace tactus::visual
