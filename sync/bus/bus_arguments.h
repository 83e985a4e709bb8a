// The options by which a tool joins the bus of a running cluster: the same as those of a node, with the environment of tactus
// attach as defaults.
#pragma once

#include "sync/bus/bus_options.h"
#include "sync/text/arguments.h"

namespace tactus::sync {

// --group, --port and --ttl; TACTUS_GROUP, TACTUS_PORT and TACTUS_TTL are their defaults.
void add_bus_options(Arguments& app, BusOptions& options);

}  // namespace tactus::sync
