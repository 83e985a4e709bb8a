// Tests of visual_node without a rendering context: it reports the attempted contexts and exits; no other node is affected.
#include "tests/cluster/support/picture_cluster.h"

using namespace tactus;
using namespace tactus::cluster;

TEST_CASE("Without an OpenGL context visual_node ends with a list of its attempts, and the other nodes continue", "[smoke]") {
  PictureCluster c;
  const auto no_vendor = c.folder.path() / "vendor.json";
  std::ofstream(no_vendor) << "{}\n";
  c.start_with(c.snapshots());
  const auto before = c.rates(1);
  c.processes.kill("visual_node");
  for (const std::string vendor : {"/dev/null", no_vendor.c_str(), "/nowhere/at/all.json"}) {
    CAPTURE(vendor);
    c.start_vision(c.snapshots(),
                   {"__EGL_VENDOR_LIBRARY_FILENAMES=" + vendor, "__EGL_VENDOR_LIBRARY_DIRS=/nowhere"});
    const int status = c.processes.wait_for_exit("visual_node", kTimeout_s);
    CHECK(status == 1);
  }
  const std::string output = c.processes.output("visual_node");
  const std::string last = output.substr(output.rfind('\n', output.size() - 2) + 1);
  CHECK_THAT(last, Catch::StartsWith("visual_node: no OpenGL 3.3 context, tried ") &&
                       Catch::Contains("EGL default display") && Catch::Contains("libegl-mesa0 is installed") && Catch::Contains("unset __EGL_VENDOR_LIBRARY_"));
  CHECK(c.others_running());
  c.check_rates_hold(before, 1, "visual_node");
  // With a context it starts again.
  c.start_vision(c.snapshots());
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}
