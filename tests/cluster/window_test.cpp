// Tests of the window of visual_node on a separate display server (Xvfb): its picture, keys and mouse, and the node's behaviour when the
// window or the server closes.
#include <signal.h>

#include <set>
#include <tactus/answer_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/question_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/bus.h"
#include "tests/cluster/support/picture_cluster.h"
#include "tests/cluster/support/question_leader.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr int kScreenWidth = 1024, kScreenHeight = 768;  // size of the screen, pixels; the window is 640 x 480 at its upper left

struct Desktop : PictureCluster {
  std::string display;
  sync::Bus bus{sync::Identity::fresh("desktop_test", kRunId), {}};
  sync::Queue<world_state_t>& worlds{bus.queue<world_state_t>(channels::kWorldState, 4096)};
  sync::Queue<device_state_t>& devices{bus.queue<device_state_t>(channels::kDeviceState, 4096)};
  sync::Queue<answer_t>& answers{bus.queue<answer_t>(channels::kAnswer, 4096)};
  std::map<std::int64_t, std::vector<answer_t>> answered;  // by id
  double rate = -1;          // rate of the world, as last published; -1: unknown
  int mouse_messages = 0;             // number of messages of the mouse as a device
  std::set<float> mouse_y_m;  // world y of the mouse in those messages, m

  void start_server() {
    // -r: a key whose release is late does not repeat.
    processes.spawn("Xvfb", {"Xvfb", "-r", "-displayfd", "1", "-screen", "0",
                             std::to_string(kScreenWidth) + "x" + std::to_string(kScreenHeight) + "x24", "-nolisten", "tcp"});
    monitor.wait_until([&] { return processes.output("Xvfb").find('\n') != std::string::npos; }, kTimeout_s);
    const std::string output = processes.output("Xvfb");
    INFO("Xvfb (Debian package xvfb): " << output);
    const std::size_t end = output.find_last_of("0123456789");
    REQUIRE(end != std::string::npos);
    display = ":" + output.substr(output.find_last_not_of("0123456789", end) + 1);
    display = display.substr(0, display.find('\n'));
  }
  std::vector<std::string> on_display() const { return {"DISPLAY=" + display, "WAYLAND_DISPLAY="}; }
  void start_window(const std::vector<std::string>& more = {}) {
    start_server();
    std::vector<std::string> options = snapshots();
    options.push_back("--window");
    options.insert(options.end(), more.begin(), more.end());
    start_with(options, on_display());
  }
  std::string xdotool(const std::vector<std::string>& words) {
    const std::string name = "xdotool" + std::to_string(++call_count);
    std::vector<std::string> command{"env", "DISPLAY=" + display, "xdotool"};
    command.insert(command.end(), words.begin(), words.end());
    processes.spawn(name, command);
    receive_until([&] { return !processes.running(name); });
    const int status = processes.wait_for_exit(name, kTimeout_s);
    INFO("xdotool (Debian package xdotool): " << processes.output(name));
    CHECK(status == 0);
    return processes.output(name);
  }
  std::string window() {
    const std::string found = xdotool({"search", "--sync", "--name", "^Tactus$"});
    return found.substr(0, found.find('\n'));
  }
  std::string geometry() { return xdotool({"getwindowgeometry", window()}); }
  Grey screen() {
    return grey("-f x11grab -draw_mouse 0 -video_size " + std::to_string(kScreenWidth) + "x" + std::to_string(kScreenHeight) +
                " -i " + display);
  }
  static int brightest(const Grey& screen, bool in_window) {
    int max = 0;
    for (std::size_t i = 0; i < screen.size(); ++i)
      if ((i % kScreenWidth < 640 && i / kScreenWidth < 480) == in_window) max = std::max<int>(max, screen[i]);
    return max;
  }
  template <class Condition>
  bool receive_until(const Condition& condition) {
    return monitor.wait_until(
        [&] {
          bus.drain(sync::host_now());
          while (const auto m = worlds.pop()) rate = m->message.clock.rate;
          while (const auto m = devices.pop())
            if (m->message.device == "mouse") ++mouse_messages, mouse_y_m.insert(m->message.pose.position_m.y);
          while (const auto m = answers.pop()) answered[m->message.id].push_back(m->message);
          return condition();
        },
        kTimeout_s);
  }
  void receive_for(double seconds) {
    const sync::HostTime end = sync::host_now() + sync::from_seconds(seconds);
    receive_until([&] { return sync::host_now() >= end; });
  }
  // Whether the picture comes to differ from another by an amount that the condition accepts.
  template <class Condition>
  bool difference_becomes(const Grey& other, const Condition& condition) {
    double difference = 0;
    for (const sync::HostTime end = sync::host_now() + sync::from_seconds(kTimeout_s); sync::host_now() < end; receive_for(0.3)) {
      difference = mean_difference(other, picture());
      if (condition(difference)) return true;
    }
    UNSCOPED_INFO("the last picture differs by " << difference);
    return false;
  }
  bool differs(const Grey& other, double more_than) {
    return difference_becomes(other, [&](double d) { return d > more_than; });
  }
  bool equals(const Grey& other) {
    return difference_becomes(other, [](double d) { return d < 1; });
  }
  // Asks the window to close as a window manager does (ICCCM 4.2.8.1).
  void request_close() {
    const char* program = R"(
import ctypes, sys
X = ctypes.CDLL("libX11.so.6")
X.XOpenDisplay.restype = ctypes.c_void_p
X.XInternAtom.restype = ctypes.c_ulong
class Message(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong), ("format", ctypes.c_int), ("data", ctypes.c_long * 5)]
class Event(ctypes.Union):
    _fields_ = [("message", Message), ("pad", ctypes.c_long * 24)]
d = ctypes.c_void_p(X.XOpenDisplay(sys.argv[1].encode()))
atom = lambda name: X.XInternAtom(d, name, 0)
window = int(sys.argv[2])
e = Event()
e.message = Message(33, 0, 1, d, window, atom(b"WM_PROTOCOLS"), 32, (atom(b"WM_DELETE_WINDOW"), 0, 0, 0, 0))
X.XSendEvent(d, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(e))
X.XCloseDisplay(d)
)";
    processes.spawn("close", {"/usr/bin/python3", "-c", program, display, window()});
    const int status = processes.wait_for_exit("close", kTimeout_s);
    INFO(processes.output("close"));
    REQUIRE(status == 0);
  }
};

}  // namespace

TEST_CASE("A window shows the picture, and its keys pause, step and reset the world, toggle overlays and fill the screen", "[display]") {
  Desktop c;
  c.start_window();
  c.monitor.receive_for(1);
  const Grey shown = c.screen();
  REQUIRE(shown.size() == kScreenWidth * kScreenHeight);
  CHECK(Desktop::brightest(shown, true) > 40);
  CHECK(Desktop::brightest(shown, false) == 0);

  c.xdotool({"mousemove", "300", "300"});
  REQUIRE(c.receive_until([&] { return c.rate > 0; }));
  c.xdotool({"key", "space"});
  CHECK(c.receive_until([&] { return c.rate == 0; }));
  const Grey still = c.later_picture();
  c.xdotool({"key", "h"});
  CHECK(c.differs(still, 3));  // a plate full of text
  c.xdotool({"key", "h"});
  CHECK(c.equals(still));
  c.xdotool({"key", "period"});
  c.xdotool({"key", "r"});
  c.xdotool({"key", "space"});
  CHECK(c.receive_until([&] { return c.rate > 0; }));
  const std::string output = c.processes.output("visual_node");
  CHECK_THAT(output, Catch::Contains("1 step from") && Catch::Contains("reset to its first instant"));

  c.xdotool({"key", "F11"});
  c.monitor.receive_for(1);
  CHECK_THAT(c.geometry(), Catch::Contains("1024x768"));
  CHECK(Desktop::brightest(c.screen(), false) > 10);
  c.xdotool({"key", "f"});
  c.monitor.receive_for(1);
  CHECK_THAT(c.geometry(), Catch::Contains("640x480"));
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}

TEST_CASE("The window draws a question of a study and answers it by its keys, which have no other effect meanwhile", "[display]") {
  Desktop c;
  c.start_window();
  c.monitor.receive_for(1);
  c.xdotool({"mousemove", "300", "300"});
  c.xdotool({"key", "space"});
  REQUIRE(c.receive_until([&] { return c.rate == 0; }));  // a still picture
  const Grey still = c.later_picture();
  QuestionLeader leader(Desktop::kRunId);
  const auto ask = [&](std::int64_t id, std::int8_t kind, const std::string& text) {
    question_t m{};
    m.header.sim_time_ns = -1;
    m.id = id, m.kind = kind, m.text = text;
    if (kind == question_t::CHOICE) m.count = 2, m.choices = {"at the same time", "not at the same time"};
    if (kind == question_t::NUMBER) m.lowest = 0, m.highest = 10, m.step = 1;
    m.progress = "block 1 of 4";
    leader.ask(m);
  };
  const auto answer = [&](std::int64_t id) {
    REQUIRE(c.receive_until([&] { return c.answered[id].size() >= 3; }));  // each repetition is answered
    for (const answer_t& a : c.answered[id]) {
      CHECK((a.choice == c.answered[id][0].choice && a.number == c.answered[id][0].number));
      CHECK(a.after_ns == c.answered[id][0].after_ns);
      CHECK((a.by == "key" && a.after_ns > 0 && a.after_ns < static_cast<std::int64_t>(kTimeout_s * 1e9)));
    }
    return c.answered[id][0];
  };

  ask(11, question_t::CHOICE, "Did you hear the ball and see it touch the floor at the same time?");
  CHECK(c.differs(still, 3));
  c.xdotool({"key", "3"});  // there is no third choice; the key must not open an overlay either
  c.receive_for(0.5);
  CHECK(c.answered.empty());
  c.xdotool({"key", "2"});
  CHECK((answer(11).choice == 1 && answer(11).number == 0));
  CHECK(c.equals(still));  // the question is closed, and no overlay is open

  ask(12, question_t::NUMBER, "How hard was it?");
  CHECK(c.differs(still, 1));
  for (const char* key : {"Right", "Up", "Up", "Left", "Left"}) c.xdotool({"key", key});  // 5 and 1, 1, 1, less 2
  c.xdotool({"key", "Return"});
  CHECK((answer(12).number == 6 && answer(12).choice == -1));

  CHECK(c.equals(still));
  ask(13, question_t::READ, "Read this text, and press the space bar when you have read all of it.");
  CHECK(c.differs(still, 1));
  c.xdotool({"key", "space"});
  CHECK(answer(13).choice == -1);
  CHECK(c.rate == 0);  // the space key did not resume the simulation

  // A second window shows no questions.
  CHECK(c.equals(still));
  c.set({"questions=false"});
  ask(14, question_t::READ, "This question is for another window, and this one draws nothing of it.");
  c.receive_for(1);
  CHECK(mean_difference(still, c.picture()) < 1);
  c.set({"questions=true"});
  CHECK(c.differs(still, 1));

  // The program with the question has stopped publishing.
  leader.ask({});
  CHECK(c.equals(still));
  CHECK(c.answered.find(14) == c.answered.end());
  c.xdotool({"key", "space"});
  CHECK(c.receive_until([&] { return c.rate > 0; }));
}

TEST_CASE("The mouse in the window is a device that points at the object under the cursor", "[display]") {
  Desktop c;
  c.start_window();
  c.xdotool({"mousemove", "320", "400"});
  CHECK_FALSE(c.monitor.wait_until([&] { return c.receive_until([&] { return true; }) && c.mouse_messages > 0; }, 0.5));
  c.xdotool({"mousedown", "1"});
  CHECK(c.receive_until([&] { return c.mouse_messages > 5; }));
  c.xdotool({"mouseup", "1"});
  CHECK(c.keeps_ticking("visual_node"));
}

TEST_CASE("The spot light follows the pressed mouse, and stays in place after its release") {
  Desktop c;
  c.start_server();
  const std::string run = std::to_string(RunningCluster::kRunId);
  c.processes.start("sync_node");
  c.processes.start("haptic_node");
  c.processes.spawn("haptic_node_wand",
                    {programs() / "haptic_node", "--run-id", run, "--out", c.folder.path(), "--name",
                     "haptic_node_wand", "--tool", "wand", "--device", "external:mouse"});
  std::vector<std::string> options = c.snapshots();
  options.insert(options.end(), {"--window", "--set", "width=640", "--set", "height=480"});
  c.start_vision(options, c.on_display());
  c.processes.start("sim_node", {repository() / "tests/cluster/scenes/head.sdf"});
  REQUIRE(c.monitor.wait_until([&] { return c.all_running({"sim_node", "haptic_node", "visual_node"}); }, kTimeout_s));
  const auto brightness = [](const Grey& p, bool left) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
      if ((i % 640 < 320) == left) sum += p[i];
    return sum;
  };
  const auto held_at = [&](const char* x_px) {
    c.xdotool({"mousemove", x_px, "300"});
    c.xdotool({"mousedown", "1"});
    CHECK(c.monitor.wait_until([&] { return c.is_running("haptic_node_wand"); }, kTimeout_s));
    c.monitor.receive_for(0.5);
    const Grey held = c.later_picture();
    c.xdotool({"mouseup", "1"});
    return held;
  };
  const Grey left = held_at("120"), right = held_at("520");
  CHECK(mean_difference(left, right) > 1);
  CHECK(brightness(left, true) > brightness(right, true));
  CHECK(brightness(right, false) > brightness(left, false));
  c.xdotool({"mousemove", "120", "300"});  // no button: the mouse only passes
  const Grey after = c.later_picture();
  INFO("difference from the held position " << mean_difference(right, after) << ", from the passed position " << mean_difference(left, after));
  CHECK(mean_difference(right, after) < 0.5);

  // Released and moved within one frame.
  c.receive_for(0.1);
  c.mouse_y_m.clear();
  for (int i = 0; i < 20; ++i)
    c.xdotool({"mousemove", "520", "300", "mousedown", "1", "sleep", "0.1", "mouseup", "1", "mousemove", "120", "300"});
  c.receive_for(0.2);
  CHECK(c.mouse_y_m.size() == 1);
}

TEST_CASE("A hidden, tiny or oversized window stops no node, and a closed window ends visual_node", "[display]") {
  Desktop c;
  c.start_window({"--set", "window_width=16384", "--set", "window_height=1", "--set", "monitor=7", "--set",
                  "stereo=quad_buffer"});
  const auto before = c.rates(1);
  CHECK_THAT(c.processes.output("visual_node"), Catch::Contains("larger than its monitor") &&
                                                  Catch::Contains("no monitor 7") &&
                                                  Catch::Contains("no buffer for each eye"));
  CHECK_THAT(c.geometry(), Catch::Contains("1024x1"));
  const std::string window = c.window();
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"windowsize", window, "1", "1"},
                                             {"windowunmap", window},
                                             {"windowmap", window},
                                             {"windowsize", window, "700", "500"}}) {
    CAPTURE(words[0]);
    c.xdotool(words);
    CHECK(c.keeps_ticking("visual_node"));
  }
  c.check_rates_hold(before, 1);
  c.request_close();
  CHECK(c.processes.wait_for_exit("visual_node", kTimeout_s) == 0);
  CHECK_THAT(c.processes.output("visual_node"), Catch::Contains("visual_node: the window was closed\n"));
  CHECK(c.others_running());

  // Another program destroys the window.
  std::vector<std::string> options = c.snapshots();
  options.push_back("--window");
  c.start_vision(options, c.on_display());
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
  c.xdotool({"windowclose", c.window()});
  CHECK(c.processes.wait_for_exit("visual_node", kTimeout_s) == 0);
}

TEST_CASE("A killed display server closes the window and not the node, and without a display server the start fails with a message", "[display]") {
  Desktop c;
  c.start_window();
  const auto before = c.rates(1);
  c.processes.kill("Xvfb");
  // The node continues until it detects the loss: the frame in progress, and the missed ticks beside load.
  CHECK(c.monitor.wait_until(
      [&] {
        return c.processes.output("visual_node").find("the display server of the window is gone; drawing continues with ") !=
               std::string::npos;
      },
      kTimeout_s));
  CHECK_THAT(c.processes.output("visual_node"), !Catch::Contains("X connection"));
  CHECK(c.keeps_ticking("visual_node"));
  CHECK(mean_difference(c.later_picture(), Grey(640 * 480, 0)) > 1);
  c.check_rates_hold(before, 1);

  c.processes.kill("visual_node");
  for (const std::vector<std::string>& environment :
       std::vector<std::vector<std::string>>{c.on_display(), {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY"}}) {
    c.start_vision({"--window"}, environment);
    CHECK(c.processes.wait_for_exit("visual_node", kTimeout_s) == 1);
    const std::string output = c.processes.output("visual_node");
    CHECK_THAT(output.substr(output.rfind('\n', output.size() - 2) + 1),
               Catch::Contains("--window: no window can be opened") && Catch::Contains("remove --window"));
  }
  CHECK(c.others_running());
}

TEST_CASE("A frozen display server ends visual_node with a message, and the other nodes continue", "[display]") {
  Desktop c;
  c.start_window();
  const auto before = c.rates(1);
  c.processes.signal("Xvfb", SIGSTOP);
  CHECK(c.processes.wait_for_exit("visual_node", kTimeout_s) == 1);
  CHECK_THAT(c.processes.output("visual_node"),
             Catch::Contains("the display server does not answer, so the node ends"));
  CHECK(c.others_running());
  c.check_rates_hold(before, 1, "visual_node");
}
