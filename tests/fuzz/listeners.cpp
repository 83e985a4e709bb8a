// Arbitrary bytes read as a log by all subscribers of a whole bus: the summary, the tables, the spy, the live page, and the assembly of
// pages and fragments.
#include <cstdlib>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "scripts/live/page_session.h"
#include "sync/bus/bus.h"
#include "sync/tools/channel_table.h"
#include "sync/resampling/contact_stream.h"
#include "sync/log/export_events.h"
#include "sync/log/log_origin.h"
#include "sync/tools/picture_reader.h"
#include "sync/assets/scene_receiver.h"
#include "sync/tools/spy/channels.h"
#include "sync/tools/spy/screen.h"
#include "sync/tools/summary/summary.h"
#include "sync/tools/watch_table.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kRun = 7;

// Calls use for the messages of one channel.
template <class Message, class Use>
void as(const LogEvent& e, const char* channel, Use&& use) {
  if (e.channel != channel) return;
  if (const auto m = decode<Message>(e.data.data(), e.data.size())) use(*m);
}

struct Listeners {
  LogOrigin origin;
  RunSummary summary{SummaryOptions{}};
  TableContext tables{origin};
  TagTable tags;
  spy::Channels channels{{kRun, 4711, nullptr}};
  spy::Screen screen;
  live::PageSession session{false, kRun, "log"};
  ContactStream contacts{{kRun, 4711, nullptr}};
  PictureReader pictures;
  Bus bus{Identity{"fuzz", 1, 1, kRun, 4711}, BusOptions{.memory = true}};
  SceneReceiver scene{bus};
  std::size_t written = 0;

  void on_event(const LogEvent& e, HostTime now) {
    summary.add(e);
    tables.learn(e);
    if (const MessageType* type = type_on(std::string(e.channel))) {
      written += long_rows(tables, *type, e, now).size();
      written += WideColumns(*type).row(tables, e, now).size();
    }
    written += tag_rows(tags, tables, e, now).size();
    MessageBatch batch;
    if (batch.add(now, {e.channel, e.data}, std::size_t{1} << 24)) channels.push(batch[0]);
    session.on_message(e.channel, e.data, now);
    as<tag_list_t>(e, channels::kTagList, [&](const auto& m) { screen.push(m); });
    as<tag_values_t>(e, channels::kTagValues, [&](const auto& m) { screen.push(m, now); });
    as<contact_events_t>(e, channels::kContactEvents, [&](const auto& m) { contacts.push(m, now); });
    as<contact_frame_t>(e, channels::kContacts, [&](const auto& m) { contacts.push(m, now); });
    as<picture_chunk_t>(e, channels::kPictureChunk, [&](const auto& m) { pictures.push(m); });
    bus.on_message(e.channel, e.data, now);
    scene.poll(now);
    if (const auto map = contacts.map(now)) {
      contacts.take_events(map->to_sim(now));
      contacts.state_at(map->to_sim(now));
      contacts.integral(map->to_sim(now - Nanoseconds(10'000'000)), map->to_sim(now), 0);
    }
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto all = std::make_unique<Listeners>();
  all->session.open(1);
  all->session.watch(1, {"TOOL_STATE:force_N.z", "sim_node.work.solve"});
  LogScanner scanner({data, size});
  HostTime now = host_time(1'000'000'000);
  for (LogEvent e; scanner.next(e);) all->on_event(e, now += Nanoseconds(1'000'000));
  all->summary.end_of_log(scanner.damaged_regions());
  if (to_json(all->summary).empty() || to_text(all->summary).empty()) std::abort();
  all->screen.sample(all->channels, now);
  for (const spy::Key key : {spy::Key::kNone, spy::Key::kEnter, spy::Key::kDown, spy::Key::kTags}) {
    all->screen.press(key);
    if (all->screen.draw(all->channels, now, 80, 24).size() > 24) std::abort();
  }
  all->session.frames(now, nlohmann::json::object());
  if (all->session.hello(now).empty()) std::abort();
  return 0;
}
