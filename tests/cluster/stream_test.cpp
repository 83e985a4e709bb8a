// Tests of the picture stream for observers while the cluster runs.
#include "tests/cluster/support/picture_cluster.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// In sorted order: by source and number.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

long number_of(const std::filesystem::path& file) {
  const std::string stem = file.stem();
  return std::stol(stem.substr(stem.find('_') + 1));
}

}  // namespace

TEST_CASE("A running picture is streamed on request as complete JPEG files, in order, and the loop keeps its rate") {
  PictureCluster c;
  c.start_with(c.snapshots());
  const auto before = c.rates(2);
  const auto saved = c.folder.path() / "pictures";
  const auto save = [&](const char* name, const char* pictures, const char* seconds) {
    c.processes.spawn(name, {programs() / "save_pictures", "--run-id", std::to_string(RunningCluster::kRunId),
                             "--pictures", pictures, "--seconds", seconds, saved});
    return c.processes.wait_for_exit(name, kTimeout_s);
  };
  CHECK(save("too_early", "1", "1") == 1);
  CHECK_THAT(c.processes.output("too_early"), Catch::Contains("no picture arrived") && Catch::Contains("stream=10"));

  c.set({"stream_width=160", "stream=20"});
  const int status = save("save", "12", "20");
  INFO(c.processes.output("save"));
  REQUIRE(status == 0);
  const auto files = files_in(saved);
  REQUIRE(files.size() == 12);
  for (std::size_t i = 1; i < files.size(); ++i) CHECK(number_of(files[i]) > number_of(files[i - 1]));
  const Grey small = c.grey("-i " + quoted(c.snapshot) + " -vf scale=160:120:flags=area");
  for (const auto& file : files) {
    const Grey picture = c.grey("-i " + quoted(file));
    REQUIRE(picture.size() == 160 * 120);
    // The same scene with another flash and another position of the hand.
    CHECK(mean_difference(picture, small) < 20);
  }
  CHECK(mean_difference(c.grey("-i " + quoted(files.front())), Grey(160 * 120, 0)) > 5);
  c.check_rates_hold(before, 2);

  c.set({"stream=0"});
  c.monitor.receive_for(0.5);
  CHECK(save("after", "1", "1") == 1);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}
