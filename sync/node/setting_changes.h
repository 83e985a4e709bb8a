// What is asked of a node's settings while it runs (SETTING), each change once, and the replies. Pure: the node
// hands messages in and sends the replies.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <utility>
#include <vector>

namespace tactus::sync {

class SettingChanges {
 public:
  // Replies to so many changes are remembered, for their repetitions.
  static constexpr std::size_t kRemembered = 64;

  // node: its name, as in its health. run_id: of the cluster run; changes of others are not heeded.
  SettingChanges(std::string node, std::int64_t run_id) : node_(std::move(node)), run_id_(run_id) {}

  // Changes the setting, or throws std::invalid_argument with one sentence: then it must not have changed
  // anything.
  using Apply = std::function<void(const std::string& name, const std::string& value)>;
  // Takes a message: of this node and run it is carried out once, and answered each time.
  void take(const setting_change_t& change, const Apply& apply);
  // What is to be sent now; valid until the next take. Taking them empties the list.
  std::vector<setting_reply_t> replies() { return std::exchange(replies_, {}); }

 private:
  std::string node_;
  std::int64_t run_id_;
  std::deque<setting_reply_t> known_;
  std::vector<setting_reply_t> replies_;
};

}  // namespace tactus::sync
