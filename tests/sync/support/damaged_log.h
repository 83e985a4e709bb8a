// Logs with random damage, and the list of the events that stay whole.
#pragma once

#include <random>
#include <set>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "tests/sync/support/memory_sink.h"

namespace tactus::sync {

// The bytes of a log; owner: the event of each byte, -1 for none. Damage removes the affected events from `whole`.
struct DamagedLog {
  static constexpr std::int64_t kRun = 77, kBegin_ns = 5'000'000'000, kOffset_ns = 1'700'000'000'000'000'123;
  std::vector<std::uint8_t> bytes;
  std::vector<std::int64_t> owner;
  std::set<std::int64_t> whole;
  std::vector<std::vector<std::uint8_t>> data;

  // LOG_INFO, then `events` healths, 1 ms apart.
  explicit DamagedLog(int events) {
    const auto state = std::make_shared<MemorySink::State>();
    LogWriter writer(std::make_unique<MemorySink>(state));
    const auto write = [&](const char* channel, const auto& m, std::int64_t after_us) {
      data.push_back(encode(m));
      writer.write((kBegin_ns + kOffset_ns) / 1000 + after_us, channel, data.back());
      writer.flush();
      whole.insert(static_cast<std::int64_t>(data.size()) - 1);
      owner.resize(state->bytes.size(), static_cast<std::int64_t>(data.size()) - 1);
    };
    log_info_t info{};
    info.header = header_of("recorder", 1, 0, kBegin_ns, kRun);
    info.header.clock = 4711;
    info.realtime_offset_ns = kOffset_ns;
    write(channels::kLogInfo, info, 0);
    for (int i = 1; i < events; ++i) {
      node_health_t m{};
      m.header = header_of("some_node", 5, i, kBegin_ns + 1'000'000 * i - 50'000, kRun);
      m.header.clock = 4711;
      m.node = "some_node";
      // Half of them have the same length, so that a forged length may end at the beginning of another event.
      m.status_text = std::string(static_cast<std::size_t>(i % 2 ? 40 : i * 37 % 300), 'x');
      write(channels::kNodeHealth, m, 1000 * i);
    }
    bytes = state->bytes;
  }

  void touch(std::size_t at) {
    if (at < owner.size()) whole.erase(owner[at]);
  }
  void flip(std::mt19937& random) {
    if (bytes.empty()) return;
    const std::size_t at = random() % bytes.size();
    bytes[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
    touch(at);
  }
  void cut(std::mt19937& random) {
    if (bytes.empty()) return;
    const std::size_t from = random() % bytes.size(),
                      n = std::min<std::size_t>(random() % 600, bytes.size() - from);
    for (std::size_t i = from; i < from + n; ++i) touch(i);
    const auto erase = [&](auto& v) {
      v.erase(v.begin() + static_cast<std::ptrdiff_t>(from), v.begin() + static_cast<std::ptrdiff_t>(from + n));
    };
    erase(bytes), erase(owner);
  }
  // Inserts noise, zeros, sync words, or a piece of this log whose header announces data that do not follow.
  void insert(std::mt19937& random) {
    const std::size_t at = random() % (bytes.size() + 1);
    std::vector<std::uint8_t> garbage(random() % 400);
    const int kind = static_cast<int>(random() % 4);
    for (auto& b : garbage)
      b = kind == 0   ? static_cast<std::uint8_t>(random())
          : kind == 1 ? 0
                      : std::array<std::uint8_t, 5>{0xED, 0xA1, 0xDA, 0x01, 0}[random() % 5];
    if (kind == 3 && !bytes.empty()) {
      std::size_t from = random() % bytes.size();
      while (from > 0 && owner[from] == owner[from - 1]) --from;
      garbage.assign(
          bytes.begin() + static_cast<std::ptrdiff_t>(from),
          bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), from + 28 + random() % 60)));
    }
    if (at > 0 && at < bytes.size() && owner[at] == owner[at - 1]) touch(at);
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), garbage.begin(), garbage.end());
    owner.insert(owner.begin() + static_cast<std::ptrdiff_t>(at), garbage.size(), -1);
  }
  void damage(std::mt19937& random) {
    for (int n = 1 + static_cast<int>(random() % 8); n > 0; --n) switch (random() % 3) {
        case 0: flip(random); break;
        case 1: cut(random); break;
        default: insert(random);
      }
  }
};

}  // namespace tactus::sync
