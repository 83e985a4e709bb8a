#include "sync/bus/bus_arguments.h"

namespace tactus::sync {

void add_bus_options(CLI::App& app, BusOptions& options) {
  app.add_option("--group", options.group, "multicast group of the bus")
      ->envname("TACTUS_GROUP")
      ->capture_default_str();
  app.add_option("--port", options.port, "UDP port of the bus")
      ->envname("TACTUS_PORT")
      ->check(CLI::Range(1, 65534))
      ->capture_default_str();
  app.add_option("--ttl", options.ttl, "0: this machine only, 1: this network")
      ->envname("TACTUS_TTL")
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
}

}  // namespace tactus::sync
