#include "sync/recorder.h"

#include <catch2/catch.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/scene_manifest_t.hpp>

#include "tests/sync/memory_sink.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kOffsetNs = 1'700'000'000'000'000'000;
const HostTime kStart = host_time(1'000'000'000'000);

Bytes some_bytes(std::size_t n) {
  Bytes b(n);
  for (std::size_t i = 0; i < n; ++i) b[i] = static_cast<std::uint8_t>(i * 31 + n);
  return b;
}

struct Scene {
  std::vector<Bytes> bytes;
  std::vector<HeadAsset> assets;
  explicit Scene(int count, std::size_t name_length = 40) {
    for (int i = 0; i < count; ++i) bytes.push_back(some_bytes(static_cast<std::size_t>(1 + i * 700)));
    for (const Bytes& b : bytes) {
      asset_ref_t ref{};
      ref.hash = fnv1a_64(b.data(), b.size());
      ref.size = static_cast<std::int32_t>(b.size());
      ref.name = std::string(name_length, 'n');
      assets.push_back({ref, &b});
    }
  }
};

struct Fixture {
  std::shared_ptr<MemorySink::State> disk = std::make_shared<MemorySink::State>();
  Identity id{"recorder", 5, 6, 7};
  Recorder recorder;
  MessageBatch batch;
  std::int64_t seq = 0;

  static log_info_t info() {
    log_info_t i{};
    i.realtime_offset_ns = kOffsetNs;
    i.scene = "room.sdf";
    return i;
  }
  Fixture() : recorder(id, info(), LogWriter(std::make_unique<MemorySink>(disk)), kStart) {}

  void hear(HostTime t, std::int64_t skip = 0) {
    asset_chunk_t m{};
    m.header = header_of("sim_node", 9, seq += skip, to_ns(t));
    m.chunks = m.size = 1;
    m.data = {1};
    ++seq;
    batch.clear();
    batch.add(t, {"LIVE", encode(m)}, 1 << 20);
    recorder.push(batch);
  }
};

}  // namespace

TEST_CASE("The head of a log comes before everything that was heard, evenly spaced, and holds the whole scene") {
  Fixture f;
  const Scene scene(30);
  for (int i = 0; i < 100; ++i) f.hear(kStart + Nanoseconds(i * 1'000'000));
  f.recorder.poll(kStart + Nanoseconds(100'000'000));
  CHECK(f.disk->bytes.empty());
  f.recorder.begin(scene.assets, kStart + Nanoseconds(100'000'000));
  f.recorder.poll(kStart + Nanoseconds(120'000'000));

  const auto events = read_all(f.disk->bytes);
  REQUIRE(events.size() > 101);
  const std::size_t head = events.size() - 100;
  CHECK(events[head].timestamp_us == (to_ns(kStart) + kOffsetNs) / 1000);
  for (std::size_t i = 0; i < head; ++i) {
    CHECK(events[i].timestamp_us == events[head].timestamp_us - 500 * static_cast<std::int64_t>(head - i));
    CHECK(events[i].data.size() <= channels::kMaxMessageBytes);
  }

  REQUIRE(events[0].channel == channels::kLogInfo);
  const auto info = decode<log_info_t>(events[0].data.data(), events[0].data.size());
  REQUIRE(info);
  CHECK(info->realtime_offset_ns == kOffsetNs);
  CHECK(info->live_from_ns == to_ns(kStart));
  CHECK(info->scene == "room.sdf");

  std::vector<asset_ref_t> refs;
  std::map<std::int64_t, Bytes> received;
  int page = 0;
  for (std::size_t i = 1; i < head; ++i) {
    if (const auto m = decode<scene_manifest_t>(events[i].data.data(), events[i].data.size())) {
      CHECK(received.empty());  // the manifest comes first, so that a receiver knows what the chunks are for
      CHECK(m->page == page++);
      refs.insert(refs.end(), m->assets.begin(), m->assets.end());
      continue;
    }
    const auto chunk = decode<asset_chunk_t>(events[i].data.data(), events[i].data.size());
    REQUIRE(chunk);
    Bytes& bytes = received[chunk->hash];
    CHECK(bytes.size() == static_cast<std::size_t>(chunk->chunk) * kChunkBytes);
    bytes.insert(bytes.end(), chunk->data.begin(), chunk->data.end());
  }
  CHECK(page > 1);
  REQUIRE(refs.size() == scene.assets.size());
  for (std::size_t i = 0; i < refs.size(); ++i) {
    CHECK(refs[i].hash == scene.assets[i].ref.hash);
    CHECK(received[refs[i].hash] == scene.bytes[i]);
  }
}

TEST_CASE("A log begins without the scene when that does not come") {
  Fixture f;
  f.hear(kStart + Nanoseconds(5'000'000));
  f.recorder.poll(kStart + Recorder::kWaitForScene - Nanoseconds(1));
  CHECK_FALSE(f.recorder.begun());
  f.recorder.poll(kStart + Recorder::kWaitForScene);
  CHECK(f.recorder.begun());
  const auto events = read_all(f.disk->bytes);
  REQUIRE(events.size() == 2);
  CHECK(events[0].channel == channels::kLogInfo);
  CHECK(events[1].channel == "LIVE");

  SECTION("and a scene that comes later changes nothing: its chunks crossed the bus") {
    f.recorder.begin(Scene(3).assets, kStart + Nanoseconds(6'000'000'000));
    f.recorder.finish(kStart + Nanoseconds(7'000'000'000));
    CHECK(read_all(f.disk->bytes).size() == 2);
  }
}

TEST_CASE("A log begins at once when what waits for the scene grows too large, and nothing is lost") {
  Fixture f;
  asset_chunk_t m{};
  m.header = header_of("sim_node", 9, 0, 1);
  m.chunks = 1;
  m.size = 1024;
  m.data.resize(1024);
  int n = 0;
  for (; !f.recorder.begun(); ++n) {
    f.batch.clear();
    m.header.seq = n;
    f.batch.add(kStart + Nanoseconds(n), {"LIVE", encode(m)}, 1 << 20);
    f.recorder.push(f.batch);
  }
  CHECK(n < static_cast<int>(Recorder::kMaxHeldBytes / 1024) + 1);
  f.recorder.finish(kStart);
  CHECK(read_all(f.disk->bytes).size() == static_cast<std::size_t>(n) + 1);
}

TEST_CASE("Nothing that was heard is lost when the recorder ends before the scene comes") {
  Fixture f;
  f.hear(kStart);
  f.recorder.finish(kStart + Nanoseconds(1));
  CHECK(read_all(f.disk->bytes).size() == 2);
}

TEST_CASE("Messages that are missing in their numbering are counted by channel") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.hear(kStart + Nanoseconds(1));
  f.hear(kStart + Nanoseconds(2), 3);
  f.hear(kStart + Nanoseconds(3));
  CHECK(f.recorder.gaps() == 3);
  CHECK_THAT(f.recorder.note(0, 0), Catch::Contains("gaps: LIVE 3"));
}

TEST_CASE("A full disk is said, retried once a second, and recording goes on") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.disk->trouble = "No space left on device";
  f.hear(kStart);
  f.recorder.poll(kStart);
  CHECK(f.recorder.failing());
  CHECK_THAT(f.recorder.note(0, 0), Catch::Contains("No space left on device"));
  f.disk->trouble.clear();
  f.recorder.poll(kStart + Nanoseconds(500'000'000));
  CHECK(f.recorder.failing());
  f.recorder.poll(kStart + Nanoseconds(1'000'000'000));
  CHECK_FALSE(f.recorder.failing());
  CHECK(read_all(f.disk->bytes).size() == 2);
}

TEST_CASE("A message that is none of ours is recorded as it is") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.batch.clear();
  for (std::size_t size : {0u, 1u, 7u, 8u, 60u}) f.batch.add(kStart, {"FOREIGN", Bytes(size, 0xff)}, 1 << 20);
  f.recorder.push(f.batch);
  f.recorder.finish(kStart);
  CHECK(read_all(f.disk->bytes).size() == 6);
  CHECK(f.recorder.gaps() == 0);
}

TEST_CASE("What is larger than any message of the bus is left out, and is no loss for want of time") {
  Fixture f;
  CHECK_THAT(f.recorder.note(0, 1), Catch::Contains("1 left out, larger than any message of ours"));
  CHECK_THAT(f.recorder.note(0, 1), !Catch::Contains("lost"));
}
