#include "visual_node/overlay/plots.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tactus/node_health_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/lcmtypes/samples.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::visual;
using tactus::test::at_ms;

namespace {

constexpr sync::Nanoseconds kSpan{1'500'000'000};  // slices of 10 ms

std::vector<std::uint8_t> tool_state(int tool, float force_z_N, const char* node = "haptic_node") {
  tool_state_t m{};
  test::Samples(3).fill(m);
  m.tool = tool, m.force_N.z = force_z_N;
  m.header.source = static_cast<std::int32_t>(sync::fnv1a_32(node));
  return sync::encode(m);
}

std::string sentence(const char* text) {
  std::vector<std::string> warnings;
  parse_plots(text, warnings);
  return warnings.empty() ? "" : warnings.front();
}

}  // namespace

TEST_CASE("A plot names a variable of a channel and optionally a process and a tool") {
  std::vector<std::string> warnings;
  const auto specs = parse_plots(
      "graph TOOL_STATE.force_N.z@tool=1; bar NODE_HEALTH.rate_Hz@audio_node;text SYNC_REPORT.hits;", warnings);
  CHECK(warnings.empty());
  REQUIRE(specs.size() == 3);
  CHECK(specs[0].kind == PlotSpec::Kind::kGraph);
  CHECK(specs[1].kind == PlotSpec::Kind::kBar);
  CHECK(specs[2].kind == PlotSpec::Kind::kText);
  CHECK(specs[0].title == "TOOL_STATE.force_N.z@tool=1");
  CHECK(std::get<double>(*specs[0].read(tool_state(1, 2.5f))) == 2.5);
  CHECK_FALSE(specs[0].read(tool_state(0, 2.5f)));
  const PlotSpec of_hand = parse_plot("graph TOOL_STATE.force_N.z@haptic_node@tool=0");
  CHECK(of_hand.read(tool_state(0, 1)));
  CHECK_FALSE(of_hand.read(tool_state(0, 1, "another_node")));
  CHECK_FALSE(of_hand.read(tool_state(1, 1)));
  CHECK(parse_plots("none", warnings).empty());
  CHECK(warnings.empty());
}

TEST_CASE("A plot with an unknown name is rejected in one sentence with similar names") {
  CHECK_THAT(sentence("graph TOOL_STAT.force_N.z"),
             Catch::Contains("there is no channel \"TOOL_STAT\"; nearest: TOOL_STATE"));
  CHECK_THAT(sentence("graph TOOL_STATE.farce_N.z"), Catch::Contains("nearest: force_N"));
  CHECK_THAT(sentence("graph TOOL_STATE"), Catch::Contains("which field"));
  CHECK_THAT(sentence("pie TOOL_STATE.tool"), Catch::Contains("graph, bar or text"));
  CHECK_THAT(sentence("graph NODE_HEALTH.status_text"), Catch::Contains("text, not a number"));
  CHECK_THAT(sentence("graph TOOL_STATE.fade@tool=x"), Catch::Contains("is not a number"));
  CHECK_THAT(sentence("graph TOOL_STATE.fade@tolo=1"), Catch::Contains("nearest: tool"));
  CHECK_THAT(sentence("graph TOOL_STATE.fade@"), Catch::Contains("field=number after @"));
  std::string many;
  for (int i = 0; i < 40; ++i) many += "text TOOL_STATE.tool;";
  std::vector<std::string> warnings;
  CHECK(parse_plots(many, warnings).size() == kMaxPlots);
  CHECK(warnings.size() == 1);
}

TEST_CASE("A plot keeps the lowest and highest value of each time slice within its span") {
  ValueHistory history(kSpan);
  for (int ms = 0; ms < 3000; ++ms) history.add(ms == 2005 ? 50 : ms == 2007 ? -7 : 1, at_ms(ms));
  const auto slices = history.slices(at_ms(2999));
  CHECK(slices.size() == ValueHistory::kColumns);
  CHECK(slices.front().number == 150);
  CHECK(slices.back().number == 299);
  CHECK(slices[50].lowest == -7);
  CHECK(slices[50].highest == 50);
  CHECK(history.range(at_ms(2999)) == std::pair(-7.0, 50.0));
  CHECK(history.range(at_ms(4000)) == std::pair(1.0, 1.0));
  CHECK_FALSE(history.range(at_ms(9000)));
}

TEST_CASE("A plot accepts late and invalid values") {
  ValueHistory history(kSpan);
  history.add(1, at_ms(100));
  history.add(9, at_ms(50));  // late: added to the newest slice
  history.add(std::numeric_limits<double>::quiet_NaN(), at_ms(101));
  history.add(std::numeric_limits<double>::infinity(), at_ms(200));
  REQUIRE(history.slices(at_ms(100)).size() == 1);
  CHECK(history.slices(at_ms(100)).front().highest == 9);
}

TEST_CASE("Axis numbers have a useful precision") {
  CHECK(label(0) == "0");
  CHECK(label(1000) == "1000");
  CHECK(label(-12.3456) == "-12.35");
  CHECK(label(1.5e-5) == "1.5e-05");
  CHECK(label(123456789) == "1.235e+08");
}

TEST_CASE("Plots stay within the picture, and each channel is subscribed once") {
  std::vector<std::string> warnings;
  Plots plots(
      parse_plots(
          "graph TOOL_STATE.force_N.z; bar TOOL_STATE.fade; text NODE_HEALTH.status_text; graph TOOL_STATE.energy_J;"
          "graph TOOL_STATE.force_N.x; graph TOOL_STATE.force_N.y; graph TOOL_STATE.coupling",
          warnings),
      kSpan);
  CHECK(plots.channels() == std::vector<std::string>{"TOOL_STATE", "NODE_HEALTH"});
  for (int ms = 0; ms < 2000; ++ms)
    plots.push("TOOL_STATE", tool_state(0, static_cast<float>(std::sin(ms * 0.01))), at_ms(ms));
  for (const auto& [width, height] :
       {std::pair(640, 480), std::pair(320, 240), std::pair(1920, 1080), std::pair(4, 4)}) {
    std::vector<Rect> overlay;
    plots.append(overlay, at_ms(2000), width, height);
    CHECK(overlay.empty() == (width == 4));
    float right = 0, bottom = 0;
    for (const Rect& r : overlay) {
      right = std::max(right, r.x + r.width);
      bottom = std::max(bottom, r.y + r.height);
      REQUIRE(r.x >= 0);
    }
    CHECK(right <= static_cast<float>(width));
    CHECK(bottom <= static_cast<float>(height));
  }
}

TEST_CASE("A bar has its value below it, and empty text differs from missing text") {
  std::vector<std::string> warnings;
  const auto drawn = [&](const char* plot, const char* channel, std::vector<std::uint8_t> bytes) {
    Plots plots(parse_plots(plot, warnings), kSpan);
    if (!bytes.empty()) plots.push(channel, bytes, at_ms(10));
    std::vector<Rect> overlay;
    plots.append(overlay, at_ms(20), 640, 480);
    return overlay;
  };
  const auto bar = drawn("bar TOOL_STATE.force_N.z", "TOOL_STATE", tool_state(0, 2));
  // The bar is the one rectangle of its colour with the width of the plot: at its maximum.
  float bottom = 0, lowest = 0;
  for (const Rect& r : bar) {
    if (r.width > 100 && r.alpha == 1) bottom = std::max(bottom, r.y + r.height);
    if (r.height == 1) lowest = std::max(lowest, r.y);
  }
  REQUIRE(bottom > 0);
  CHECK(lowest > bottom);
  node_health_t health{};
  health.node = "sim_node";
  const auto pixels = [](const std::vector<Rect>& rects) {
    double sum = 0;
    for (const Rect& r : rects) sum += r.alpha == 1 ? r.width * r.height : 0;
    return sum;
  };
  REQUIRE(!sync::encode(health).empty());
  CHECK(pixels(drawn("text NODE_HEALTH.status_text", "NODE_HEALTH", sync::encode(health))) !=
        pixels(drawn("text NODE_HEALTH.status_text", "NODE_HEALTH", {})));
}

TEST_CASE("Values that are not finite or very large are drawn within their plot") {
  std::vector<std::string> warnings;
  const double values[] = {1,
                           -1e308,
                           1e308,
                           std::numeric_limits<double>::infinity(),
                           2,
                           -1e-308,
                           std::numeric_limits<double>::quiet_NaN()};
  for (const char* kind : {"graph", "bar", "text"})
    for (std::size_t count = 1; count <= std::size(values); ++count) {
      CAPTURE(kind, count);
      Plots plots(parse_plots(std::string(kind) + " NODE_HEALTH.rate_Hz", warnings), kSpan);
      for (std::size_t i = 0; i < count; ++i) {
        node_health_t m{};
        m.node = "sim_node";
        m.rate_Hz = values[i];
        plots.push("NODE_HEALTH", sync::encode(m), at_ms(1000 + 20 * static_cast<std::int64_t>(i)));
      }
      std::vector<Rect> overlay;
      plots.append(overlay, at_ms(1200), 640, 480);
      REQUIRE(!overlay.empty());
      const Rect& plate = overlay.front();
      for (const Rect& r : overlay) {
        CHECK((r.x >= plate.x && r.x + r.width <= plate.x + plate.width));
        CHECK((r.y >= plate.y - 1 && r.y + r.height <= plate.y + plate.height));
      }
    }
}
