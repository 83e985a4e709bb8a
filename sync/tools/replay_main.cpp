// replay: plays a log to the renderers of a running cluster, in place of its simulation.
//
//   in   a log; commands from --control; ASSET_REQUEST
//   out  the messages of the log, as if they were sent now; the scene of the log on request
//
// It begins when the processes of --live have the scene, for a bounded time, and needs none of them. Damaged parts of the log are
// skipped and counted.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tactus/asset_ref_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <utility>

#include "sync/assets/scene_sender.h"
#include "sync/log/log_index.h"
#include "sync/log/mapped_log.h"
#include "sync/node/node.h"
#include "sync/node/world_start.h"
#include "sync/text/printable.h"
#include "sync/tools/replay/replay.h"
#include "sync/tools/replay/replay_selection.h"
#include "sync/tools/replay/replay_control.h"
#include "sync/tools/replay/replay_port.h"
#include "sync/tools/replay/replay_scene.h"

using namespace tactus;

namespace {

// Datagrams that the kernel dropped at the sockets of the running nodes, since their first health.
class KernelDrops {
 public:
  explicit KernelDrops(sync::Bus& bus) : run_id_(bus.identity().run_id), healths_(bus.queue<node_health_t>(channels::kNodeHealth, 64)) {}
  // Also passes each report to `start`.
  void update(sync::WorldStart& start) {
    while (const auto m = healths_.pop()) {
      start.observe(m->message);
      const header_t& h = m->message.header;
      if (h.run_id != run_id_ || m->message.kernel_drops < 0 || (nodes_.size() >= kMax && !nodes_.contains({h.source, h.incarnation}))) continue;
      nodes_.try_emplace({h.source, h.incarnation}, m->message.kernel_drops, 0).first->second.second = m->message.kernel_drops;
    }
  }
  std::int64_t sum() const {
    std::int64_t sum = 0;
    for (const auto& [node, drops] : nodes_) sum += drops.second - drops.first;
    return sum;
  }

 private:
  static constexpr std::size_t kMax = 64;
  std::int64_t run_id_;
  sync::Queue<node_health_t>& healths_;
  std::map<std::pair<std::int32_t, std::int64_t>, std::pair<std::int64_t, std::int64_t>> nodes_;  // first and newest
};

std::vector<sync::Asset>::const_iterator scene_asset(const std::vector<sync::Asset>& assets) {
  return std::find_if(assets.begin(), assets.end(), [](const sync::Asset& a) { return a.kind == asset_ref_t::SCENE; });
}

// Prints the properties of a log that tactus replay needs before it starts any process.
void describe(const sync::LogIndex& index, int number, const std::vector<sync::Asset>& assets, double length_s) {
  const auto properties = [](const sync::LogOrigin& origin) {
    nlohmann::json j;
    j["scene"] = sync::printable(origin.info.scene);
    j["version"] = sync::printable(origin.info.version);
    j["git"] = sync::printable(origin.info.git);
    j["seed"] = origin.info.seed;
    j["of_tactus"] = origin.known;
    j["recovered"] = origin.recovered;
    return j;
  };
  const sync::RecordedRun& run = index.run(number);
  nlohmann::json j = properties(run.origin);
  j["length_s"] = length_s;
  j["assets"] = assets.size();
  j["tools"] = nlohmann::json::array();
  if (const auto it = scene_asset(assets); it != assets.end())
    if (const auto scene = sync::decode_asset<scene_t>(it->bytes))
      for (const tool_def_t& tool : scene->tools) j["tools"].push_back(sync::printable(tool.name));
  j["run"] = number;
  j["runs"] = nlohmann::json::array();
  for (std::size_t i = 0; i < index.runs().size(); ++i) {
    const sync::RecordedRun& r = index.runs()[i];
    nlohmann::json one = properties(r.origin);
    one["run"] = i + 1;
    one["run_id"] = r.run_id;
    one["replayed_run_ids"] = r.guests;
    one["length_s"] = r.length_s();
    one["messages"] = r.events - r.copies;
    one["copies"] = r.copies;
    one["clock_jumps_s"] = nlohmann::json::array();
    for (const auto& jump : r.jumps) one["clock_jumps_s"].push_back(static_cast<double>(jump.by_us) * 1e-6);
    j["runs"].push_back(one);
  }
  j["damaged_regions"] = index.damaged_regions();
  j["warnings"] = index.warnings(number);
  if (index.damaged_regions() > 0)
    j["warnings"].push_back("the log is damaged in " + std::to_string(index.damaged_regions()) + " places; the messages there are lost");
  std::cout << j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

// The descriptor of --control, or -1 without one. A pipe without a writer, before or after one, is not at its end.
int open_control(const std::string& control) {
  if (control.empty()) return -1;
  const int fd = control == "-" ? STDIN_FILENO : open(control.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) throw std::runtime_error("--control " + control + " cannot be read; make it with mkfifo");
  if (fd == STDIN_FILENO) fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
  return fd;
}

// A replay with a scene is paused until the processes of --live have it.
class Beginning {
 public:
  Beginning(sync::Replay& replay, const sync::WorldStartDef& def, bool has_scene)
      : replay_(replay), max_wait_s_(sync::to_seconds(def.max_wait)), processes_(def, sync::host_now()), waits_(has_scene) {
    if (waits_) replay_.pause(sync::host_now());
  }
  sync::WorldStart& processes() { return processes_; }
  bool waits() const { return waits_; }
  // True once: when the replay begins. paused: it begins paused.
  bool now(sync::HostTime now, bool paused) {
    if (begun_ || (waits_ && !processes_.due(now))) return false;
    if (waits_ && !processes_.late().empty())
      std::cerr << "replay: begins without " << sync::printable(processes_.late()) << ": not ready after " << max_wait_s_
                << " s; it misses the first messages. Increase --ready-timeout" << std::endl;
    if (waits_ && !paused) replay_.resume(now);
    waits_ = false;
    return begun_ = true;
  }

 private:
  sync::Replay& replay_;
  double max_wait_s_;
  sync::WorldStart processes_;
  bool waits_, begun_ = false;
};

// The command line.
struct ReplayArguments {
  std::string log, speed = "1", control;
  sync::ReplayOptions play;
  sync::ReplaySelectionOptions selection_options;
  bool only_describe = false, stay = false;
  double ready_timeout_s = 10;  // as ready_timeout of sim_node/settings.csv
  int run = 1;

  void add_to(sync::Arguments& app) {
    app.add_option("LOG", log, "run.lcmlog of a run, or a log of the stock lcm-logger").required();
    app.add_option("--speed", speed, "0.01 to 100 times the original speed, or max: as fast as --most allows").show_default();
    app.add_option("--run", run, "number of the run, of a log with several; --describe lists them").range(1, 1'000'000).show_default();
    app.add_option("--start", play.start_s, "s since the world began");
    app.add_option("--end", play.end_s, "s since the world began; default: the end of the log");
    app.add_flag("--loop", play.loop, "starts again at the end");
    app.add_flag("--paused", play.paused, "waits for a command of --control");
    app.add_option("--most", play.max_per_s, "messages per second, at any speed").range(1.0, 1e6).show_default();
    app.add_option("--channels", selection_options.channels, "regular expression: only channels that match as a whole");
    app.add_option("--leave-out", selection_options.leave_out,
                   "regular expression: channels that match are not sent");
    app.add_option("--also", selection_options.also,
                   "regular expression: also sends these channels, which are dropped by default");
    app.add_option("--rename", selection_options.rename, "FROM=TO, channels; may be repeated");
    app.add_option("--live", selection_options.live, "a running process, whose recorded messages are not sent; may be repeated");
    app.add_option("--ready-timeout", ready_timeout_s, "longest wait for the processes of --live to have the scene, s").range(0.0, 300.0).show_default();
    app.add_flag("--as-recorded", selection_options.as_recorded, "applies the degradation profiles of the log");
    app.add_flag("--verbatim", selection_options.verbatim,
                 "sends every message of every channel unchanged, like the stock lcm-logplayer");
    app.add_option("--control", control, "named pipe to read commands from, or - for stdin");
    app.add_flag("--stay", stay, "keeps running at the end of the log");
    app.add_flag("--describe", only_describe, "prints the contents of the log as JSON and exits");
  }
};

// Position, speed, and faults of a replay. refused: messages that the network did not take.
std::string position_text(const sync::Replay& replay, const sync::LogIndex& index, const sync::ReplayOptions& play, std::int64_t refused) {
  std::ostringstream text;
  text << std::fixed;
  text.precision(2);
  text << replay.position_s() << " of " << replay.length_s() << " s at ";
  replay.speed() == 0 ? text << "full speed" : text << replay.speed() << " x";
  text << (replay.over() ? ", over" : replay.paused() ? ", paused" : "") << ", " << replay.sent() << " messages";
  if (replay.behind_s() > 0) text << ", " << replay.behind_s() << " s behind, because at most " << play.max_per_s << " messages per second are sent";
  if (refused > 0) text << ", " << refused << " refused by the network";
  if (index.damaged_regions() > 0)
    text << ", " << index.damaged_regions() << " damaged places (" << index.damaged_bytes() << " bytes) skipped";
  return text.str();
}

const sync::NodeDescriptor kReplay{.name = "replay",
                                   .modality = "",
                                   .rate_Hz = 1000,
                                   .fifo_priority = 50,
                                   .about = "Plays a log to the senses of a running cluster, in place of its simulation."};

// The result of `use`. Its errors name the log.
template <class F>
decltype(auto) naming(const std::string& log, F&& use) {
  try {
    return use();
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(sync::printable(log) + " " + e.what());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app;
  sync::NodeOptions options;
  options.add_to(app, kReplay);
  ReplayArguments arguments;
  arguments.add_to(app);
  sync::parse_or_exit(app, kReplay.name, argc, argv);
  auto& [log, speed, control, play, selection_options, only_describe, stay, ready_timeout_s, run] = arguments;
  play.speed = sync::speed_of(speed);
  if (play.speed < 0) throw std::runtime_error("--speed " + speed + ": give a number from 0.01 to 100, or max");

  const sync::MappedLog file(log, selection_options.verbatim ? sync::LogTypes::kAny : sync::LogTypes::kCurrent);
  sync::LogIndex index(file.bytes());
  index.read_all();
  const sync::RecordedRun& recorded = naming(log, [&]() -> const sync::RecordedRun& { return index.run(arguments.run); });
  const sync::LogOrigin& origin = recorded.origin;
  if (!origin.known && !selection_options.verbatim && !only_describe && index.events() > 0)
    std::cerr << "replay: " << sync::printable(log) << " holds no message of Tactus; it is played as it is\n";
  selection_options.verbatim |= !origin.known;
  play.from_head = selection_options.verbatim;
  sync::ReplaySelection selection(selection_options);
  const int played = selection_options.verbatim ? sync::TimestampedEvents::kWholeFile : run;
  sync::Replay replay_of_log = naming(log, [&] { return sync::Replay(index, played, arguments.play, sync::host_now()); });
  sync::Replay* const replay = &replay_of_log;
  const std::vector<sync::Asset> assets = selection_options.verbatim ? std::vector<sync::Asset>() : sync::scene_of(file.bytes(), recorded);
  if (only_describe) return describe(index, run, assets, replay->length_s()), 0;

  for (const std::string& sentence : index.warnings(selection_options.verbatim ? 0 : run)) std::cerr << "replay: " << sync::printable(log) << ": " << sentence << "\n";
  sync::Node node(kReplay, options);
  if (!origin.recovered.empty()) std::cerr << "replay: " << sync::printable(log) << ": " << origin.recovered << "\n";
  if (!selection_options.verbatim && scene_asset(assets) == assets.end())
    std::cerr << "replay: " << sync::printable(log)
              << " contains no complete scene; modalities without a scene stay idle\n";
  std::optional<sync::SceneSender> scene;
  if (!assets.empty()) scene.emplace(node.bus(), assets);
  sync::ReplayPort port(options.bus);
  sync::ReplayStamps stamps(origin, node.bus().identity());
  const int control_fd = open_control(control);
  KernelDrops drops(node.bus());

  sync::Lines lines;
  std::vector<std::uint8_t> message;
  bool quit = false, end_reported = false;
  const auto status_text = [&] { return position_text(*replay, index, arguments.play, port.refused()); };
  Beginning beginning(*replay, {.awaited = selection_options.live, .run_id = options.run_id, .max_wait = sync::from_seconds(ready_timeout_s)},
                      scene.has_value());
  sync::HostTime next_status{};
  while (node.running() && !quit) {
    const sync::HostTime now = node.wait();
    drops.update(beginning.processes());
    if (beginning.now(now, play.paused)) std::cerr << "replay: begins, " << status_text() << std::endl;
    char bytes[512];
    for (ssize_t n; control_fd >= 0 && (n = read(control_fd, bytes, sizeof bytes)) > 0;) lines.add({bytes, static_cast<std::size_t>(n)});
    for (std::string line; lines.take(line);) {
      const std::string error = sync::execute_command(*replay, line, now, quit);
      std::cerr << "replay: " << (error.empty() ? status_text() : error) << std::endl;
      end_reported = end_reported && replay->over();
    }
    replay->poll(now, [&](const sync::LogEvent& event, const sync::ReplayMoment& moment) {
      stamps.observe(event, moment);
      const auto channel = selection.channel_of(event);
      if (!channel) return false;
      message.assign(event.data.begin(), event.data.end());
      if (!selection.verbatim()) stamps.restamp(message, moment, now);
      port.send(*channel, message);
      return true;
    });
    if (scene) scene->poll(now, beginning.waits() ? sync::SceneSender::kOfferPeriod : sync::SceneSender::kPeriod);
    if (now >= next_status) {
      next_status = now + sync::from_seconds(0.1);
      node.set_state(node_health_t::RUNNING, status_text());
    }
    if (!replay->over()) continue;
    if (!stay) break;
    if (!end_reported) std::cerr << "replay: over, " << status_text() << std::endl;
    end_reported = true;
  }
  std::cerr << "replay: ends, " << status_text() << "; " << drops.sum() << " dropped by the kernel at the nodes' sockets" << std::endl;
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("replay", e);
}
