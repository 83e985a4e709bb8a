// Runs libsdformat on a scene without console output; its errors become one exception.
#pragma once

#include <memory>

#include <sdf/Root.hh>

#include "sim_node/scene/sdf/sdf_files.h"

namespace tactus::sim {

// Throws std::runtime_error with libsdformat's first message, its file and its line. Not thread-safe: libsdformat's
// configuration and console are global.
std::unique_ptr<sdf::Root> read_sdf(const SdfFiles& files);

}  // namespace tactus::sim
