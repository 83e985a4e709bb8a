#include "scripts/live/page_session.h"

#include <algorithm>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/question_t.hpp>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <utility>

#include "scripts/live/catalog.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "sync/text/printable.h"
#include "sync/presentation/thresholds.h"

namespace tactus::live {
namespace {

using nlohmann::json;

// Text of the bus may contain invalid UTF-8, which is replaced.
std::string dump(const json& j) { return j.dump(-1, ' ', false, json::error_handler_t::replace); }

constexpr sync::Nanoseconds kMaxClockDifference{5'000'000'000};  // a time farther from its arrival belongs to another clock
constexpr std::size_t kMaxTags = 4096;                 // in the list of a page

}  // namespace

PageSession::PageSession(bool live, std::int64_t run_id, std::string title) : live_(live), title_(std::move(title)), feed_(run_id), answers_(run_id) {}

bool PageSession::accepts(std::string_view channel) const {
  // Required even without a page: answers are repeated for the leader of a study.
  if (channel == channels::kQuestion) return true;
  if (watches_.empty()) return false;
  if (Feed::accepts(channel) || channel == channels::kPictureChunk || channel == channels::kTagList ||
      channel == channels::kTagValues)
    return true;
  return std::any_of(watches_.begin(), watches_.end(), [&](const auto& w) { return w.second.accepts(channel); });
}

void PageSession::on_message(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
  feed_.on_message(channel, bytes, arrival);
  for (auto& [page, w] : watches_) w.on_message(channel, bytes, arrival);
  if (channel == channels::kQuestion) {
    if (const auto m = sync::decode<question_t>(bytes.data(), bytes.size())) answers_.push(*m, arrival);
  } else if (channel == channels::kTagList) {
    if (const auto m = sync::decode<tag_list_t>(bytes.data(), bytes.size())) tags_.push(*m);
  } else if (channel == channels::kTagValues) {
    const auto m = sync::decode<tag_values_t>(bytes.data(), bytes.size());
    if (!m) return;
    tags_.read(*m, [&](const sync::TagTable::List& list, const tag_def_t& def, std::int64_t time_ns, double value) {
      const sync::HostTime own = sync::host_time(time_ns);
      const bool same = own > arrival - kMaxClockDifference && own < arrival + kMaxClockDifference;
      for (auto& [page, w] : watches_) w.on_tag_value(list.node + "." + def.name, same ? own : arrival, value);
    });
  } else if (channel == channels::kPictureChunk) {
    const auto m = sync::decode<picture_chunk_t>(bytes.data(), bytes.size());
    if (!m) return;
    auto picture = pictures_.push(*m);
    if (!picture) return;
    // With several walls, shows the picture of visual_node if there is one, otherwise that of the first wall.
    if (!wall_ || picture->source == static_cast<std::int32_t>(sync::fnv1a_32("visual_node"))) wall_ = picture->source;
    if (picture->source != *wall_) return;
    if (picture->height > 0) aspect_ = static_cast<double>(picture->width) / picture->height;
    picture_.emplace(picture->jpeg.begin(), picture->jpeg.end());
    picture_arrival_ = arrival;
  }
}

void PageSession::clear() {
  feed_.clear();
  answers_.clear();
  picture_.reset();
}

json PageSession::study(sync::HostTime now) const {
  json out = answers_.to_json(now);
  if (const auto leader = answers_.leader(now)) out["leader"] = sync::printable(feed_.node_of(*leader));
  return out;
}

json PageSession::tag_list() const {
  json out = json::array();
  std::map<std::string, std::pair<std::string, std::int64_t>> newest;  // name: unit, and when it was received
  for (const auto& [key, list] : tags_.lists())
    for (const tag_def_t& t : list.tags) {
      if (t.name.empty() || newest.size() >= kMaxTags) continue;
      auto& entry = newest[list.node + "." + t.name];
      if (list.received_order >= entry.second) entry = {t.unit, list.received_order};
    }
  for (const auto& [name, unit] : newest)
    out.push_back({{"name", sync::printable(name)}, {"unit", sync::printable(unit.first)}, {"about", "tagged variable"}});
  return out;
}

std::string PageSession::hello(sync::HostTime now) const {
  json thresholds = json::array();
  for (const sync::Threshold& t : sync::published_thresholds())
    thresholds.push_back({{"earlier", t.earlier}, {"later", t.later}, {"ms", sync::to_seconds(t.at) * 1e3},
                          {"what", t.what}, {"source", t.source}});
  json out{{"t", "hello"}, {"live", live_}, {"title", sync::printable(title_)}, {"thresholds", thresholds},
           {"catalog", field_catalog()}, {"tags", tag_list()}, {"now", sync::to_seconds(now.time_since_epoch())}};
  out.update(feed_.state(now));
  return dump(out);
}

std::map<int, std::string> PageSession::frames(sync::HostTime now, const json& extra) {
  json all = feed_.take_changes(now);
  all["t"] = "frame";
  all["now"] = sync::to_seconds(now.time_since_epoch());
  all["study"] = study(now);
  all.update(extra);
  std::size_t tags = 0;
  for (const auto& [key, list] : tags_.lists())
    tags += static_cast<std::size_t>(std::count_if(list.tags.begin(), list.tags.end(), [](const tag_def_t& t) { return !t.name.empty(); }));
  if (std::exchange(sent_tag_count_, tags) != tags) all["tags"] = tag_list();
  std::map<int, std::string> out;
  for (auto& [page, w] : watches_) {
    json frame = all;
    frame["values"] = w.values();
    out[page] = dump(frame);
  }
  return out;
}

std::optional<std::string> PageSession::picture() { return std::exchange(picture_, std::nullopt); }

std::vector<std::string> PageSession::requested_tags() const {
  std::set<std::string> names;
  for (const auto& [page, w] : watches_)
    for (const std::string& name : w.tags()) names.insert(name);
  return {names.begin(), names.end()};
}

}  // namespace tactus::live
