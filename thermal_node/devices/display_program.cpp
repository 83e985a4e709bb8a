// thermal_device: a thermal display as a separate program, behind the two messages of `device=external`, at 100
// Hz. Its Peltier element is simulated; to drive a real one, replace `plate` by its driver.
//
//   in   THERMAL_STATE    command for the plate of its tool
//   out  THERMAL_DEVICE   every tick
//
// DisplayGuard is the last check before the plate: it follows one sender, keeps range, slew and duration of warmth
// and cold for any command, and returns the plate to neutral when THERMAL_STATE is missing for 0.3 s, is dated
// ahead or comes from two programs. Its limits are the settings of thermal_node (--set); give both programs the
// same. The exposure of the person survives a restart, in the file --exposure.
//
// The contract: read THERMAL_STATE of your tool; apply your own limits to it; answer with THERMAL_DEVICE. Both are
// in lcmtypes/ and begin with header_t; sync::Bus fills and checks it here. In another language fill it by hand:
// run_id and clock as in the THERMAL_STATE that you answer if you run on its machine, source and incarnation of
// your own, seq counting up from 0, publish_time_ns of CLOCK_MONOTONIC.
#include "thermal_node/devices/display_program.h"

#include <cmath>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>

#include "sync/node/node.h"
#include "sync/node/renderer.h"
#include "thermal_node/devices/display_guard.h"
#include "thermal_node/devices/dose_file.h"
#include "thermal_node/devices/external.h"
#include "thermal_node/devices/simulated_peltier.h"
#include "thermal_node/settings.gen.h"

using namespace tactus;

int thermal::run_display(int argc, char** argv) try {
  const sync::NodeDescriptor descriptor{
      .name = "thermal_device",
      .modality = "",
      .rate_Hz = 100,
      .about = "A thermal display behind two messages: an example, with a simulated element."};
  sync::Arguments app;
  sync::NodeOptions options;
  options.add_to(app, descriptor);
  int tool = 0;
  std::string exposure;
  app.add_option("--tool", tool, "index of the tool that carries the display").range(0, 1000);
  app.add_option("--exposure", exposure,
                 "file that keeps the exposure of the skin across restarts; default: NODE.dose in --out");
  sync::parse_or_exit(app, descriptor.name, argc, argv);
  const thermal::Settings settings = sync::settings_of(thermal::setting_fields(), "thermal_node", options.set);

  sync::Node node(descriptor, options);
  auto& commands = node.bus().queue<thermal_state_t>(channels::kThermalState, 64);
  const sync::Identity& identity = node.bus().identity();
  thermal::DisplayGuard guard(settings, tool, options.run_id, identity.clock);
  thermal::SimulatedPeltier plate({}, {}, settings.skin_rest_degC);
  thermal::DoseFile file(exposure.empty() ? thermal::default_dose_file(options.out, identity.node) : exposure,
                         identity.clock);
  guard.resume(file.load(sync::host_now()));
  std::optional<thermal::PlateReading> reading;
  node.set_state(node_health_t::WAITING, "waits for THERMAL_STATE");

  while (node.running()) {
    const sync::HostTime now = node.wait();
    while (const auto m = commands.pop()) guard.receive(m->message, m->arrival);
    const thermal::GuardedTarget target =
        guard.step(reading ? std::optional(reading->plate_degC) : std::nullopt, now);
    file.save(guard.account_after(thermal::DoseFile::kAhead_s), now);
    // A target that is not a number switches the element off.
    reading = plate.step(target.off ? std::nan("") : target.target_degC, target.load_W, now);
    if (guard.has_command())
      node.set_state(target.problem ? node_health_t::INPUT_LOST : node_health_t::RUNNING,
                     target.problem ? target.problem : file.problem());
    if (!reading) continue;
    reading->limited = reading->limited || target.limited;
    thermal_device_t message = thermal::to_message(*reading, tool);
    node.bus().publish(channels::kThermalDevice, message);
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("thermal_device", e);
}
