// The options by which a tool joins the bus of a running cluster: the same as those of a node, with the environment of tactus
// attach as defaults.
#pragma once

#include <CLI/CLI.hpp>

#include "sync/bus/bus_options.h"

namespace tactus::sync {

// --group, --port and --ttl; TACTUS_GROUP, TACTUS_PORT and TACTUS_TTL are their defaults.
void add_bus_options(CLI::App& app, BusOptions& options);

}  // namespace tactus::sync
