// Arbitrary bytes read as a log of the inputs of touch: its pages are assembled and a hand renders them. No message makes the force exceed
// the limit.
#include <cmath>
#include <cstdlib>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/devices/recorded_hand.h"
#include "haptic_node/rendering/session.h"
#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/log/log_reader.h"
#include "sync/resampling/event_inbox.h"
#include "tests/haptic_node/support/node_config.h"

using namespace tactus;
using namespace tactus::haptic;

namespace {

constexpr std::int64_t kRun = 7;
constexpr std::int32_t kClock = 4711;

scene_t one_hand() {
  scene_t scene{};
  tool_def_t tool{};
  tool.name = "stylus";
  tool.device = "virtual_hand";
  tool.radius_m = 0.005;
  tool.body = 0;
  body_def_t body{};
  body.name = "stylus";
  body.pose.orientation.w = 1;
  scene.bodies = {body};
  scene.body_count = 1;
  scene.tools = {tool};
  scene.tool_count = 1;
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const scene_t scene = one_hand();
  const NodeConfig choice = resolve_config(scene, "", {});
  DeviceState hand;
  Safety safety(safety_limits(choice.settings));
  sync::ClockMaps maps(kRun);
  Session session(scene, choice, std::make_unique<RecordedHand>(hand), {kRun, kClock, &maps}, safety);
  sync::EventInbox events({kRun, kClock, &maps});
  sync::LogScanner scanner({data, size});
  sync::HostTime now = sync::host_time(1'000'000'000);
  for (sync::LogEvent e; scanner.next(e);) {
    if (e.channel == channels::kTouchModel)
      if (const auto m = sync::decode<touch_model_t>(e.data.data(), e.data.size())) session.push(*m, now);
    if (e.channel == channels::kContactEvents)
      if (const auto m = sync::decode<contact_events_t>(e.data.data(), e.data.size())) events.push(*m, now), session.push(events.take(sync::SimTime::max()));
    hand.position.z() = 0.01 * std::sin(sync::to_seconds(now.time_since_epoch()) * 100);
    const auto state = session.step(now += sync::Nanoseconds(1'000'000)).state;
    const double force_N = std::hypot(state.force_N.x, state.force_N.y, state.force_N.z);
    if (!(force_N <= choice.settings.force_limit_N * 1.0001)) std::abort();
  }
  return 0;
}
