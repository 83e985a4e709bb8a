#include "sync/node/setting_changes.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>

#include "lcmtypes/utf8.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kMaxNames = 64, kMaxValues = 256;  // setting_change_t.lcm
constexpr char kMalformed[] = "the request is malformed; send it with the program set of the same release";

std::vector<std::string> names_of(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = text.find(',', begin);
    names.push_back(text.substr(begin, comma - begin));
    if (names.back().empty()) throw std::invalid_argument(kMalformed);
    if (comma == std::string::npos) return names;
    begin = comma + 1;
  }
}

// Removes one "LENGTH:VALUE" from the front of the text.
std::string take_value(std::string_view& text) {
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (error != std::errc{} || text.empty() || text.front() != ':' || length >= text.size()) throw std::invalid_argument(kMalformed);
  const std::string value(text.substr(1, length));
  text.remove_prefix(1 + length);
  return value;
}

std::string sentence_of(const SettingList& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += (text.empty() ? "" : ", ") + name + " is " + value;
  return text;
}

}  // namespace

void pack_settings(setting_change_t& change, const SettingList& settings) {
  change.name.clear();
  change.value.clear();
  for (const auto& [name, value] : settings) {
    if (name.empty() || name.find(',') != std::string::npos)
      throw std::invalid_argument("\"" + name + "\" is not the name of a setting; docs/settings.md lists the names");
    change.name += (change.name.empty() ? "" : ",") + name;
    change.value += settings.size() == 1 ? value : std::to_string(value.size()) + ":" + value;
  }
  if (change.name.size() > kMaxNames || change.value.size() > kMaxValues)
    throw std::invalid_argument("names or values are too long for one request; change fewer settings at once");
}

SettingList unpack_settings(const setting_change_t& change) {
  const std::vector<std::string> names = names_of(change.name);
  if (names.size() == 1) return {{names.front(), change.value}};
  SettingList settings;
  std::string_view values = change.value;
  for (const std::string& name : names) settings.emplace_back(name, take_value(values));
  if (!values.empty()) throw std::invalid_argument(kMalformed);
  return settings;
}

void SettingChanges::process(const setting_change_t& change, const Apply& apply) {
  if (change.node != node_ || change.header.run_id != run_id_) return;
  if (const setting_reply_t* known = known_.find(change.id)) {
    replies_.push_back(*known);
    return;
  }
  setting_reply_t reply{};
  reply.header.sim_time_ns = -1;
  reply.id = change.id;
  try {
    const SettingList settings = unpack_settings(change);
    apply(settings);
    reply.done = 1;
    reply.text = node_ + ": " + sentence_of(settings);
  } catch (const std::invalid_argument& e) {
    reply.text = node_ + ": " + e.what();
  }
  reply.text = std::string(first_bytes(reply.text, 512));
  known_.try_emplace(reply.id, reply);
  replies_.push_back(reply);
}

}  // namespace tactus::sync
