// Tests of the recorder: order, buffering, assets and disk errors.
#include "sync/tools/recorder/recorder.h"

#include <catch2/catch.hpp>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/scene_manifest_t.hpp>

#include "lcmtypes/fields.h"
#include "sync/log/recorder_types.h"
#include "tests/sync/support/memory_sink.h"

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

// All events except the pages of the message types.
std::vector<LogEvent> read_but_types(std::span<const std::uint8_t> bytes) {
  std::vector<LogEvent> events = read_all(bytes);
  std::erase_if(events, [](const LogEvent& e) { return e.channel == kLogTypes; });
  return events;
}

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

  void receive(HostTime t, std::int64_t skip = 0) {
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

TEST_CASE("The head of a log precedes all recorded messages, is evenly spaced and contains the scene") {
  Fixture f;
  const Scene scene(30);
  for (int i = 0; i < 100; ++i) f.receive(kStart + Nanoseconds(i * 1'000'000));
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
    if (events[i].channel == kLogTypes) continue;
    if (const auto m = decode<scene_manifest_t>(events[i].data.data(), events[i].data.size())) {
      CHECK(received.empty());  // the manifest comes first, so that a receiver can assign the chunks
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

TEST_CASE("A log begins without the scene after a timeout") {
  Fixture f;
  f.receive(kStart + Nanoseconds(5'000'000));
  f.recorder.poll(kStart + Recorder::kWaitForScene - Nanoseconds(1));
  CHECK_FALSE(f.recorder.started());
  f.recorder.poll(kStart + Recorder::kWaitForScene);
  CHECK(f.recorder.started());
  const auto events = read_but_types(f.disk->bytes);
  REQUIRE(events.size() == 2);
  CHECK(events[0].channel == channels::kLogInfo);
  CHECK(events[1].channel == "LIVE");

  SECTION("a later scene adds nothing") {
    f.recorder.begin(Scene(3).assets, kStart + Nanoseconds(6'000'000'000));
    f.recorder.finish(kStart + Nanoseconds(7'000'000'000));
    CHECK(read_but_types(f.disk->bytes).size() == 2);
  }
}

TEST_CASE("A log begins without the scene when the buffer is full, and no message is lost") {
  Fixture f;
  asset_chunk_t m{};
  m.header = header_of("sim_node", 9, 0, 1);
  m.chunks = 1;
  m.size = 1024;
  m.data.resize(1024);
  int n = 0;
  for (; !f.recorder.started(); ++n) {
    f.batch.clear();
    m.header.seq = n;
    f.batch.add(kStart + Nanoseconds(n), {"LIVE", encode(m)}, 1 << 20);
    f.recorder.push(f.batch);
  }
  CHECK(n < static_cast<int>(Recorder::kMaxPendingBytes / 1024) + 1);
  f.recorder.finish(kStart);
  CHECK(read_but_types(f.disk->bytes).size() == static_cast<std::size_t>(n) + 1);
}

TEST_CASE("Messages are written if the recorder ends before the scene arrives") {
  Fixture f;
  f.receive(kStart);
  f.recorder.finish(kStart + Nanoseconds(1));
  CHECK(read_but_types(f.disk->bytes).size() == 2);
}

TEST_CASE("Missing sequence numbers are counted per channel") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.receive(kStart + Nanoseconds(1));
  f.receive(kStart + Nanoseconds(2), 3);
  f.receive(kStart + Nanoseconds(3));
  CHECK(f.recorder.gaps() == 3);
  CHECK_THAT(f.recorder.status_text(0, 0), Catch::Contains("gaps: LIVE 3"));
}

TEST_CASE("A full disk is reported and retried once a second, and recording continues") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.disk->trouble = "No space left on device";
  f.receive(kStart);
  f.recorder.poll(kStart);
  CHECK(f.recorder.failing());
  CHECK_THAT(f.recorder.status_text(0, 0), Catch::Contains("No space left on device"));
  f.disk->trouble.clear();
  f.recorder.poll(kStart + Nanoseconds(500'000'000));
  CHECK(f.recorder.failing());
  f.recorder.poll(kStart + Nanoseconds(1'000'000'000));
  CHECK_FALSE(f.recorder.failing());
  CHECK(read_but_types(f.disk->bytes).size() == 2);
}

TEST_CASE("An unknown message is recorded unchanged") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.batch.clear();
  for (std::size_t size : {0u, 1u, 7u, 8u, 60u}) f.batch.add(kStart, {"FOREIGN", Bytes(size, 0xff)}, 1 << 20);
  f.recorder.push(f.batch);
  f.recorder.finish(kStart);
  CHECK(read_but_types(f.disk->bytes).size() == 6);
  CHECK(f.recorder.gaps() == 0);
}

TEST_CASE("An oversized message is counted separately and not as lost") {
  Fixture f;
  CHECK_THAT(f.recorder.status_text(0, 1), Catch::Contains("1 dropped, larger than any Tactus message"));
  CHECK_THAT(f.recorder.status_text(0, 1), !Catch::Contains("lost"));
}

TEST_CASE("A log contains the description and fingerprint of each message type") {
  Fixture f;
  f.recorder.begin({}, kStart);
  f.recorder.finish(kStart);
  std::string text;
  int pages = 0;
  for (const LogEvent& e : read_all(f.disk->bytes)) {
    if (e.channel != kLogTypes) continue;
    CHECK(e.data.size() <= channels::kMaxMessageBytes);
    const std::string page(e.data.begin(), e.data.end());
    CHECK(page.starts_with("tactus types, page " + std::to_string(++pages) + " of "));
    text += page.substr(page.find('\n') + 1);
  }
  CHECK(pages == static_cast<int>(log_types().size()));
  for (const MessageType& t : message_types()) {
    char fingerprint[20];
    std::snprintf(fingerprint, sizeof fingerprint, "0x%016llx", static_cast<unsigned long long>(t.fingerprint));
    CHECK(text.find("struct " + std::string(t.name) + " " + fingerprint + "\n") != std::string::npos);
    for (const Field& field : t.fields)
      CHECK(text.find("  " + std::string(field.type) + " " + std::string(field.name)) != std::string::npos);
  }
  CHECK(text.find("channel WORLD_STATE world_state_t\n") != std::string::npos);
}

TEST_CASE("Each part of a split log has the head, and the parts contain every message once") {
  Fixture f;
  const Scene scene(5);
  std::vector<std::shared_ptr<MemorySink::State>> parts{f.disk};
  LogLimits limits;
  SECTION("the log is split by size") { limits.split_bytes = 60'000; }
  SECTION("the log is split by time") { limits.split_after = Nanoseconds(500'000'000); }
  f.recorder.limit(
      limits,
      [&] {
        parts.push_back(std::make_shared<MemorySink::State>());
        return std::make_unique<MemorySink>(parts.back());
      },
      nullptr);
  f.recorder.begin(scene.assets, kStart);
  for (int i = 0; i < 2000; ++i) {
    f.receive(kStart + Nanoseconds(1'000'000) * i);
    if (i % 20 == 0) f.recorder.poll(kStart + Nanoseconds(1'000'000) * i);
  }
  f.recorder.finish(kStart + Nanoseconds(2'000'000'000));
  REQUIRE(parts.size() > 3);
  CHECK(f.recorder.parts() == static_cast<int>(parts.size()));
  CHECK_THAT(f.recorder.status_text(0, 0), Catch::Contains("in " + std::to_string(parts.size()) + " parts"));
  std::int64_t next = 0;
  for (const auto& part : parts) {
    const auto events = read_all(part->bytes);
    REQUIRE(!events.empty());
    CHECK(events.front().channel == channels::kLogInfo);
    std::map<std::int64_t, Bytes> assets;
    for (const LogEvent& e : events) {
      const auto m = decode<asset_chunk_t>(e.data.data(), e.data.size());
      if (e.channel == channels::kAssetChunk && m) {
        Bytes& bytes = assets[m->hash];
        bytes.insert(bytes.end(), m->data.begin(), m->data.end());
      }
      if (e.channel == "LIVE") CHECK(m->header.seq == next++);
    }
    for (std::size_t i = 0; i < scene.assets.size(); ++i)
      CHECK(assets[scene.assets[i].ref.hash] == scene.bytes[i]);
  }
  CHECK(next == 2000);
}

TEST_CASE("If a new part cannot be created, the error is reported and the current part continues") {
  Fixture f;
  LogLimits limits;
  limits.split_after = Nanoseconds(100'000'000);
  f.recorder.limit(
      limits, []() -> std::unique_ptr<LogSink> { throw std::runtime_error("cannot create run.2.lcmlog"); },
      nullptr);
  f.recorder.begin({}, kStart);
  for (int i = 0; i < 300; ++i) {
    f.receive(kStart + Nanoseconds(1'000'000) * i);
    f.recorder.poll(kStart + Nanoseconds(1'000'000) * i);
  }
  CHECK(f.recorder.failing());
  CHECK_THAT(f.recorder.status_text(0, 0), Catch::Contains("cannot create run.2.lcmlog"));
  f.recorder.finish(kStart + Nanoseconds(300'000'000));
  CHECK(read_but_types(f.disk->bytes).size() == 301);
}

TEST_CASE("A log stops at its maximum size, and further messages are counted") {
  Fixture f;
  LogLimits limits;
  limits.max_bytes = 50'000;
  f.recorder.limit(limits, nullptr, nullptr);
  f.recorder.begin({}, kStart);
  for (int i = 0; i < 2000; ++i) f.receive(kStart + Nanoseconds(i));
  f.recorder.finish(kStart + Nanoseconds(5000));
  CHECK(f.disk->bytes.size() <= 50'000 + channels::kMaxMessageBytes);
  CHECK(f.recorder.beyond() > 0);
  CHECK(static_cast<std::int64_t>(read_but_types(f.disk->bytes).size()) + f.recorder.beyond() == 2001);
  CHECK_THAT(f.recorder.status_text(0, 0), Catch::Contains("beyond the maximum size"));
}

TEST_CASE("A message on any channel that LCM can send is recorded with all its bytes") {
  Fixture f;
  f.recorder.begin({}, kStart);
  std::vector<Bytes> contents;
  const std::vector<std::string> names{"imu data", "a,b\"c", "line\nbreak", "\xc3\x9c", "\xff\x01", std::string(63, 'L')};
  for (std::size_t i = 0; i < names.size(); ++i) contents.push_back(some_bytes(i));
  for (std::size_t i = 0; i < names.size(); ++i) {
    f.batch.clear();
    f.batch.add(kStart + Nanoseconds(1'000'000) * static_cast<std::int64_t>(i + 1), {names[i], contents[i]}, 1 << 20);
    f.recorder.push(f.batch);
  }
  f.recorder.finish(kStart + Nanoseconds(1'000'000'000));
  const auto events = read_but_types(f.disk->bytes);
  REQUIRE(events.size() == 1 + names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    CHECK(events[i + 1].channel == names[i]);
    CHECK(Bytes(events[i + 1].data.begin(), events[i + 1].data.end()) == some_bytes(i));
  }
}
