#include "visual_node/frame/frame_peers.h"

#include <catch2/catch.hpp>
#include <tactus/frame_shown_t.hpp>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

struct PeersOfWall {
  static constexpr std::int64_t kOwn = 1, kLeft = 2, kRight = 3;
  FramePeers peers;
  sync::HostTime now = sync::host_time(10'000'000'000);

  void drawn(std::int64_t wall, std::int64_t frame) {
    frame_shown_t m{};
    m.header.incarnation = wall, m.frame = frame;
    peers.on_message(m, kOwn, now);
  }
  // One frame of this wall, of which `wall` has drawn `of_it`.
  bool frame(std::int64_t k, std::int64_t wall, std::int64_t of_it) {
    drawn(wall, of_it);
    const bool ready = peers.ready(k, now);
    peers.shown(k, now);
    now += sync::Nanoseconds(16'666'667);
    return ready;
  }
};

}  // namespace

TEST_CASE_METHOD(PeersOfWall, "A single wall waits neither for other walls nor for its own messages") {
  CHECK(peers.ready(5, now));
  drawn(kOwn, 1);
  CHECK(peers.ready(5, now));
  CHECK(peers.present(now) == 0);
}

TEST_CASE_METHOD(PeersOfWall, "A frame is ready when every present wall has drawn it or a later one") {
  drawn(kLeft, 5);
  drawn(kRight, 4);
  CHECK_FALSE(peers.ready(5, now));
  drawn(kRight, 8);
  CHECK(peers.ready(5, now));
}

TEST_CASE_METHOD(PeersOfWall, "A wall without messages for a second is absent") {
  drawn(kLeft, 4);
  CHECK_FALSE(peers.ready(5, now + milliseconds(1000)));
  CHECK(peers.ready(5, now + milliseconds(1001)));
  CHECK(peers.present(now + milliseconds(1001)) == 0);
}

TEST_CASE_METHOD(
    PeersOfWall, "A wall that is always late is ignored after 250 ms and returns when it keeps up") {
  std::int64_t k = 100;
  int waited = 0;
  for (int i = 0; i < 60; ++i, ++k) waited += !frame(k, kLeft, k - 3);
  CHECK(waited == FramePeers::kMaxLateFrames);
  CHECK(peers.ignored(now) == 1);
  for (int i = 0; i < FramePeers::kFramesToReturn; ++i, ++k) CHECK(frame(k, kLeft, k));
  CHECK(peers.ignored(now) == 0);
  CHECK_FALSE(frame(k, kLeft, k - 1));
}

TEST_CASE_METHOD(PeersOfWall, "A wall at a sixth of the rate is ignored, one that misses every third frame is not") {
  std::int64_t k = 100;
  for (int i = 0; i < 60; ++i, ++k) frame(k, kLeft, k / 6 * 6);
  CHECK(peers.ignored(now) == 1);
  for (int i = 0; i < 300; ++i, ++k) frame(k, kRight, k % 3 == 0 ? k - 1 : k);
  CHECK(peers.ignored(now) == 0);  // the left wall is absent
  CHECK(peers.present(now) == 1);
}

TEST_CASE_METHOD(PeersOfWall, "The number of walls is limited") {
  for (std::int64_t wall = 10; wall < 10'000; ++wall) drawn(wall, 1);
  CHECK(peers.present(now) == static_cast<int>(FramePeers::kMax));
}
