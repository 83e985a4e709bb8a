// recorder: writes every message on the bus to OUT/run.lcmlog, which the stock lcm-logplayer replays.
//
//   in   every message, on both ports; the scene and its assets for the head of the log
//   out  a file; its health reports losses; TAG_REQUEST, so that tagged variables are in the log
//
// Without messages it writes nothing. When the scene does not arrive within 5 s, the log begins without it. When the disk is
// full, it reports that, stores as much as fits in memory, and continues. Received messages are passed to the kernel within
// 20 ms: SIGKILL loses no more. After a power failure the data that the kernel had not written is missing, by Linux' defaults
// up to the last 30 s.
#include "sync/assets/scene_receiver.h"
#include "sync/tools/recorder/recorder_node.h"

#include <time.h>

#include <filesystem>
#include <iostream>
#include <tactus/asset_ref_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/tag_request_t.hpp>

#include "lcmtypes/valid.h"
#include "sync/bus/receive_buffer.h"
#include "sync/node/node.h"
#include "sync/tools/recorder/recorder.h"
#include "sync/tools/recorder/recorder_tap.h"
#include "sync/virtual_time/virtual_time.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kRequestPeriod{1'000'000'000};  // a request holds for three (lcmtypes/types/control/tag_request_t.lcm)

// Throws std::runtime_error with one sentence.
tag_request_t request_for(std::vector<std::string> patterns) {
  if (patterns == std::vector<std::string>{"none"}) patterns.clear();
  tag_request_t m{};
  m.header.sim_time_ns = -1;
  m.pattern_count = static_cast<std::int32_t>(patterns.size());
  m.patterns = std::move(patterns);
  m.header.run_id = m.header.incarnation = 1;  // for the check only: the bus fills them in
  if (!valid(m)) throw std::runtime_error("--tags: give at most 16 patterns of at most 128 letters, or none");
  return m;
}

std::int64_t realtime_minus_monotonic_ns() {
  if (sync::VirtualTime::current()) return 0;  // virtual time has no date
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec - sync::to_ns(sync::host_now());
}

std::vector<sync::HeadAsset> assets_of(const sync::SceneReceiver& scene) {
  std::vector<sync::HeadAsset> assets;
  for (const asset_ref_t& ref : scene.manifest())
    if (const sync::Asset* asset = scene.asset(ref.hash)) assets.push_back({ref, &asset->bytes});
  return assets;
}

}  // namespace

int tactus::sync::run_recorder(int argc, char** argv) try {
  const sync::NodeDescriptor descriptor{.name = "recorder",
                                        .modality = "",
                                        .rate_Hz = 50,  // of writing to disk; a separate thread stamps messages on arrival
                                        .fifo_priority = 40,
                                        .about = "Writes all messages on the bus to OUT/run.lcmlog.",
                                        .opens_sockets = true};
  sync::Arguments app;
  sync::NodeOptions options;
  log_info_t info{};
  std::string scene_file;
  options.add_to(app, descriptor);
  app.add_option("--scene", scene_file, "scene of the run, noted in the log");
  app.add_option("--seconds", info.seconds, "length of the run, noted in the log");
  app.add_option("--git", info.git, "commit of the run, noted in the log");
  double split_mb = 0, split_minutes = 0, max_mb = 0;
  sync::LogLimits limits;
  app.add_option("--split-mb", split_mb, "starts another file, which can be replayed alone, at this size").range(1.0, 1e6);
  app.add_option("--split-minutes", split_minutes, "starts another file after this time").range(0.01, 1e5);
  app.add_option("--keep", limits.keep, "number of the newest files to keep; needs --split-mb or --split-minutes").range(1, 100'000);
  app.add_option("--max-mb", max_mb, "size limit of all files: the oldest are removed; messages that exceed it in a single file are dropped and counted")
      .range(1.0, 1e7);
  std::vector<std::string> patterns{"*"};
  app.add_option("--tags", patterns, "tagged variables to record, as node.tag with * for any letters, or none; may be repeated")
      .show_default();
  sync::parse_or_exit(app, descriptor.name, argc, argv);
  info.scene = std::filesystem::path(scene_file).filename().string();
  info.version = TACTUS_VERSION;
  info.seed = static_cast<std::int64_t>(options.seed);
  info.realtime_offset_ns = realtime_minus_monotonic_ns();

  limits.split_bytes = static_cast<std::int64_t>(split_mb * 1e6);
  limits.split_after = sync::from_seconds(60 * split_minutes);
  limits.max_bytes = static_cast<std::int64_t>(max_mb * 1e6);
  if (limits.keep > 0 && !limits.splits()) throw std::runtime_error("--keep needs --split-mb or --split-minutes");
  if (limits.splits() && limits.max_bytes > 0 && limits.split_bytes * 2 > limits.max_bytes)
    throw std::runtime_error(
        "--max-mb must be at least twice --split-mb, so that one complete file remains while the next is written");

  tag_request_t tag_request = request_for(patterns);
  sync::Node node(descriptor, options);
  sync::RecorderTap tap(options.bus);
  sync::drop_receive_buffer_right();
  sync::SceneReceiver scene(node.bus());
  sync::LogParts parts(options.out, limits);
  std::unique_ptr<sync::LogSink> first = parts.open();
  const std::string path = parts.path();
  sync::Recorder recorder(node.bus().identity(), info, sync::LogWriter(std::move(first)), sync::host_now());
  recorder.limit(limits, [&] { return parts.open(); },
                 [&](std::int64_t bytes) { return parts.prune(bytes), parts.bytes_before(); });
  std::cerr << "recorder: writing " << path << std::endl;

  sync::MessageBatch batch;
  sync::HostTime next_request{};
  while (node.running()) {
    const sync::HostTime now = node.wait();
    tap.take(batch);
    recorder.push(batch);
    if (scene.poll(now)) recorder.begin(assets_of(scene), now);
    recorder.poll(now);
    if (tag_request.pattern_count > 0 && now >= next_request) {
      node.bus().publish(channels::kTagRequest, tag_request);
      next_request = now + kRequestPeriod;
    }
    const bool failing = recorder.failing() || recorder.lost() > 0 || recorder.beyond() > 0 || tap.overflow() > 0;
    node.set_state(failing ? node_health_t::OUTPUT_LOST : node_health_t::RUNNING,
                   recorder.status_text(tap.overflow(), tap.oversized()));
  }
  tap.stop();
  tap.take(batch);
  recorder.push(batch);
  recorder.finish(sync::host_now());
  std::cerr << "recorder: " << path << ": " << recorder.status_text(tap.overflow(), tap.oversized()) << std::endl;
  if (recorder.failing()) throw std::runtime_error(path + " is incomplete; free space on its disk");
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("recorder", e);
}
