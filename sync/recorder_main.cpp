// recorder: writes everything that crosses the bus to OUT/run.lcmlog, which the stock lcm-logplayer replays.
//
//   in   everything, on both ports; the scene and its assets for the head of the log
//   out  a file; its health says what was lost
//
// When nothing arrives it writes nothing; when the scene does not come in 5 s the log begins without it; when the
// disk is full it says so, keeps what it can, and goes on.
#include <time.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "sync/node.h"
#include "sync/recorder.h"
#include "sync/recorder_tap.h"

using namespace tactus;

namespace {

std::int64_t realtime_minus_monotonic_ns() {
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

int main(int argc, char** argv) try {
  const sync::Declaration declaration{.node = "recorder",
                                      .modality = "",
                                      .rate_Hz = 50,  // of writing to disk; a thread of its own stamps on arrival
                                      .fifo_priority = 40,
                                      .about = "Writes everything that crosses the bus to OUT/run.lcmlog."};
  CLI::App app;
  sync::NodeOptions options;
  log_info_t info{};
  std::string scene_file;
  options.add_to(app, declaration);
  app.add_option("--scene", scene_file, "scene of the run, noted in the log");
  app.add_option("--seconds", info.seconds, "length of the run, noted in the log");
  app.add_option("--git", info.git, "commit of the run, noted in the log");
  sync::parse_or_exit(app, declaration.node, argc, argv);
  info.scene = std::filesystem::path(scene_file).filename().string();
  info.version = TACTUS_VERSION;
  info.seed = static_cast<std::int64_t>(options.seed);
  info.realtime_offset_ns = realtime_minus_monotonic_ns();

  sync::Node node(declaration, options);
  sync::RecorderTap tap(options.bus);
  sync::SceneReceiver scene(node.bus());
  const std::string path = sync::new_log_path(options.out);
  sync::Recorder recorder(node.bus().identity(), info, sync::LogWriter(std::make_unique<sync::FileSink>(path)),
                          sync::host_now());
  std::cerr << "recorder: writing " << path << std::endl;

  sync::MessageBatch batch;
  while (node.running()) {
    const sync::HostTime now = node.wait();
    tap.take(batch);
    recorder.push(batch);
    if (scene.poll(now)) recorder.begin(assets_of(scene), now);
    recorder.poll(now);
    const bool trouble = recorder.failing() || recorder.lost() > 0 || tap.overflow() > 0;
    node.set_state(trouble ? node_health_t::OUTPUT_LOST : node_health_t::RUNNING,
                   recorder.note(tap.overflow(), tap.oversized()));
  }
  tap.stop();
  tap.take(batch);
  recorder.push(batch);
  recorder.finish(sync::host_now());
  std::cerr << "recorder: " << path << ": " << recorder.note(tap.overflow(), tap.oversized()) << std::endl;
  if (recorder.failing()) throw std::runtime_error(path + " is incomplete; make room on its disk");
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("recorder", e);
}
