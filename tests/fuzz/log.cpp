// Arbitrary bytes read as a log: scanned, timestamped, sought and replayed. The scanner always continues and reports the number of skipped
// bytes; the replay sends no more events than the scanner found.
#include <cstdlib>

#include "sync/bus/decode.h"
#include "sync/log/log_time_ranges.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_seek.h"
#include "sync/tools/replay/replay.h"
#include "sync/tools/replay/replay_scene.h"

using namespace tactus::sync;

namespace {

// Returns the number of events found.
std::int64_t scan(std::span<const std::uint8_t> log, LogClockDetector& finder, LogTimeRanges& ages) {
  LogScanner scanner(log);
  LogEvent event;
  std::size_t at = 0;
  while (scanner.next(event)) {
    if (scanner.at() <= at || scanner.at() > log.size()) std::abort();
    at = scanner.at();
    finder.observe(event);
    ages.add(bounded_us(event.timestamp_us));
  }
  if (scanner.damaged_bytes() < 0 || scanner.damaged_bytes() > static_cast<std::int64_t>(log.size())) std::abort();
  return scanner.events();
}

void play(std::span<const std::uint8_t> log, const LogOrigin& origin, std::int64_t events) try {
  HostTime now = host_time(1'000'000'000);
  ReplayOptions options;
  options.speed = 0;
  options.from_head = true;
  Replay replay(log, origin, options, now);
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
  LogClockDetector finder;
  LogTimeRanges ages;
  const std::int64_t events = scan(log, finder, ages);
  const LogOrigin origin = finder.find();
  TimestampedEvents dated(log, origin, &ages);
  LogEvent event;
  HostTime time{};
  std::int64_t read = 0;
  while (dated.next(event, time)) ++read;
  if (read != events) std::abort();
  if (const auto span = span_of_log(log))
    for (const std::int64_t us : {span->first_us, span->last_us, span->first_us / 2 + span->last_us / 2})
      if (seek_log(log, us) > log.size()) std::abort();
  scene_of(log, origin);
  play(log, origin, events);
  return 0;
}
