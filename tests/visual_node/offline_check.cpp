// A recorded run rendered by the program itself, without bus and screen.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/identity.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/visual_node/support/read_marker.h"
#include "tests/visual_node/support/test_scene.h"

using namespace tactus;
using audio::test::kLogBegins_ns;
using audio::test::RecordedRun;

namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr std::int64_t kPeriod_ns = 16'666'666;  // of 60 Hz, as LogFeed ticks
constexpr double kRun_s = 3;

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_pictures_XXXXXX";
    if (mkdtemp(name)) path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path;
};

struct Done {
  int status;
  std::string output;
  // The text after these words.
  std::string after(const std::string& words) const {
    const auto at = output.find(words);
    REQUIRE(at != std::string::npos);
    const std::string rest = output.substr(at + words.size());
    return rest.substr(0, rest.find_first_of(" ,\n"));
  }
};

// The program in the folder of this test.
Done render(const Folder& folder, const std::string& log, const std::string& video,
            std::vector<std::string> more = {}) {
  const auto bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::vector<std::string> words{bin / "visual_node", "--log", folder.file(log), "--set",
                                 "width=320",         "--set", "height=240"};
  if (!video.empty()) words.insert(words.end(), {"--video", folder.file(video)});
  words.insert(words.end(), more.begin(), more.end());
  const std::string output = folder.file("said.txt");
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> raw;
    for (std::string& w : words) raw.push_back(w.data());
    raw.push_back(nullptr);
    dup2(open(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
    execv(raw[0], raw.data());
    _exit(127);
  }
  int status = -1;
  waitpid(child, &status, 0);
  std::ifstream text(output);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, std::string(std::istreambuf_iterator<char>(text), {})};
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

header_t stamp(double at_s, std::int64_t seq) {
  return {std::llround(at_s * 1e9), kLogBegins_ns + std::llround(at_s * 1e9), 4711, 7, 9, 21, seq};
}

const std::vector<double> kHits{0.5, 0.9013, 1.2004, 1.71, 2.25};

// A ball that crosses the picture at 0.3 m/s, and hits at times between the frames.
void record(const std::string& path, const std::string& profile = "") {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {2, -0.5, 0}), shape_def_t::SPHERE, {0.2, 0, 0});
  scene.body_count = scene.visual_count = 1;
  scene.ambient = test::grey(0.6f);
  RecordedRun run(std::make_unique<sync::FileSink>(path), scene);
  if (!profile.empty()) {
    degradation_t m{};
    m.header = stamp(0.01, 0);
    m.generation = 1, m.pages = 1, m.text = profile, m.size = static_cast<std::int32_t>(profile.size());
    m.hash = sync::fnv1a_64(profile.data(), profile.size());
    run.write_raw(0.01, channels::kDegradation, sync::encode(m));
  }
  std::size_t next = 0;
  for (int ms = 20; ms < static_cast<int>(1000 * kRun_s); ++ms) {
    const double now = ms * 1e-3;
    if (next < kHits.size() && now >= kHits[next]) {
      const auto id = static_cast<std::int64_t>(next) + 1;
      contact_event_t hit = RecordedRun::hit(id, kHits[next], 0, 0);
      hit.point_m.x = 2, hit.point_m.y = 0, hit.point_m.z = 0;
      run.write_events(now, {hit});
      ++next;
    }
    if (ms % 17) continue;
    world_state_t w{};
    w.header = stamp(now, ms);
    w.clock.sim_ns = w.header.sim_time_ns, w.clock.host_ns = w.header.publish_time_ns, w.clock.rate = 1;
    w.pages = w.count = 1, w.rate_Hz = 60;
    body_state_t body{};
    body.position_m.x = 2, body.position_m.y = -0.5 + 0.3 * now, body.velocity_m_s.y = 0.3f,
    body.orientation.w = 1;
    w.bodies = {body};
    run.write_raw(now, channels::kWorldState, sync::encode(w));
  }
  run.finish();
}

// Luma of each frame.
std::vector<std::vector<std::uint8_t>> frames_of(const Folder& folder, const std::string& video) {
  const std::string raw = folder.file("raw");
  const std::string command =
      "ffmpeg -v error -y -i '" + folder.file(video) + "' -f rawvideo -pix_fmt gray '" + raw + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  const std::string all = bytes_of(raw);
  std::vector<std::vector<std::uint8_t>> frames;
  constexpr std::size_t kBytes = kWidth * kHeight;
  for (std::size_t at = 0; at + kBytes <= all.size(); at += kBytes)
    frames.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                        all.begin() + static_cast<std::ptrdiff_t>(at + kBytes));
  return frames;
}

}  // namespace

TEST_CASE(
    "A log rendered twice gives identical files with every event in its frame") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  const Done first = render(folder, "run.lcmlog", "a.mp4", {"--frames", folder.file("frames.csv")}),
             again = render(folder, "run.lcmlog", "b.mp4");
  CAPTURE(first.output);
  REQUIRE(first.status == 0);
  REQUIRE(again.status == 0);
  CHECK(first.after("pixels ") == again.after("pixels "));
  CHECK(bytes_of(folder.file("a.mp4")) == bytes_of(folder.file("b.mp4")));
  CHECK_FALSE(std::filesystem::exists(folder.file("a.mp4.part.mp4")));

  const auto frames = frames_of(folder, "a.mp4");
  // The frames of three seconds, except those before the scene is loaded.
  CHECK(frames.size() > 170);
  CHECK(frames.size() <= 181);
  std::map<std::uint32_t, std::int64_t> seen;  // event: number of the first frame that shows it
  std::int64_t last = -1, first_number = -1;
  for (const auto& luma : frames) {
    const auto newest = test::read_marker(luma, kWidth, kHeight, 0);
    REQUIRE(newest);
    if (last >= 0) CHECK(newest->frame == last + 1);  // none is skipped, none repeated
    last = newest->frame;
    if (first_number < 0) first_number = last;
    for (int row = 0; row < visual::kMarkerRows; ++row) {
      const auto marker = test::read_marker(luma, kWidth, kHeight, row);
      if (!marker || marker->frame != newest->frame || marker->event == 0) break;
      seen.try_emplace(marker->event, marker->frame);
    }
  }
  REQUIRE(seen.size() == kHits.size());
  std::ifstream table(folder.file("frames.csv"));
  std::string line;
  std::getline(table, line);
  std::getline(table, line);  // frame,host_ns,pixels of the first
  const std::int64_t first_ns = std::stoll(line.substr(line.find(',') + 1));
  for (std::size_t i = 0; i < kHits.size(); ++i) {
    // The log stores whole microseconds and publishes each hit at a whole millisecond: the next frame shows it.
    const double published_s = std::ceil(kHits[i] * 1000 - 1e-6) / 1000;
    INFO("hit at " << kHits[i]);
    const double since_first_ns = static_cast<double>(kLogBegins_ns - first_ns) + published_s * 1e9;
    CHECK(seen.at(static_cast<std::uint32_t>(i + 1)) == static_cast<double>(first_number) + std::ceil(since_first_ns / kPeriod_ns));
  }
}

TEST_CASE("Another log or another setting gives other pixels") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  const Done plain = render(folder, "run.lcmlog", "a.mp4");
  const Done dim = render(folder, "run.lcmlog", "b.mp4", {"--set", "exposure=0.5"});
  const Done coarse = render(folder, "run.lcmlog", "c.mp4", {"--set", "quality=2"});
  CHECK(plain.after("pixels ") != dim.after("pixels "));
  CHECK(plain.after("pixels ") != coarse.after("pixels "));
}

TEST_CASE("The profile of a run applies only if the log is rendered as recorded") {
  const Folder folder;
  const std::string profile = R"(<profile name="slow"><degrade modality="visual" frame_rate="10Hz"/></profile>)";
  record(folder.file("plain.lcmlog"));
  record(folder.file("slow.lcmlog"), profile);
  std::ofstream(folder.file("slow.xml")) << profile;
  const std::string plain = render(folder, "plain.lcmlog", "a.mp4").after("pixels ");
  CHECK(render(folder, "slow.lcmlog", "b.mp4").after("pixels ") == plain);
  const std::string slow = render(folder, "slow.lcmlog", "c.mp4", {"--as-recorded"}).after("pixels ");
  CHECK(slow != plain);
  // Another profile may be applied to the raw log instead.
  CHECK(render(folder, "plain.lcmlog", "d.mp4", {"--degrade", folder.file("slow.xml")}).after("pixels ") != plain);
}

TEST_CASE("An existing file is not overwritten under any name") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  std::ofstream(folder.file("old.mp4")) << "another film";
  std::filesystem::create_symlink(folder.file("run.lcmlog"), folder.file("link.mp4"));
  const std::string log = bytes_of(folder.file("run.lcmlog"));
  for (const char* video : {"old.mp4", "run.lcmlog", "link.mp4"}) {
    const Done done = render(folder, "run.lcmlog", video);
    CHECK(done.status == 1);
    CHECK_THAT(done.output, Catch::Contains("not overwritten"));
  }
  const Done snapshot = render(folder, "run.lcmlog", "new.mp4", {"--snapshot", folder.file("run.lcmlog")});
  CHECK(snapshot.status == 1);
  CHECK_THAT(snapshot.output, Catch::Contains("the log itself"));
  CHECK(bytes_of(folder.file("run.lcmlog")) == log);
  CHECK(bytes_of(folder.file("old.mp4")) == "another film");
}

TEST_CASE("A file that is not a log is rejected in one sentence without output files") {
  const Folder folder;
  const auto error_of = [&](const std::string& log) {
    const Done done = render(folder, log, "x.mp4");
    CHECK(done.status == 1);
    CHECK_FALSE(std::filesystem::exists(folder.file("x.mp4")));
    CHECK_FALSE(std::filesystem::exists(folder.file("x.mp4.part.mp4")));
    return done.output;
  };
  CHECK_THAT(error_of("none.lcmlog"), Catch::Contains("cannot read"));
  std::ofstream(folder.file("text.lcmlog")) << "This is a letter, and no log.\n";
  CHECK_THAT(error_of("text.lcmlog"), Catch::Contains("not an LCM log"));
  RecordedRun(std::make_unique<sync::FileSink>(folder.file("bare.lcmlog")), std::vector<sync::Asset>{}).finish();
  CHECK_THAT(error_of("bare.lcmlog"), Catch::Contains("no scene"));
  record(folder.file("run.lcmlog"));
  const Done no_video = render(folder, "run.lcmlog", "");
  CHECK(no_video.status == 1);
  CHECK_THAT(no_video.output, Catch::Contains("--video"));
}

TEST_CASE("A damaged log is rendered up to its damage, and the damage is counted") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  std::string bytes = bytes_of(folder.file("run.lcmlog"));
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 500; ++i) bytes[i] = 'x';
  bytes.resize(bytes.size() - 10);
  std::ofstream(folder.file("damaged.lcmlog"), std::ios::binary) << bytes;
  const Done done = render(folder, "damaged.lcmlog", "a.mp4");
  CAPTURE(done.output);
  CHECK(done.status == 0);
  CHECK_THAT(done.output, Catch::Contains("2 regions"));
  CHECK(frames_of(folder, "a.mp4").size() > 160);
}

TEST_CASE("A snapshot is written beside its video, and each wall of a room can be rendered") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  const Done left = render(folder, "run.lcmlog", "left.mp4",
                           {"--snapshot", folder.file("left.png"), "--set", "room=cave4", "--set", "wall=left"});
  const Done front = render(folder, "run.lcmlog", "front.mp4", {"--set", "room=cave4", "--set", "wall=front"});
  CAPTURE(left.output);
  REQUIRE(left.status == 0);
  REQUIRE(front.status == 0);
  CHECK(bytes_of(folder.file("left.png")).substr(1, 3) == "PNG");
  CHECK(left.after("pixels ") != front.after("pixels "));
  // The same numbers in both: frames locked by time are equal.
  const auto a = frames_of(folder, "left.mp4"), b = frames_of(folder, "front.mp4");
  REQUIRE(a.size() == b.size());
  REQUIRE(a.size() > 170);
  for (std::size_t i = 0; i < a.size(); ++i)
    CHECK(test::read_marker(a[i], kWidth, kHeight, 0)->frame ==
          test::read_marker(b[i], kWidth, kHeight, 0)->frame);
}
