// Tests of the exchange of a scene manifest and its assets, with loss and forged chunks.
#include "sync/assets/scene_receiver.h"
#include "sync/assets/scene_sender.h"

#include <catch2/catch.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>

#include "sync/bus/bus.h"
#include "sync/bus/decode.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

scene_t small_scene(const std::string& name) {
  scene_t s{};
  s.name = name;
  s.step_ns = 1'000'000;
  s.camera.orientation.w = s.listener.orientation.w = 1;
  s.camera_fov_rad = 1;
  return s;
}

std::vector<Asset> assets_of(const std::string& name, std::size_t mesh_bytes) {
  Bytes mesh(mesh_bytes);
  for (std::size_t i = 0; i < mesh.size(); ++i) mesh[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return {{asset_ref_t::SCENE, "scene", encode(small_scene(name))}, {asset_ref_t::MESH, "mesh", mesh}};
}

BusOptions in_memory() {
  BusOptions o;
  o.memory = true;
  return o;
}

}  // namespace

TEST_CASE("A late joiner receives the whole scene once") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  SceneSender sender(bus, assets_of("room", 100'000));
  SceneReceiver receiver(bus);
  int complete = 0;
  HostTime now = host_time(1);
  for (int ms = 0; ms < 300; ++ms, now += Nanoseconds(1'000'000)) {
    sender.poll(now);
    bus.drain(now);
    complete += receiver.poll(now);
  }
  REQUIRE(complete == 1);
  CHECK(receiver.scene()->name == "room");
  const std::int64_t mesh = sender.manifest()[1].hash;
  REQUIRE(receiver.asset(mesh) != nullptr);
  CHECK(receiver.asset(mesh)->bytes == assets_of("room", 100'000)[1].bytes);
  CHECK(receiver.asset(12345) == nullptr);
}

TEST_CASE("The sender never sends more than kChunksPerPoll chunks at once") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  SceneSender sender(bus, assets_of("room", 500'000));
  auto& chunks = bus.queue<asset_chunk_t>(channels::kAssetChunk, 10'000);
  SceneReceiver receiver(bus);
  HostTime now = host_time(1);
  for (int ms = 0; ms < 200; ++ms, now += Nanoseconds(1'000'000)) {
    sender.poll(now);
    bus.drain(now);
    receiver.poll(now);
    int sent = 0;
    while (chunks.pop()) ++sent;
    CHECK(sent <= SceneSender::kChunksPerPoll);
  }
}

TEST_CASE("A flood of requests for one asset does not keep another asset or later chunks from being sent") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  SceneSender sender(bus, assets_of("room", 2'000'000));
  auto& chunks = bus.queue<asset_chunk_t>(channels::kAssetChunk, 10'000);
  auto& requests = bus.queue<asset_request_t>(channels::kAssetRequest, 10'000);
  const std::int64_t mesh = sender.manifest()[1].hash;
  const auto request = [&](std::int64_t hash, std::int32_t first, std::int32_t count) {
    asset_request_t m{};
    m.header.sim_time_ns = -1;
    m.hash = hash;
    m.first_chunk = first, m.chunk_count = count;
    bus.publish(channels::kAssetRequest, m, Port::kBulk);
  };
  HostTime now = host_time(1);
  bool sent_scene = false, sent_end = false;
  for (int ms = 0; ms < 600; ++ms, now += Nanoseconds(1'000'000)) {
    for (int i = 0; i < 300; ++i) request(mesh, 0, 1 << 20);
    if (ms == 10) request(sender.manifest()[0].hash, 0, 1);
    bus.drain(now);
    sender.poll(now);
    while (requests.pop()) continue;
    bus.drain(now);
    int sent = 0;
    while (const auto m = chunks.pop()) {
      ++sent;
      sent_scene = sent_scene || m->message.hash != mesh;
      sent_end = sent_end || m->message.chunk == m->message.chunks - 1;
    }
    CHECK(sent <= SceneSender::kChunksPerPoll);
  }
  CHECK(sent_end);
  CHECK(sent_scene);
}

TEST_CASE("Forged chunks do not become an asset") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  SceneSender sender(bus, assets_of("room", 3'000));
  SceneReceiver receiver(bus);
  HostTime now = host_time(1);
  // A forged sender answers first, with wrong bytes for the mesh.
  const asset_ref_t& mesh = sender.manifest()[1];
  bool done = false;
  for (int ms = 0; ms < 1000 && !done; ++ms, now += Nanoseconds(1'000'000)) {
    if (ms == 2) {
      asset_chunk_t forged{};
      forged.header.sim_time_ns = -1;
      forged.hash = mesh.hash;
      forged.chunks = 3;
      forged.size = 1024;
      forged.data.assign(1024, 0xee);
      bus.publish(channels::kAssetChunk, forged, Port::kBulk);
    }
    sender.poll(now);
    bus.drain(now);
    done = receiver.poll(now);
  }
  REQUIRE(done);
  CHECK(receiver.asset(mesh.hash)->bytes == assets_of("room", 3'000)[1].bytes);
}

TEST_CASE("A new scene replaces the old one and drops its assets") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  SceneReceiver receiver(bus);
  HostTime now = host_time(1);
  std::int64_t old_mesh = 0;
  for (const std::string name : {"first", "second"}) {
    Bus* shared = &bus;
    SceneSender sender(*shared, assets_of(name, name == "first" ? 2'000 : 4'000));
    bool done = false;
    for (int ms = 0; ms < 1000 && !done; ++ms, now += Nanoseconds(1'000'000)) {
      sender.poll(now);
      bus.drain(now);
      done = receiver.poll(now);
    }
    REQUIRE(done);
    CHECK(receiver.scene()->name == name);
    if (name == "first") old_mesh = sender.manifest()[1].hash;
  }
  CHECK(receiver.asset(old_mesh) == nullptr);
}

namespace {

// A receiver on an in-memory bus, and announcers of any incarnation.
struct Exchange {
  Bus bus{Identity::fresh("receiver", 1), in_memory()};
  SceneReceiver receiver{bus};
  HostTime now = host_time(1'000'000'000);

  bool poll() {
    bus.drain(now);
    const bool complete = receiver.poll(now);
    now += Nanoseconds(1'000'000);
    return complete;
  }
  // A forged page: its incarnation differs from that of the real sender.
  void forge(std::int64_t incarnation, const std::vector<asset_ref_t>& refs, int page = 0, int pages = 1) {
    scene_manifest_t m{};
    m.header.sim_time_ns = -1;
    m.header.run_id = 1;
    m.header.incarnation = incarnation;
    m.page = page, m.pages = pages;
    m.assets = refs;
    m.count = static_cast<int>(refs.size());
    const Bytes bytes = encode(m);
    for (const auto& inbox : bus.inboxes())
      if (inbox->count().channel == channels::kSceneManifest) inbox->accept(bytes.data(), bytes.size(), now);
  }
};

asset_ref_t ref_of(std::int64_t hash, std::int32_t size) {
  asset_ref_t r{};
  r.hash = hash;
  r.size = size;
  r.kind = asset_ref_t::MESH;
  r.name = std::string(1, 'x');
  return r;
}

}  // namespace

TEST_CASE("A manifest above the limits allocates no memory") {
  Exchange x;
  SECTION("too many bytes in total") {
    std::vector<asset_ref_t> refs;
    for (int i = 0; i < 10; ++i) refs.push_back(ref_of(i, 64 << 20));
    x.forge(99, refs);
  }
  SECTION("one asset is too large") { x.forge(99, {ref_of(1, (64 << 20) + 1)}); }
  SECTION("too many assets") {
    for (int page = 0; page < 60; ++page) {
      std::vector<asset_ref_t> refs;
      for (int i = 0; i < 12; ++i) refs.push_back(ref_of(page * 12 + i, 1));
      x.forge(99, refs, page, 60);
    }
    for (int i = 0; i < 20; ++i) x.poll();
  }
  SECTION("too many pages") { x.forge(99, {ref_of(1, 1)}, 0, 2000); }
  x.poll();
  CHECK(x.receiver.manifest().empty());
  CHECK(x.receiver.bytes_held() == 0);
}

TEST_CASE("The sender rejects a scene with more assets than a receiver accepts") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  std::vector<Asset> assets;
  for (std::size_t i = 0; i <= SceneReceiver::kMaxAssets; ++i)
    assets.push_back({asset_ref_t::MESH, "m", Bytes(i + 1, 1)});
  CHECK_THROWS_WITH(SceneSender(bus, assets), Catch::Contains("remove some"));
}

TEST_CASE("Memory is allocated as chunks arrive and released when an incomplete transfer times out") {
  Exchange x;
  x.forge(99, {ref_of(1, 64 << 20), ref_of(2, 64 << 20), ref_of(3, 64 << 20)});
  asset_chunk_t m{};
  m.header.sim_time_ns = -1;
  m.hash = 2;
  m.chunks = 65536;
  m.size = 1024;
  m.data.assign(1024, 0xee);
  for (int i = 0; i < 2000; ++i) {
    m.chunk = i % 2 == 0 ? i / 2 : 65535 - i;  // one as requested, one far ahead
    x.bus.publish(channels::kAssetChunk, m, Port::kBulk);
    x.poll();
  }
  CHECK(x.receiver.bytes_held() == 1000 * 1024);
  for (int i = 0; i < 3100; ++i) x.poll();
  CHECK(x.receiver.bytes_held() == 0);
  CHECK(x.receiver.manifest().empty());
}

TEST_CASE("A second announcer does not replace the scene while the first one is active") {
  Exchange x;
  SceneSender sender(x.bus, assets_of("room", 10'000));
  const auto run = [&](int ms, bool announce) {
    int complete = 0;
    for (int i = 0; i < ms; ++i) {
      if (announce) sender.poll(x.now);
      if (i % 100 == 50) x.forge(99, {ref_of(1, 1 << 20)});
      complete += x.poll();
    }
    return complete;
  };
  REQUIRE(run(3000, true) == 1);
  CHECK(x.receiver.manifest().size() == 2);
  SECTION("after the first falls silent, its scene stays until the scene of the second is complete") {
    CHECK(run(4000, false) == 0);
    CHECK(x.receiver.manifest().size() == 1);
    CHECK(x.receiver.scene()->name == "room");
    CHECK(x.receiver.asset(sender.manifest()[1].hash) != nullptr);
  }
}

TEST_CASE("A large asset is received completely in chunks") {
  Exchange x;
  SceneSender sender(x.bus, assets_of("room", 3'000'000));
  bool done = false;
  for (int ms = 0; ms < 5000 && !done; ++ms) {
    sender.poll(x.now);
    done = x.poll();
  }
  REQUIRE(done);
  CHECK(x.receiver.asset(sender.manifest()[1].hash)->bytes == assets_of("room", 3'000'000)[1].bytes);
  CHECK(x.receiver.bytes_held() >= 3'000'000);
}
