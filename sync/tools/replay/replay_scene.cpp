#include "sync/tools/replay/replay_scene.h"

#include <tactus/asset_ref_t.hpp>

#include "sync/assets/scene_receiver.h"
#include "sync/bus/bus.h"

namespace tactus::sync {

std::vector<Asset> scene_of(std::span<const std::uint8_t> log, const RecordedRun& run) {
  const LogOrigin& origin = run.origin;
  BusOptions options;
  options.memory = true;
  options.clock = origin.info.header.clock;
  Bus bus(Identity{"replay", 1, 1, std::max<std::int64_t>(1, origin.info.header.run_id), options.clock}, options);
  SceneReceiver receiver(bus);
  LogScanner scanner(log.first(run.end));
  scanner.seek(run.begin);
  // One tick of a receiver after each message; the time is synthetic, so that no timeout occurs.
  HostTime now = host_time(1'000'000'000);
  const auto assets = [&] {
    std::vector<Asset> out;
    for (const asset_ref_t& ref : receiver.manifest())
      if (const Asset* asset = receiver.asset(ref.hash)) out.push_back({ref.kind, ref.name, asset->bytes});
    return out;
  };
  for (LogEvent e; scanner.at() - run.begin < kMaxSceneBytes && scanner.next(e);) {
    if (e.channel != channels::kSceneManifest && e.channel != channels::kAssetChunk) continue;
    now += Nanoseconds(1000);
    bus.on_message(e.channel, e.data, now);
    if (receiver.poll(now)) return assets();
  }
  for (int i = 0; i < 10'000; ++i)
    if (receiver.poll(now += Nanoseconds(1000))) return assets();
  return {};
}

}  // namespace tactus::sync
