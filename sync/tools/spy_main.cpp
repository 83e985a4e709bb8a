// spy: shows all messages on the bus, by channel, in a terminal.
//
//   in   every message, on both ports
//   out  the terminal; TAG_REQUEST while variables are shown
//
// It is passive, except for the requests for variables.
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "sync/bus/bus_arguments.h"
#include "sync/bus/bus.h"
#include "sync/bus/receive_buffer.h"
#include "sync/node/node_options.h"
#include "sync/tools/recorder/recorder_tap.h"
#include "sync/tools/spy/screen.h"

using namespace tactus;
using nlohmann::json;

namespace {

constexpr sync::Nanoseconds kDrawEvery{250'000'000};
constexpr sync::Nanoseconds kRequestPeriod{1'000'000'000};
std::atomic<bool> stop{false};

// Restores the terminal on any exit except SIGKILL.
class Terminal {
 public:
  Terminal() {
    tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | ISIG);
    raw.c_cc[VMIN] = 0, raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    std::cout << "\033[?1049h\033[?25l" << std::flush;  // the alternate screen, no cursor
  }
  ~Terminal() {
    std::cout << "\033[?25h\033[?1049l" << std::flush;
    tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // The typed bytes; waits at most this time.
  static std::string typed(sync::Nanoseconds max_wait) {
    pollfd fd{STDIN_FILENO, POLLIN, 0};
    char bytes[256];
    if (poll(&fd, 1, static_cast<int>(max_wait.count() / 1'000'000)) <= 0) return "";
    const ssize_t n = read(STDIN_FILENO, bytes, sizeof bytes);
    if (n == 0) stop = true;  // the terminal is gone
    return n > 0 ? std::string(bytes, static_cast<std::size_t>(n)) : "";
  }

  void show(const std::vector<std::string>& lines, std::size_t marked) const {
    std::string all = "\033[H";
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool bold = i == 0 || i + 1 == lines.size();
      all += std::string(i == marked ? "\033[7m" : bold ? "\033[1m" : "") + lines[i] + "\033[0m\033[K" + (i + 1 < lines.size() ? "\r\n" : "");
    }
    std::cout << all << "\033[J" << std::flush;
  }

 private:
  termios before_{};
};

std::pair<std::size_t, std::size_t> terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20 || size.ws_row < 5) return {110, 40};
  return {size.ws_col, size.ws_row};
}

json to_json(const sync::spy::ChannelFigures& f) {
  json j{{"channel", f.name}, {"type", f.type}, {"messages", f.messages}, {"rate_Hz", f.rate_Hz}, {"bytes_per_s", f.bytes_per_s},
         {"gaps", f.gaps}, {"torn", f.torn}, {"senders", f.senders}, {"jitter_p50_ms", f.jitter.p50_ms}, {"jitter_p99_ms", f.jitter.p99_ms}};
  if (!f.type.empty()) j["age_ms"] = f.age_ms;
  if (f.age_uncertainty_ms >= 0) j["age_uncertainty_ms"] = f.age_uncertainty_ms;
  return j;
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Shows all messages on the bus in a terminal: each channel's rate, bandwidth, gaps, jitter and age, the fields of "
               "its newest message, and tagged variables."};
  sync::BusOptions bus_options;
  double once_s = 0;
  std::string json_file;
  std::int64_t run_id = 1;
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "cluster run whose clocks and variables are used").environment("TACTUS_RUN_ID").positive();
  app.add_option("--once", once_s, "receives for this number of seconds, prints the table and ends; status 1 when no message was received").range(0.1, 3600.0);
  app.add_option("--json", json_file, "with --once: the same figures as JSON").needs("--once");
  sync::parse_or_exit(app, "spy", argc, argv);
  for (int s : {SIGINT, SIGTERM, SIGHUP}) signal(s, [](int) { stop = true; });

  sync::Bus bus(sync::Identity::fresh("spy", run_id), bus_options);
  sync::drop_receive_buffer_right();
  bus.track_clocks();
  if (once_s == 0 && (isatty(STDIN_FILENO) != 1 || isatty(STDOUT_FILENO) != 1))
    throw std::runtime_error("this is not a terminal; give --once SECONDS for a table");
  auto& lists = bus.queue<tag_list_t>(channels::kTagList, 256);
  auto& values = bus.queue<tag_values_t>(channels::kTagValues, 4096);
  sync::RecorderTap tap(bus_options);
  sync::MessageBatch batch;
  sync::spy::Channels channel_stats(bus.clocks());
  sync::spy::Screen screen;
  std::optional<Terminal> terminal;
  if (once_s == 0) terminal.emplace();
  const sync::HostTime end = sync::host_now() + sync::from_seconds(once_s);
  sync::HostTime ask{}, draw{};
  std::string typed;
  while (!stop && !screen.over() && (once_s == 0 || sync::host_now() < end)) {
    if (terminal) {
      typed += Terminal::typed(kDrawEvery / 10);
      for (const sync::spy::Key key : sync::spy::take_keys(typed)) screen.press(key), draw = {};
    } else {
      bus.wait(kDrawEvery / 10);
    }
    const sync::HostTime now = sync::host_now();
    bus.drain(now);
    tap.take(batch);
    while (const auto m = lists.pop()) screen.push(m->message);
    while (const auto m = values.pop())
      if (m->message.header.run_id == run_id && !screen.paused()) screen.push(m->message, m->arrival);
    if (!screen.paused())
      for (std::size_t i = 0; i < batch.size(); ++i) channel_stats.push(batch[i]);
    if (screen.shows_tags() && now >= ask) {
      ask = now + kRequestPeriod;
      tag_request_t request{};
      request.header.sim_time_ns = -1;
      request.patterns = {"*"}, request.pattern_count = 1;
      bus.publish(channels::kTagRequest, request);
    }
    if (terminal && now >= draw) {
      draw = now + kDrawEvery;
      if (!screen.paused()) screen.sample(channel_stats, now);
      const auto [columns, rows] = terminal_size();
      const auto lines = screen.draw(channel_stats, now, columns, rows);
      terminal->show(lines, screen.marked());
    }
  }
  if (once_s == 0) return 0;
  const sync::HostTime now = sync::host_now();
  if (channel_stats.messages() == 0)
    throw std::runtime_error("received no message on port " + std::to_string(bus_options.port) + "; start spy with tactus spy, or give its --port");
  auto lines = screen.draw(channel_stats, now, 160, sync::spy::Channels::kMax + 8);
  lines.pop_back();  // the keys
  for (const std::string& line : lines) std::cout << line << "\n";
  if (!json_file.empty()) {
    json all = json::array();
    for (const auto& f : channel_stats.figures(now)) all.push_back(to_json(f));
    std::ofstream file(json_file);
    file << json{{"seconds", once_s}, {"messages", channel_stats.messages()}, {"lost_here", tap.overflow()}, {"channels", all}}.dump(1, ' ', false, json::error_handler_t::replace) << "\n";
    if (!file.flush()) throw std::runtime_error("cannot write " + json_file + "; give --json a writable file");
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("spy", e);
}
