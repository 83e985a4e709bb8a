#include "sync/scene_exchange.h"

#include <catch2/catch.hpp>

#include "sync/decode.h"

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

TEST_CASE("A late joiner gets the whole scene, and a second poll says nothing new") {
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

TEST_CASE("The sender never sends more than its share of chunks at once") {
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

TEST_CASE("Forged chunks do not become an asset") {
  Bus bus(Identity::fresh("test", 1), in_memory());
  SceneSender sender(bus, assets_of("room", 3'000));
  SceneReceiver receiver(bus);
  HostTime now = host_time(1);
  // A forger answers first with wrong bytes for the mesh.
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

TEST_CASE("Another scene replaces the first, and what it does not name is forgotten") {
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
