// Arbitrary bytes read as a log: scanned, timestamped, sought and replayed. The scanner always continues and reports the number of skipped
// bytes; the replay sends no more events than the scanner found.
#include <cstdlib>

#include "sync/bus/decode.h"
#include "sync/log/log_index.h"
#include "sync/log/timestamped_events.h"
#include "sync/tools/replay/replay.h"
#include "sync/tools/replay/replay_scene.h"

using namespace tactus::sync;

namespace {

// Returns the number of events found.
std::int64_t scan(std::span<const std::uint8_t> log) {
  LogScanner scanner(log);
  LogEvent event;
  std::size_t at = 0;
  while (scanner.next(event)) {
    if (scanner.at() <= at || scanner.at() > log.size()) std::abort();
    at = scanner.at();
  }
  if (scanner.damaged_bytes() < 0 || scanner.damaged_bytes() > static_cast<std::int64_t>(log.size())) std::abort();
  return scanner.events();
}

void play(const LogIndex& index, std::int64_t events) try {
  const LogOrigin& origin = index.run(1).origin;
  HostTime now = host_time(1'000'000'000);
  ReplayOptions options;
  options.speed = 0;
  options.from_head = true;
  Replay replay(index, TimestampedEvents::kWholeFile, options, now);
  ReplayStamps stamps(origin, {"replay", 9, 1234, 5678, 4242});
  std::vector<std::uint8_t> message;
  for (int i = 0; i < 100 && !replay.over(); ++i)
    replay.poll(now += Nanoseconds(10'000'000), [&](const LogEvent& event, const ReplayMoment& moment) {
      stamps.observe(event, moment);
      message.assign(event.data.begin(), event.data.end());
      stamps.restamp(message, moment, now);
      return true;
    });
  if (replay.sent() > events) std::abort();
  replay.seek(replay.length_s() / 2, now);
  replay.poll(now += Nanoseconds(10'000'000), [](const LogEvent&, const ReplayMoment&) { return true; });
} catch (const std::runtime_error&) {
  // rejected with one sentence: nothing to replay
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> log(data, size);
  const std::int64_t events = scan(log);
  LogIndex index(log);
  index.read_all();
  if (index.events() != events) std::abort();
  std::int64_t read = 0, copies = 0;
  for (std::size_t run = 0; run < index.runs().size(); ++run) {
    TimestampedEvents dated(index, static_cast<int>(run) + 1);
    LogEvent event;
    HostTime time{}, before = HostTime::min();
    for (; dated.next(event, time); before = time, ++read)
      if (time < before) std::abort();
    copies += index.runs()[run].copies;
    scene_of(log, index.runs()[run]);
  }
  if (read + copies != events) std::abort();
  index.warnings(0);
  play(index, events);
  return 0;
}
