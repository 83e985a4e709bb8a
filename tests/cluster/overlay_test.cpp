// Tests of overlays, plots and the picture stream of a running node, changed over the bus.
#include "tests/cluster/support/picture_cluster.h"

using namespace tactus;
using namespace tactus::cluster;

TEST_CASE("Overlays and plots are added to a running picture and removed, and unknown ones are rejected") {
  PictureCluster c;
  c.start_with(c.snapshots());
  const auto before = c.rates(1);
  const Grey plain = c.later_picture();
  // Text on a dark plate at the upper left and a plot at the upper right each change their part of the picture.
  const auto half_difference = [](const Grey& a, const Grey& b, bool left) {
    Grey of_a, of_b;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (i / 640 < 240 && (i % 640 < 320) == left) of_a.push_back(a[i]), of_b.push_back(b[i]);
    return mean_difference(of_a, of_b);
  };
  CHECK_THAT(c.set({"overlay=report, ages,degradation"}), Catch::Contains("visual_node: overlay is report"));
  const Grey words = c.later_picture();
  CHECK(half_difference(plain, words, true) > 5);
  c.set({"overlay=none"});
  const Grey again = c.later_picture();
  CHECK(half_difference(plain, again, true) < 2);
  CHECK_THAT(c.set({"plots=graph TOOL_STATE.force_N.z@tool=0; text NODE_HEALTH.status_text@sim_node"}),
             Catch::Contains("plots is graph"));
  const Grey plots = c.later_picture();
  CHECK(half_difference(again, plots, false) > 5);

  CHECK_THAT(c.set({"overlay=contracts"}, 1), Catch::Contains("\"contracts\"") && Catch::Contains("contacts"));
  CHECK_THAT(c.set({"plots=graph TOOL_STAT.force_N.z"}, 1), Catch::Contains("nearest: TOOL_STATE"));
  CHECK_THAT(c.set({"plots=graph TOOL_STATE.force_N.w"}, 1),
             Catch::Contains("force_N") || Catch::Contains("vec3"));
  CHECK_THAT(c.set({"overlai=none"}, 1), Catch::Contains("\"overlai\"") && Catch::Contains("overlay"));
  CHECK_THAT(c.set({"stream_quality=1000"}, 1), Catch::Contains("stream_quality"));
  CHECK(half_difference(again, c.later_picture(), false) > 5);  // the existing overlay stays

  c.set({"overlay=all", "plot_span=1s"});
  c.check_rates_hold(before, 2);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}
