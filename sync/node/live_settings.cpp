#include "sync/node/live_settings.h"

#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "sync/bus/decode.h"

namespace tactus::sync {
namespace {

constexpr Nanoseconds kRequestPeriod{1'000'000'000};

}  // namespace

LiveSettings::LiveSettings(Node& node)
    : node_(node),
      requests_(node.bus().queue<setting_change_t>(channels::kSetting, 64)),
      lists_(node.bus().raw(channels::kTagList, 64, Port::kRealtime)),
      values_(node.bus().raw(channels::kTagValues, 256, Port::kRealtime)),
      changes_(node.options().name, node.options().run_id),
      maps_(node.options().name) {
  lists_.set_enabled(false);
  values_.set_enabled(false);
}

std::vector<std::string> LiveSettings::step(HostTime now, const SettingChanges::Apply& apply) {
  if (const auto m = requests_.pop()) changes_.process(m->message, apply);
  for (setting_reply_t& reply : changes_.replies()) node_.bus().publish(channels::kSettingReply, reply);

  std::vector<std::string> problems;
  lists_.set_enabled(maps_.any());
  values_.set_enabled(maps_.any());
  if (!maps_.any()) return problems;
  if (now >= next_request_) {
    next_request_ = now + kRequestPeriod;
    tag_request_t request = maps_.request();
    node_.bus().publish(channels::kTagRequest, request);
  }
  // Messages of another run, such as a replayed log, drive nothing.
  const auto push = [&](const auto& m) {
    if (m && m->header.run_id == node_.options().run_id) maps_.push(*m);
  };
  lists_.read([&](std::span<const std::uint8_t> bytes, HostTime) {
    push(decode<tag_list_t>(bytes.data(), bytes.size()));
  });
  values_.read([&](std::span<const std::uint8_t> bytes, HostTime) {
    push(decode<tag_values_t>(bytes.data(), bytes.size()));
  });
  for (const SettingMaps::Change& change : maps_.take_changes(now)) try {
      apply({{change.name, change.value}});
    } catch (const std::invalid_argument& e) {
      problems.push_back("a <tactus:map> cannot drive " + change.name + ": " + e.what());
      maps_.disable(change.name);
    }
  return problems;
}

}  // namespace tactus::sync
