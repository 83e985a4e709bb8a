// Arbitrary bytes as a datagram of the line between relays, whose message is then received from the bus: every datagram that a relay sends
// can be read at the other end.
#include <cstdlib>

#include "sync/relay/relay.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus::sync;
  static const RelayRules rules = parse_relay_rules(
      "<relay><pass channel='CONTACT_EVENTS' first='true'/><pass channel='NODE_HEALTH' rate='5Hz'/>"
      "<pass channel='WORLD_STATE' deadband='0% position floor=1mm'/><pass channel='CONTACTS' rate='60Hz' deadband='10% force'/>"
      "<pass channel='TOUCH_MODEL' rate='60Hz'/><pass channel='TOOL_STATE' rate='60Hz' deadband='10% velocity'/></relay>",
      "fuzz.xml");
  const auto m = parse_line_datagram({data, size});
  if (!m) return 0;
  if (!m->message.fits() || m->message.channel.empty()) std::abort();
  const auto header_run = [&] {  // the run id in the message's own header, so that the relay accepts it
    std::int64_t run = 0;
    for (std::size_t i = 28; i < 36 && i < m->message.data.size(); ++i) run = static_cast<std::int64_t>(static_cast<std::uint64_t>(run) << 8 | m->message.data[i]);
    return run > 0 ? run : 1;
  }();
  Relay relay(rules, {parse_other_site("127.0.0.1:7700"), parse_other_site("127.0.0.1:7701,64")}, header_run);
  Relay other(rules, {parse_other_site("127.0.0.1:7702")}, header_run);
  const HostTime begin = host_time(3'600'000'000'000);
  for (int i = 0; i < 3; ++i) {
    const HostTime now = begin + Nanoseconds(i * 20'000'000);
    relay.on_bus_message(m->message, m->bulk, now);
    relay.flush(now, [&](const LineEnd&, std::span<const std::uint8_t> bytes) {
      const auto back = parse_line_datagram(bytes);
      if (!back || back->message.channel != m->message.channel || back->bulk != m->bulk) std::abort();
      if (!other.on_line_message(0, *back, now)) std::abort();  // the other relay accepts each datagram that a relay sends
      return true;
    });
  }
  return 0;
}
