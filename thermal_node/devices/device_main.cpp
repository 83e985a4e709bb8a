// thermal_device: a thermal display as a separate program, behind the two messages of `device=external`, at 100
// Hz. Its Peltier element is simulated; to drive a real one, replace `plate` by its driver.
//
//   in   THERMAL_STATE    command for the plate of its tool
//   out  THERMAL_DEVICE   every tick
//
// When THERMAL_STATE is missing for 0.3 s the plate returns to neutral. Its own limits apply to any command.
//
// The contract: read THERMAL_STATE of your tool; apply your own limits to it; answer with THERMAL_DEVICE. Both are
// in lcmtypes/ and begin with header_t; sync::Bus fills and checks it here. In another language fill it by hand:
// run_id and clock as in the THERMAL_STATE that you answer if you run on its machine, source and incarnation of
// your own, seq counting up from 0, publish_time_ns of CLOCK_MONOTONIC.
#include <tactus/node_health_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>

#include "sync/node/node.h"
#include "sync/node/renderer.h"
#include "thermal_node/devices/external.h"
#include "thermal_node/devices/simulated_peltier.h"
#include "thermal_node/settings.gen.h"

using namespace tactus;

int main(int argc, char** argv) try {
  const sync::NodeDescriptor descriptor{
      .name = "thermal_device",
      .modality = "",
      .rate_Hz = 100,
      .about = "A thermal display behind two messages: an example, with a simulated element."};
  sync::Arguments app;
  sync::NodeOptions options;
  options.add_to(app, descriptor);
  int tool = 0;
  app.add_option("--tool", tool, "index of the tool that carries the display").range(0, 1000);
  sync::parse_or_exit(app, descriptor.name, argc, argv);
  const thermal::Settings settings = sync::settings_of(thermal::setting_fields(), "thermal_node", options.set);

  sync::Node node(descriptor, options);
  auto& commands = node.bus().queue<thermal_state_t>(channels::kThermalState, 64);
  const double neutral_degC = settings.skin_rest_degC;
  thermal::SimulatedPeltier plate({}, {}, neutral_degC);
  thermal_state_t command{};
  command.commanded_degC = static_cast<float>(neutral_degC);
  sync::HostTime last_arrival{};
  node.set_state(node_health_t::WAITING, "waits for THERMAL_STATE");

  while (node.running()) {
    const sync::HostTime now = node.wait();
    while (const auto m = commands.pop())
      if (m->message.tool == tool) command = m->message, last_arrival = m->arrival;
    const bool silent = now - last_arrival > thermal::Device::kSilence;
    const double load_W = silent ? 0 : command.heat_flux_W_m2 * settings.reference_area_m2;
    const auto reading = plate.step(silent ? neutral_degC : command.commanded_degC, load_W, now);
    if (last_arrival != sync::HostTime{})
      node.set_state(silent ? node_health_t::INPUT_LOST : node_health_t::RUNNING,
                     silent ? "no THERMAL_STATE: the plate is neutral" : "");
    if (!reading) continue;
    thermal_device_t message = thermal::to_message(*reading, tool);
    node.bus().publish(channels::kThermalDevice, message);
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("thermal_device", e);
}
