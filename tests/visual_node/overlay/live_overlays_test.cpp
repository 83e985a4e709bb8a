// All overlays together, on an in-process bus.
#include "sync/bus/bus.h"
#include "tests/times.h"
#include "visual_node/overlay/live_overlays.h"

#include <catch2/catch.hpp>
#include <tuple>
#include <tactus/tool_state_t.hpp>

#include "visual_node/frame/marker.h"

using namespace tactus;
using namespace tactus::visual;
using tactus::test::at_ms;

namespace {

sync::BusOptions memory() {
  sync::BusOptions options;
  options.memory = true;
  return options;
}

struct OverlayLayout {
  sync::Bus bus{sync::Identity::fresh("visual_node", 7), memory()};
  sync::EventInbox events{bus.clocks()};
  LiveOverlays overlays{bus, events};

  std::vector<std::string> configure(const std::string& overlay, const std::string& plots = "", double text_size = 1) {
    Settings s;
    s.overlay = overlay, s.plots = plots, s.text_size = text_size;
    return overlays.configure(s);
  }
  // Publishes a force on the hand, then draws the overlays of a frame.
  std::vector<Rect> drawn(int width, int height) {
    tool_state_t m{};
    m.device.orientation.w = m.proxy.orientation.w = 1;
    m.force_N.z = 3;
    bus.publish(channels::kToolState, m);
    bus.drain(at_ms(1000));
    Frame frame;
    overlays.append(frame, {}, at_ms(1001), width, height);
    return frame.list.overlay;
  }
};

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

}  // namespace

TEST_CASE("Overlays do not overlap in any combination and keep the marker free") {
  OverlayLayout c;
  for (const auto& [text_size, width, height] : {std::tuple(1.0, 320, 240), std::tuple(1.0, 640, 480), std::tuple(1.0, 960, 540),
                                                 std::tuple(1.0, 1920, 1080), std::tuple(1.0, 4096, 240), std::tuple(2.0, 640, 480),
                                                 std::tuple(1.5, 1920, 1080), std::tuple(4.0, 1280, 720)}) {
    REQUIRE(c.configure("all,help",
                        "graph TOOL_STATE.force_N.z; bar TOOL_STATE.fade; text TOOL_STATE.tool;"
                        "graph TOOL_STATE.energy_J; graph TOOL_STATE.coupling; graph TOOL_STATE.seq_no", text_size)
                .size() == 1);
    CAPTURE(text_size, width, height);
    const auto rects = c.drawn(width, height);
    std::vector<Rect> plates;
    for (const Rect& r : rects)
      if (r.red + r.green + r.blue == 0) plates.push_back(r);
    CHECK(plates.size() >= 2);
    for (std::size_t i = 0; i < plates.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) CHECK_FALSE(overlap(plates[i], plates[k]));
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const Rect marker{0, h - kMarkerRows * kMarkerCell_px, w, kMarkerRows * kMarkerCell_px};
    for (const Rect& r : rects) {
      // No pixel of the text leaves the picture or its plate.
      CHECK((r.x >= 0 && r.y >= 0 && r.x + r.width <= w && !overlap(r, marker)));
      CHECK(std::any_of(plates.begin(), plates.end(), [&](const Rect& p) {
        return r.x >= p.x && r.y >= p.y && r.x + r.width <= p.x + p.width && r.y + r.height <= p.y + p.height;
      }));
    }
  }
}

TEST_CASE("An overlay subscribes to its channels when it is switched on") {
  OverlayLayout c;
  CHECK(c.configure("none").empty());
  CHECK(c.bus.inboxes().empty());
  CHECK(c.drawn(640, 480).empty());
  c.overlays.toggle(Overlay::kReport);
  CHECK(c.bus.inboxes().size() == 2);  // CONTACTS, NODE_HEALTH
  CHECK_FALSE(c.drawn(640, 480).empty());
  c.overlays.toggle(Overlay::kReport);
  CHECK(c.drawn(640, 480).empty());
  // A configured plot is shown independently of the overlays.
  CHECK(c.configure("none", "text TOOL_STATE.force_N.z").empty());
  CHECK(c.overlays.on().on(Overlay::kPlots));
  CHECK_FALSE(c.drawn(640, 480).empty());
}

TEST_CASE("An invalid change is rejected and changes nothing") {
  Settings s;
  s.overlay = "report,plot";
  CHECK_THROWS_WITH(LiveOverlays::check(s), Catch::Contains("\"plot\"") && Catch::Contains("plots"));
  s.overlay = "report";
  s.plots = "graph TOOL_STATE.force_N.z; graph TOOL_STATE.force_M.z";
  CHECK_THROWS_WITH(LiveOverlays::check(s), Catch::Contains("force_N"));
  s.plots = "graph TOOL_STATE.force_N.z";
  CHECK_NOTHROW(LiveOverlays::check(s));
}
