// Tests of two walls of one room on two hosts whose clocks differ: each frame shows the same instant and the same head on both, at any
// speed of either wall, and neither wall waits for the other.
#include <tactus/frame_shown_t.hpp>
#include <tactus/node_health_t.hpp>

#include "tests/cluster/support/two_machines.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

struct TwoHosts {
  static constexpr const char* kLeft = "visual_node";
  static constexpr const char* kFront = "visual_node_front";
  static constexpr std::int64_t kFrames = 120;  // of a wall at 60 Hz; more than 100 frames allow a share of 99 %
  // Frames show the head and the world of this time ago, s. It exceeds the drawing time of a picture of this size beside other load, so
  // that no frame begins before its data have arrived.
  static constexpr const char* kLag = "frame_lag=0.3";
  struct ShownFrame {
    std::int64_t world_ns = 0, head_ns = 0;
  };

  Cable cable;
  std::optional<RunningCluster> running;
  std::map<std::string, std::map<std::int64_t, ShownFrame>> frames;  // by wall and number

  // Returns false where the system allows no second host. front: command prefix of the wall there.
  bool start(const std::vector<std::string>& front = {}, const std::string& lock = "time") {
    if (!cable.is_ready()) {
      WARN("skipped: this system does not allow a second network namespace with a cable");
      return false;
    }
    running.emplace();
    shown_ = &running->monitor.bus().queue<frame_shown_t>(channels::kFrameShown, 4096);
    const std::string scene = repository() / "tests/cluster/scenes/walls.sdf";
    spawn({}, "sync_node", "sync_node");
    spawn(cable.remote_prefix(), "sync_node", "sync_node_there");
    spawn({}, "haptic_node", "haptic_node");
    spawn({}, "haptic_node", "haptic_node_head", {"--tool", "head"});
    spawn({}, "visual_node", kLeft, wall_options("left", lock));
    std::vector<std::string> words = wall_options("front", lock);
    words.insert(words.end(), front.begin(), front.end());
    spawn(cable.remote_prefix(), "visual_node", kFront, words);
    spawn({}, "sim_node", "sim_node", {scene});
    const bool alive = running->monitor.wait_until(
        [&] {
          return running->all_running({"sim_node", kLeft, kFront});
        },
        kTimeout_s);
    UNSCOPED_INFO(running->log_text() << running->processes.output(kFront));
    REQUIRE(alive);
    running->monitor.receive_for(1);  // until the clocks of both are mapped
    return true;
  }
  // Receives until the left wall has shown kFrames more frames, and both walls have shown at least `both`.
  void record_frames(std::int64_t both) {
    frames.clear();
    while (shown_->pop()) continue;
    const bool enough = running->monitor.wait_until(
        [&] {
          drain();
          return static_cast<std::int64_t>(frames[kLeft].size()) >= kFrames && common() >= both;
        },
        kTimeout_s);
    INFO(frames[kLeft].size() << " frames left, " << frames[kFront].size() << " in front, " << common()
                              << " of both");
    REQUIRE(enough);
  }
  std::int64_t common() const {
    return count([](const ShownFrame&, const ShownFrame&) { return true; });
  }
  // Number of frames that both walls have shown and for which the predicate holds.
  template <class Predicate>
  std::int64_t count(const Predicate& predicate) const {
    std::int64_t n = 0;
    const auto left = frames.find(kLeft), front = frames.find(kFront);
    if (left == frames.end() || front == frames.end()) return 0;
    for (const auto& [number, frame] : left->second)
      if (const auto other = front->second.find(number); other != front->second.end())
        n += predicate(frame, other->second);
    return n;
  }
  void check_agreement() const {
    const std::int64_t n = common();
    INFO(n << " frames of both");
    CHECK(count([](auto& a, auto& b) { return a.world_ns == b.world_ns; }) >= 0.99 * static_cast<double>(n));
    CHECK(count([](auto& a, auto& b) { return a.head_ns == b.head_ns; }) >= 0.99 * static_cast<double>(n));
    CHECK(count([](auto& a, auto&) { return a.head_ns >= 0 && a.world_ns >= 0; }) == n);  // and the frame has one
    // Agreement on a static world and head would prove nothing.
    std::set<std::int64_t> worlds, heads;
    for (const auto& [number, frame] : frames.at(kLeft))
      worlds.insert(frame.world_ns), heads.insert(frame.head_ns);
    CHECK(worlds.size() == frames.at(kLeft).size());
    CHECK(heads.size() > frames.at(kLeft).size() / 2);
  }

 private:
  static std::vector<std::string> wall_options(const std::string& wall, const std::string& lock) {
    std::vector<std::string> words{"--no-video"};
    for (const std::string& s : {std::string("room=cave4"), "wall=" + wall, std::string("width=320"),
                                 std::string("height=320"), std::string(kLag), "frame_lock=" + lock})
      words.insert(words.end(), {"--set", s});
    return words;
  }
  void spawn(std::vector<std::string> words, const std::string& program, const std::string& name,
             const std::vector<std::string>& options = {}) {
    words.insert(words.end(),
                 {(programs() / program).string(), "--name", name, "--run-id", std::to_string(RunningCluster::kRunId),
                  "--out", running->folder.path().string(), "--ttl", "1"});
    words.insert(words.end(), options.begin(), options.end());
    running->processes.spawn(name, words);
  }
  void drain() {
    while (const auto m = shown_->pop())
      for (const char* wall : {kLeft, kFront})
        if (const node_health_t* h = running->monitor.health(wall);
            h && h->header.incarnation == m->message.header.incarnation &&
            m->message.stage == frame_shown_t::SHOWN)
          frames[wall][m->message.frame] = {m->message.header.sim_time_ns, m->message.head_ns};
  }

  sync::Queue<frame_shown_t>* shown_ = nullptr;
};

}  // namespace

TEST_CASE("Two walls on two hosts show the same time and the same head pose in 99 of 100 frames", "[exact]") {
  TwoHosts c;
  if (!c.start()) return;
  c.record_frames(100);
  c.check_agreement();
}

TEST_CASE("A wall keeps its rate beside another that draws ten pictures a second, and both show the same state", "[exact]") {
  TwoHosts c;
  if (!c.start({"--emulate-load", "5"})) return;  // wastes five of six periods
  c.record_frames(20);
  c.check_agreement();
  // The slow wall begins at most one of six frames, beside any other work of the machine. If the left wall waited for it, both would
  // show the same frames.
  const auto left = static_cast<double>(c.frames[TwoHosts::kLeft].size());
  CHECK(static_cast<double>(c.common()) < 0.5 * left);
  const auto& front = c.frames[TwoHosts::kFront];
  const auto due = static_cast<double>(front.rbegin()->first - front.begin()->first + 1);
  CHECK(static_cast<double>(front.size()) < 0.3 * due);
}

TEST_CASE("Walls that wait for each other show the same state, and stop waiting for a dead wall") {
  TwoHosts c;
  if (!c.start({}, "wait")) return;
  c.record_frames(100);
  c.check_agreement();
  const auto before = c.running->rates(2);
  c.running->processes.kill(TwoHosts::kFront);
  c.running->check_rates_hold(before, 2);
}
