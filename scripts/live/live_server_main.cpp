// live_server: shows a running cluster, or a log, in web pages, and forwards the requests of the pages.
//
//   in   all channels that a page shows; QUESTION; SIM_REPLY, SETTING_REPLY, SCENE_MANIFEST, ASSET_CHUNK
//   out  SIM_COMMAND, DEGRADATION, SETTING (stream of visual_node), TAG_REQUEST, DEVICE_STATE (device "live"), ANSWER: only
//   on request of a page
//
// No other process waits for it. A slow page loses only its own frames, which are counted. While no page is open, no message
// is decoded.
#include <signal.h>

#include <atomic>
#include <filesystem>
#include <iostream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <stdlib.h>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "scripts/live/controls.h"
#include "scripts/live/log_player.h"
#include "scripts/live/sliders.h"
#include "scripts/live/page_session.h"
#include "scripts/live/web_server.h"
#include "sync/bus/bus.h"
#include "sync/bus/receive_buffer.h"
#include "sync/node/node_options.h"
#include "sync/text/csv.h"
#include "sync/text/printable.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kLoopPeriod{5'000'000};      // design: the device of a page publishes at 200 Hz
constexpr double kStream_Hz = 15;                  // design: smooth enough to steer by, 12 KB each
constexpr std::size_t kMaxFileBytes = 8 << 20;
std::atomic<bool> stop{false};

struct Options {
  std::string log, page, bind = "127.0.0.1", token;
  bool prints_token = false;  // it was made here
  int http_port = 0, listen_fd = -1, run = 1;
  std::int64_t run_id = 1;
  sync::BusOptions bus;
};

live::PageFile read_file(const std::string& folder, const char* name, const char* type) {
  const auto path = std::filesystem::path(folder) / name;
  auto bytes = sync::read_small_file(path, kMaxFileBytes);
  if (!bytes || bytes->empty()) throw std::runtime_error(path.string() + " is missing; scripts/live/bundle makes the page");
  return {type, *std::move(bytes)};
}

std::string random_token() {
  std::random_device random;
  std::ostringstream text;
  for (int i = 0; i < 4; ++i) text << std::hex << (0x10000000u | random());
  return text.str();
}

std::shared_ptr<const std::string> shared(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

std::shared_ptr<const std::string> reply_message(const std::string& sentence, bool good) {
  return shared(nlohmann::json{{"t", "reply"}, {"text", sync::printable(sentence)}, {"good", good}}
                    .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

// The served content, with the open pages.
class Server {
 public:
  Server(const Options& o, live::PageSession& session)
      : session_(session),
        web_(o.listen_fd >= 0 ? o.listen_fd : live::listen_on(o.bind, o.http_port),
             {{"/", read_file(o.page, "index.html", "text/html; charset=utf-8")},
              {"/main.js", read_file(o.page, "main.js", "text/javascript; charset=utf-8")},
              {"/icon.svg", read_file(o.page, "icon.svg", "image/svg+xml")},
              {"/main.css", read_file(o.page, "main.css", "text/css; charset=utf-8")}},
             o.token, o.bind == "127.0.0.1",
             {[this](int page) { opened_.push_back(page); }, [this](int page) { session_.close(page); pages_.erase(page); },
              [this](int page, std::string_view text) { messages_.emplace_back(page, text); }}) {
    // The address is for the user. A token that was inherited is known to the process that made it, which prints it; this output may be a
    // log that other users can read.
    std::cout << "live_server: open http://" << o.bind << ":" << web_.port()
              << (o.prints_token ? "/?token=" + o.token : std::string("/ with the token that was inherited")) << std::endl;
  }
  // Calls handle(page, message) for each request of a page.
  template <class Handle>
  void step(Handle&& handle) {
    web_.run_for(kLoopPeriod);
    const sync::HostTime now = sync::host_now();
    for (const int page : std::exchange(opened_, {})) {
      session_.open(page);
      pages_.insert(page);
      web_.send(page, shared(session_.hello(now)));
    }
    for (const auto& [page, text] : std::exchange(messages_, {})) {
      if (!pages_.contains(page)) continue;
      try {
        live::BrowserMessage m = live::parse_browser_message(text);
        if (const auto* watch = std::get_if<live::WatchRequest>(&m)) {
          if (const std::string wrong = session_.watch(page, watch->names); !wrong.empty()) web_.send(page, reply_message(wrong, false));
        } else {
          handle(m);
        }
      } catch (const std::invalid_argument& e) {
        web_.send(page, reply_message(e.what(), false));
      }
    }
  }
  // Returns true when a frame was sent.
  bool send_frames(sync::HostTime now, const nlohmann::json& extra) {
    if (const auto picture = session_.picture()) {
      const auto bytes = shared(*picture);
      for (const int page : pages_) web_.send_picture(page, bytes);
    }
    if (sync::host_now() < next_frame_) return false;
    next_frame_ = sync::host_now() + live::PageSession::kFramePeriod;
    std::int64_t dropped = 0;
    for (const int page : pages_)
      if (const auto* q = web_.queue(page)) dropped += q->dropped() + q->dropped_pictures();
    nlohmann::json all = extra;
    all["pages"] = {{"open", pages_.size()}, {"dropped", dropped}, {"refused", web_.refused()}};
    for (auto& [page, frame] : session_.frames(now, all)) web_.send(page, shared(std::move(frame)));
    return true;
  }
  void send_reply(const std::string& sentence, bool good) {
    for (const int page : pages_) web_.send(page, reply_message(sentence, good));
  }
  bool has_pages() const { return !pages_.empty(); }

 private:
  live::PageSession& session_;
  std::vector<int> opened_;
  std::vector<std::pair<int, std::string>> messages_;
  std::set<int> pages_;
  sync::HostTime next_frame_{};
  live::WebServer web_;
};

void serve_log(const Options& o) {
  live::LogPlayer player(o.log, o.run);
  std::size_t reported_warnings = 0;
  live::PageSession session(false, 0, std::filesystem::path(o.log).filename());
  Server server(o, session);
  sync::HostTime last = sync::host_now();
  bool position_changed = false;  // the log position has changed, and no page has received it yet
  while (!stop) {
    server.step([&](const live::BrowserMessage& m) {
      if (const auto* play = std::get_if<live::LogPlay>(&m)) {
        player.play(play->play, play->rate);
      } else if (const auto* seek = std::get_if<live::LogSeek>(&m)) {
        player.seek(seek->to_s);
        session.clear();
        position_changed = true;
      } else {
        throw std::invalid_argument("a log cannot be changed; start scripts/run --live");
      }
    });
    const sync::HostTime now = sync::host_now();
    if (!player.scan_next()) {
      const std::vector<std::string> warnings = player.warnings();
      for (; reported_warnings < warnings.size(); ++reported_warnings)
        std::cerr << "live_server: " << sync::printable(o.log) << ": " << warnings[reported_warnings] << std::endl;
    }
    if (server.has_pages())  // playback waits for the first page
      player.advance(now - last, [&](std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime t) {
        if (session.accepts(channel)) session.on_message(channel, bytes, t);
      });
    last = now;
    nlohmann::json extra{{"log", {{"position_s", player.position_s()}, {"length_s", player.length_s()},
                                  {"playing", player.playing()}, {"rate", player.rate()}, {"damaged", player.damaged_regions()}, {"warnings", player.warnings()}}}};
    if (position_changed) extra["wound"] = true;
    if (server.send_frames(player.position(), extra)) position_changed = false;
  }
}

nlohmann::json scene_of(const scene_t& scene) {
  nlohmann::json bodies = nlohmann::json::array(), tools = nlohmann::json::array();
  for (const body_def_t& b : scene.bodies) bodies.push_back(sync::printable(b.name));
  for (const tool_def_t& t : scene.tools) tools.push_back(sync::printable(t.name));
  return {{"name", sync::printable(scene.name)}, {"bodies", bodies}, {"tools", tools}};
}

void serve_cluster(const Options& o) {
  sync::Bus bus(sync::Identity::fresh("live_server", o.run_id), o.bus);
  sync::drop_receive_buffer_right();
  bus.track_clocks();
  live::PageSession session(true, o.run_id, "live");
  Server server(o, session);
  live::Controls controls(bus, [&](const std::string& sentence, bool good) { server.send_reply(sentence, good); });
  std::vector<std::pair<std::string, sync::RawQueue*>> inputs;
  for (const Channel& c : channel_types()) {
    const std::size_t capacity = c.name == channels::kPictureChunk ? 1024 : 128;  // design: some iterations of each
    inputs.emplace_back(c.name, &bus.raw(std::string(c.name).c_str(), capacity));
    inputs.back().second->set_enabled(false);
  }
  bool streaming = false, had_pages = false;
  sync::HostTime opened{}, next_scene{};
  std::int64_t sent_generation = -1;  // generation of the profile that `degradation` shows
  nlohmann::json degradation = live::degradation_json("");
  while (!stop) {
    server.step([&](const live::BrowserMessage& m) {
      const sync::HostTime now = sync::host_now();
      if (const auto* command = std::get_if<live::Command>(&m)) controls.command(*command, now);
      else if (const auto* degrade = std::get_if<live::DegradeRequest>(&m)) controls.degrade(*degrade, sync::realtime_ns(), now);
      else if (const auto* hand = std::get_if<live::HandTarget>(&m)) controls.hand(*hand, session.picture_aspect(), now);
      else if (const auto* answer = std::get_if<live::PageAnswer>(&m)) session.answers().answer(*answer, now);
      else throw std::invalid_argument("a running world cannot seek; open its log");
    });
    const sync::HostTime now = sync::host_now();
    bus.drain(now);
    for (auto& [name, queue] : inputs) {
      queue->set_enabled(session.accepts(name));
      queue->read([&, channel = std::string_view(name)](std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
        session.on_message(channel, bytes, arrival);
      });
    }
    if (auto answer = session.answers().take_answer()) bus.publish(channels::kAnswer, *answer);
    const bool has_pages = server.has_pages();
    if (has_pages && !had_pages) opened = now;
    // A stream that another program requested is left unchanged: if pictures arrive already, this server neither starts nor
    // stops it.
    if (has_pages && !streaming && now - opened > sync::from_seconds(1) &&
        (!session.picture_arrival() || now - *session.picture_arrival() > sync::from_seconds(2))) {
      controls.stream(kStream_Hz, now);
      streaming = true;
      opened = now;
    }
    if (streaming && has_pages && session.picture_arrival() && now - *session.picture_arrival() > sync::from_seconds(4) && now - opened > sync::from_seconds(5)) {
      streaming = false;  // visual_node was restarted and has lost the request
    }
    if (!has_pages && had_pages && streaming) {
      controls.stream(0, now);
      streaming = false;
    }
    had_pages = has_pages;
    if (has_pages) controls.request_tags(session.requested_tags(), now);
    controls.step(now);
    const auto world = controls.world(now);
    nlohmann::json extra{{"world", {{"known", world.known}, {"sim_s", world.sim_s}, {"rate", world.rate}}},
                         {"profile", std::to_string(controls.profile() ? controls.profile()->hash : 0)}};
    if (const std::int64_t generation = controls.profile() ? controls.profile()->generation : -1; generation != sent_generation) {
      sent_generation = generation;
      degradation = live::degradation_json(controls.profile()->text);
      next_scene = now;  // immediately
    }
    // Repeats it once a second, for new pages.
    if (controls.scene() != nullptr && now >= next_scene) {
      extra["degradation"] = degradation;
      extra["scene"] = scene_of(*controls.scene());
      if (server.send_frames(now, extra)) next_scene = now + sync::from_seconds(1);
      continue;
    }
    server.send_frames(now, extra);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Shows a running cluster, or a log, in a web page; prints the address. scripts/run --live starts it.");
  Options o;
  app.add_option("LOG", o.log, "shows this log instead of a running cluster");
  app.add_option("--run", o.run, "number of the run, of a log with several").range(1, 1'000'000).show_default();
  app.add_option("--page", o.page, "folder of the page, made by scripts/live/bundle").required();
  app.add_option("--http-port", o.http_port, "port of the page; 0: any free port").range(0, 65535).show_default();
  app.add_option("--bind", o.bind, "address of the page's server; beyond 127.0.0.1 any user with the token can control the cluster").show_default();
  app.add_option("--listen-fd", o.listen_fd, "inherited listening socket, instead of --http-port").range(0, 1'000'000);
  app.add_option("--token", o.token, "token of the address, which other users of this machine can then see; default: $TACTUS_LIVE_TOKEN, otherwise random").environment("TACTUS_LIVE_TOKEN");
  app.add_option("--port", o.bus.port, "UDP port of the bus").environment("TACTUS_PORT").range(1, 65534).show_default();
  app.add_option("--run-id", o.run_id, "number of the cluster run").environment("TACTUS_RUN_ID").show_default();
  sync::parse_or_exit(app, "live_server", argc, argv);
  for (int s : {SIGINT, SIGTERM, SIGHUP}) signal(s, [](int) { stop = true; });
  signal(SIGPIPE, SIG_IGN);
  unsetenv("TACTUS_LIVE_TOKEN");
  if (o.token.empty()) o.token = random_token(), o.prints_token = true;
  if (o.token.size() < 16 || o.token.size() > 128)
    throw std::runtime_error("--token: give 16 to 128 letters and digits, or none");
  if (o.log.empty()) serve_cluster(o);
  else serve_log(o);
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("live_server", e);
}
