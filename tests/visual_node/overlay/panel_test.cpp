#include "visual_node/overlay/panel.h"

#include <catch2/catch.hpp>
#include <tactus/node_health_t.hpp>

#include "sync/time/histogram.h"
#include "visual_node/frame/text.h"
#include "visual_node/overlay/keys.h"
#include "visual_node/overlay/plots.h"

using namespace tactus;
using namespace tactus::visual;

namespace {

using std::chrono::microseconds;

node_health_t health(std::int64_t seq, const sync::Histogram& ticks, std::int64_t incarnation = 1) {
  node_health_t m{};
  m.header.seq = seq, m.header.incarnation = incarnation;
  m.nominal_rate_Hz = 1000, m.realtime_factor = 1;
  m.tick = ticks.to_message();
  return m;
}

}  // namespace

TEST_CASE("The setting lists overlays, and an unknown word is rejected with similar names") {
  CHECK_FALSE(parse_overlays("none").any());
  CHECK_FALSE(parse_overlays("").any());
  const OverlaySet set = parse_overlays(" contacts,report tools ");
  for (std::size_t i = 0; i < kOverlayNames.size(); ++i) {
    const std::string_view name = kOverlayNames[i];
    CHECK(set.on(static_cast<Overlay>(i)) == (name == "contacts" || name == "report" || name == "tools"));
  }
  CHECK(parse_overlays("all").on(Overlay::kAges));
  CHECK_THROWS_WITH(parse_overlays("contacts contract"),
                    Catch::Contains("\"contract\"") && Catch::Contains("contacts"));
}

TEST_CASE("Every overlay has a key, and the help lists every key") {
  std::size_t reached = 0;
  for (std::size_t i = 0; i < kOverlayNames.size(); ++i)
    for (int key = 0; key < 400; ++key) reached += action_of(key) == KeyAction{Action::kOverlay, static_cast<Overlay>(i)};
  CHECK(reached == kOverlayNames.size());
  std::size_t keys = 0;
  for (int key = 0; key < 400; ++key) keys += action_of(key).has_value();
  CHECK(help_lines().size() == keys + 1);  // and the mouse
  CHECK(action_of(' ') == KeyAction{Action::kPauseOrResume});
  CHECK_FALSE(action_of('Q'));
}

TEST_CASE("The tick time is that of the last interval") {
  TickTimes times;
  sync::Histogram ticks;
  for (int i = 0; i < 1000; ++i) ticks.add(microseconds(100));
  times.push(health(0, ticks));
  CHECK_FALSE(times.median());
  for (int i = 0; i < 100; ++i) ticks.add(microseconds(800));
  times.push(health(1, ticks));
  REQUIRE(times.median());
  // Bins are logarithmic: accurate to one of them.
  CHECK(sync::to_seconds(*times.median()) == Approx(800e-6).epsilon(0.35));
  times.push(health(2, ticks));  // no tick: the last value stays
  CHECK(times.median());
  times.push(health(0, ticks, 2));  // another incarnation
  CHECK_FALSE(times.median());
}

TEST_CASE("An overlay has lines with its figures only while it is on") {
  PanelData data;
  data.contacts = 12;
  data.rendering = microseconds(8200), data.period = microseconds(16667);
  data.quality = 1, data.qualities = 4;
  data.inputs = {{"WORLD_STATE", {microseconds(12300), {}}, sync::SampleStatus::kInterpolated},
                  {"TOOL_STATE", {}, sync::SampleStatus::kNone}};
  data.profile = "late sound";
  CHECK(panel_lines({}, data).empty());
  const auto text = [&](Overlay o) {
    OverlaySet on;
    on.set(o);
    std::string all;
    for (const std::string& line : panel_lines(on, data)) all += line + "\n";
    return all;
  };
  CHECK(text(Overlay::kReport) == "contacts  12\nphysics   no messages\nrendering 8.2 of 16.7 ms\n");
  CHECK(text(Overlay::kAges) == "WORLD_STATE 12.3 ms interpolated\nTOOL_STATE nothing yet\n");
  CHECK_THAT(text(Overlay::kDegradation), Catch::Contains("late sound") && Catch::Contains("step 1 of 0 to 3"));
  CHECK(text(Overlay::kContacts).empty());
}

TEST_CASE("Every character of a line is drawn within the picture") {
  for (char c = '!'; c <= '~'; ++c) CHECK(glyph(c));
  CHECK_FALSE(glyph(' '));
  std::vector<Rect> overlay;
  const std::vector<std::string> lines(500, std::string(500, 'M'));
  append_lines(overlay, lines, {8, 36, 640, 480}, text_size(480));
  REQUIRE(!overlay.empty());
  for (const Rect& r : overlay) {
    CHECK(r.x + r.width <= 640);
    CHECK(r.y + r.height <= 480);
  }
  CHECK(overlay.size() < 640u * 480u / 4u);
  std::vector<Rect> none;
  append_lines(none, {}, {8, 36, 640, 480}, 2);
  append_lines(none, {"no room"}, {8, 36, 4, 4}, 2);
  CHECK(none.empty());
}

TEST_CASE("A long line wraps, and the letters become smaller before lines are omitted") {
  const float wide = (kGlyphWidth + 1) * 2;
  const TextArea room{0, 0, 20 * wide + 8, 480};  // 20 letters of size 2
  const auto lowest = [&](const std::vector<std::string>& lines, float bottom = 480) {
    std::vector<Rect> overlay;
    append_lines(overlay, lines, {room.x, room.y, room.right, bottom}, 2);
    REQUIRE(overlay.size() > 1);
    for (const Rect& r : overlay) CHECK(r.x + r.width <= room.right);
    return overlay.front().height;
  };
  const float one = lowest({"twenty letters, no 1"}), two = lowest({"one", "two"});
  CHECK(lowest({"twenty letters, no 1 more"}) == two);
  CHECK(lowest({std::string(21, 'M')}) == two);
  CHECK(two - one == (kGlyphHeight + 3) * 2);
  // Ten lines of size 2 are 200 pixels high, of size 1 half of that.
  const std::vector<std::string> ten(10, "line");
  CHECK(lowest(ten, 240) == 206);
  CHECK(lowest(ten, 120) == 103);
}

TEST_CASE("All lines of all overlays fit at 640 x 480, beside the plots and above the markers") {
  PanelData data;
  data.haptic_bodies = 3000, data.visual_bodies = 3000, data.contacts = 10000;
  data.physics.push(health(0, {}));
  data.rendering = data.period = microseconds(16667);
  data.delay = data.profile_delay = microseconds(250000);
  data.output.set("frame_rate", 12.5), data.output.set("resolution", 0.25);
  for (const char* channel : {"WORLD_STATE", "CONTACT_EVENTS", "TOOL_STATE", "CONTACTS"})
    data.inputs.push_back({channel, {microseconds(1234567), {}}, sync::SampleStatus::kExtrapolated});
  OverlaySet on = parse_overlays("all");
  on.set(Overlay::kHelp);
  const float left = plots_left(640), bottom = 480 - 64;
  std::vector<Rect> overlay;
  append_lines(overlay, panel_lines(on, data), {8, 36, left, bottom}, text_size(480));
  REQUIRE(!overlay.empty());
  // The plate is as high as all lines: none was left out or cut.
  const std::size_t lines = panel_lines(on, data).size();
  CHECK(overlay.front().height >= static_cast<float>(lines) * (kGlyphHeight + 3));
  for (const Rect& r : overlay) {
    CHECK(r.x + r.width <= left);
    CHECK(r.y + r.height <= bottom);
  }
}

TEST_CASE("A letter is drawn pixel by pixel from its glyph") {
  std::vector<Rect> overlay;
  append_letters(overlay, "B", 10, 20, 1);
  int pixels = 0, wanted = 0;
  for (const Rect& r : overlay) {
    for (int i = 0; i < static_cast<int>(r.width); ++i) {
      const int column = static_cast<int>(r.x) - 10 + i, row = static_cast<int>(r.y) - 20;
      CHECK((glyph('B')[row] >> (kGlyphWidth - 1 - column) & 1) == 1);
      ++pixels;
    }
  }
  for (int row = 0; row < kGlyphHeight; ++row) wanted += __builtin_popcount(glyph('B')[row]);
  CHECK(pixels == wanted);
}
