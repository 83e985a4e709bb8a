// Arbitrary text read as each of the small text formats: tables of materials, modes, loudspeakers, walls and motions, string frames,
// devices, plots, overlays and quantities. Each is rejected with one sentence or parsed.
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "audio_node/spatial/layout.h"
#include "haptic_node/devices/selection/make_device.h"
#include "haptic_node/devices/motion_file.h"
#include "haptic_node/devices/spidar/frame_file.h"
#include "lcmtypes/tool_device.h"
#include "sim_node/scene/materials/materials.h"
#include "sim_node/model/measured_modes.h"
#include "sync/text/csv.h"
#include "sync/playout/policy.h"
#include "sync/text/settings.h"
#include "visual_node/lens/wall.h"
#include "visual_node/overlay/overlay_set.h"
#include "visual_node/overlay/plot_spec.h"

namespace {

// A rejection is a std::exception with one sentence; anything else aborts.
template <class Read>
void expect_no_crash(Read&& read) {
  try {
    read();
  } catch (const std::runtime_error& e) {
    if (*e.what() == 0) std::abort();
  } catch (const std::invalid_argument& e) {
    if (*e.what() == 0) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus;
  const std::string text(reinterpret_cast<const char*>(data), size);
  expect_no_crash([&] { sim::parse_materials(text); });
  expect_no_crash([&] { sim::parse_measured_modes(text); });
  expect_no_crash([&] { audio::parse_layout(text, "fuzz.csv"); });
  expect_no_crash([&] { visual::parse_room(text, "fuzz.csv"); });
  expect_no_crash([&] { haptic::parse_frame(text, "fuzz.json"); });
  expect_no_crash([&] {
    std::istringstream in(text);
    haptic::read_motion(in, "fuzz.csv");
  });
  expect_no_crash([&] { parse_tool_device(text); });
  expect_no_crash([&] { visual::parse_overlays(text); });
  expect_no_crash([&] { visual::parse_plot(text); });
  std::vector<std::string> trouble;
  visual::parse_plots(text, trouble);
  expect_no_crash([&] {
    if (!std::isfinite(sync::parse_quantity(text, "s"))) std::abort();
  });
  expect_no_crash([&] { sync::parse_duration(text); });
  sync::csv_cells(text);
  if (const auto number = sync::csv_number(text); number && !std::isfinite(*number)) std::abort();
  return 0;
}
