// Requests to change the settings of a running node (SETTING): each is carried out once and answered. A request changes one
// setting or several, and then all or none. Pure: the node passes messages in and publishes the replies.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <utility>
#include <vector>

#include "sync/bus/recent_map.h"
#include "sync/text/settings.h"

namespace tactus::sync {

// Writes the settings into a request. One setting: its name and its value. Several: the names with commas between them, and
// each value after its length in bytes, "2:5N6:direct", because a value may hold any printable character. Throws
// std::invalid_argument with one sentence when a name is empty or holds a comma, or the request becomes too long.
void pack_settings(setting_change_t& change, const SettingList& settings);
// The settings of a request. Throws std::invalid_argument with one sentence when it is malformed.
SettingList unpack_settings(const setting_change_t& change);

class SettingChanges {
 public:
  // Number of replies that are stored, for repeated requests.
  static constexpr std::size_t kRemembered = 64;

  // node: its name, as in its health. run_id: of the cluster run; requests of other runs are ignored.
  SettingChanges(std::string node, std::int64_t run_id) : node_(std::move(node)), run_id_(run_id) {}

  // Changes all of the settings, or throws std::invalid_argument with one sentence; after an exception no setting may have
  // changed.
  using Apply = std::function<void(const SettingList& settings)>;
  // Processes a request for this node and run: carries it out once, and answers each repetition.
  void process(const setting_change_t& change, const Apply& apply);
  // The replies to publish now; valid until the next take. The call empties the list.
  std::vector<setting_reply_t> replies() { return std::exchange(replies_, {}); }

 private:
  std::string node_;
  std::int64_t run_id_;
  RecentMap<std::int64_t, setting_reply_t> known_{kRemembered};  // by id
  std::vector<setting_reply_t> replies_;
};

}  // namespace tactus::sync
