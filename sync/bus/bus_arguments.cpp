#include "sync/bus/bus_arguments.h"

namespace tactus::sync {

void add_bus_options(Arguments& app, BusOptions& options) {
  app.add_option("--group", options.group, "multicast group of the bus").environment("TACTUS_GROUP").show_default();
  app.add_option("--port", options.port, "UDP port of the bus").environment("TACTUS_PORT").range(1, 65534).show_default();
  app.add_option("--ttl", options.ttl, "0: this machine only, 1: this network")
      .environment("TACTUS_TTL")
      .range(0, 255)
      .show_default();
}

}  // namespace tactus::sync
