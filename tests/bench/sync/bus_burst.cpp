// Sends a burst of numbered messages at full speed, to measure the losses of a running recorder:
//   bus_burst [--count 20000] [--bytes 100] [--channel BURST] [--port N]
// Then `summarise run.lcmlog` prints the number of messages that arrived and the gaps in their numbers; the recorder's health gives the
// number that the kernel dropped.
#include <iostream>
#include <tactus/asset_chunk_t.hpp>

#include "sync/bus/bus.h"
#include "sync/node/node_options.h"

using namespace tactus;

int main(int argc, char** argv) try {
  sync::Arguments app{"Sends a burst of numbered messages as fast as it can."};
  sync::BusOptions options;
  int count = 20000, bytes = 100;
  std::string channel = "BURST";
  app.add_option("--count", count, "messages").show_default();
  app.add_option("--bytes", bytes, "of one message").range(73, 1090).show_default();
  app.add_option("--channel", channel, "channel").show_default();
  app.add_option("--port", options.port, "UDP port of the bus").show_default();
  sync::parse_or_exit(app, "bus_burst", argc, argv);

  sync::Bus bus(sync::Identity::fresh("bus_burst", 1), options);
  asset_chunk_t m{};
  m.header.sim_time_ns = -1;
  m.chunks = 1;
  m.size = bytes - m.getEncodedSize();
  m.data.resize(static_cast<std::size_t>(m.size));
  const sync::HostTime begin = sync::host_now();
  for (int i = 0; i < count; ++i) bus.publish(channel.c_str(), m);
  const double seconds = sync::to_seconds(sync::host_now() - begin);
  std::cout << count << " messages of " << m.getEncodedSize() << " bytes in " << seconds * 1e3 << " ms, " << bus.refused()
            << " refused by the network\n";
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("bus_burst", e);
}
