// Tests of a recorded run rendered again as a film.
#include <algorithm>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/channels.h"
#include "tests/cluster/support/run_log.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// The word after `before` in a program's output.
std::string word_after(const std::string& output, const std::string& before) {
  const auto at = output.find(before);
  REQUIRE(at != std::string::npos);
  std::istringstream rest(output.substr(at + before.size()));
  std::string word;
  rest >> word;
  return word;
}

// Number of begins and hits at least before_end_ns before the log ends, each counted once. The simulation publishes events in
// each step but the state of the world less often, so an event can be newer than the last state.
std::size_t events_of(const RunLog& log, std::int64_t before_end_ns) {
  std::int64_t end_ns = 0;
  const auto extend = [&](const auto& m) { end_ns = std::max(end_ns, m.header.publish_time_ns); };
  log.for_each<world_state_t>(channels::kWorldState, extend);
  log.for_each<contact_events_t>(channels::kContactEvents, extend);
  std::set<std::int64_t> ids;
  log.for_each<contact_events_t>(channels::kContactEvents, [&](const auto& m) {
    for (const contact_event_t& e : m.events)
      if (e.kind != contact_event_t::END && m.header.publish_time_ns <= end_ns - before_end_ns)
        ids.insert(e.event_id);
  });
  return ids.size();
}

}  // namespace

TEST_CASE("A recorded run is drawn into the same film each time, with a flash for every begin and hit") {
  RunScript run;
  run.start({tapping_scene(), "--seconds", "4", "--out", run.out()});
  const int status = run.finish(150);
  INFO(run.processes.output("run"));
  REQUIRE(status == 0);
  const std::filesystem::path log = run.out() / "run.lcmlog";
  const auto film = [&](const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{programs() / "visual_node", "--log", log, "--video", run.folder.path() / name};
    words.insert(words.end(), more.begin(), more.end());
    return run.output_of(words);
  };
  const std::string first = film("first.mp4"), second = film("second.mp4");
  CHECK(word_after(first, "; pixels ") == word_after(second, "; pixels "));
  CHECK(contents(run.folder.path() / "first.mp4") == contents(run.folder.path() / "second.mp4"));
  CHECK(std::stoi(word_after(first, "first.mp4: ")) >= 4 * 60);

  const RunLog events(run.out());
  const auto flashes = static_cast<std::size_t>(std::stoi(word_after(first, " s, ")));
  CHECK(flashes <= events_of(events, 0));
  CHECK(flashes >= events_of(events, 200'000'000));  // the last ones are due after the last frame
  CHECK(events_of(events, 200'000'000) > 5);
  CHECK(first.find("not shown") == std::string::npos);

  // This log and this setting determine the pixels.
  CHECK(word_after(film("other.mp4", {"--set", "geometry=physics"}), "; pixels ") !=
        word_after(first, "; pixels "));
}
